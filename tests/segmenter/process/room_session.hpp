#pragma once
// A mapper session through several furnished rooms, and corrections of it as a closed loop brings.

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "tests/segmenter/core/random_clouds.hpp"

namespace kintsugi::segmenter::testing {

/// Rooms of 4 m x 3 m x 2.4 m in a row along x: floor, two long walls, a wall between two rooms,
/// and a table in each. A point for each voxel of the surface, jittered, with a noisy normal.
class RoomRow {
 public:
  RoomRow(int num_rooms, double resolution_m, unsigned seed = 1)
      : random_(seed), resolution_m_(resolution_m) {
    for (int room = 0; room < num_rooms; ++room) {
      const double x = 4.0 * room;
      add_patch({x, 0, 0}, {4, 0, 0}, {0, 3, 0});              // floor
      add_patch({x, 0, 0}, {0, 0, 2.4}, {4, 0, 0});            // walls
      add_patch({x, 3, 0}, {4, 0, 0}, {0, 0, 2.4});            //
      add_patch({x, 0, 0}, {0, 2, 0}, {0, 0, 2.4});            // to the room before, with a door
      add_patch({x + 1.5, 1, 0.7}, {1.2, 0, 0}, {0, 0.8, 0});  // table
      add_patch({x + 1.5, 1, 0.7}, {0, 0, -0.1}, {1.2, 0, 0});
    }
  }

  /// Slices of `width_m` along x, ids ascending.
  [[nodiscard]] std::vector<CloudSlice> cut(double width_m, std::int64_t session = 5) const {
    std::vector<CloudSlice> slices;
    for (const CloudPoint& point : points_W_) {
      const auto id = static_cast<std::size_t>(std::max(0.0, point.x / width_m));
      while (slices.size() <= id) {
        CloudSlice& slice = slices.emplace_back();
        slice.id = static_cast<std::int32_t>(slices.size()) - 1;
        slice.utime = 1000 + slice.id;
        slice.session = session;
        slice.map_name = "map";
        slice.kind = SliceKind::kShiftPlusX;
        slice.resolution_m = static_cast<float>(resolution_m_);
      }
      slices[id].points_W.push_back(point);
    }
    slices.back().kind = SliceKind::kFinal;
    return slices;
  }

 private:
  void add_patch(const Eigen::Vector3d& corner, const Eigen::Vector3d& u,
                 const Eigen::Vector3d& v) {
    std::uniform_real_distribution<double> jitter(-0.3, 0.3);
    std::normal_distribution<double> noise(0.0, 0.05);
    const Eigen::Vector3d normal = u.cross(v).normalized();
    const int rows = static_cast<int>(u.norm() / resolution_m_);
    const int columns = static_cast<int>(v.norm() / resolution_m_);
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        const Eigen::Vector3d p = corner + u * ((row + 0.5 + jitter(random_)) / rows) +
                                  v * ((column + 0.5 + jitter(random_)) / columns);
        const Eigen::Vector3d n =
            normal + Eigen::Vector3d(noise(random_), noise(random_), noise(random_));
        points_W_.push_back(make_point(p.x(), p.y(), p.z(), n.x(), n.y(), n.z()));
      }
    }
  }

  std::mt19937 random_;
  double resolution_m_;
  std::vector<CloudPoint> points_W_;
};

/// The slice in a higher revision, its points moved by X_WW.
inline CloudSlice moved(CloudSlice slice, const Eigen::Isometry3d& X_WW) {
  ++slice.revision;
  for (CloudPoint& point : slice.points_W) {
    const Eigen::Vector3d p = X_WW * Eigen::Vector3d(point.x, point.y, point.z);
    const Eigen::Vector3d n = X_WW.linear() * Eigen::Vector3d(point.nx, point.ny, point.nz);
    point = make_point(p.x(), p.y(), p.z(), n.x(), n.y(), n.z());
  }
  return slice;
}

/// A few centimetres and a fifth of a degree: what a closed loop moves.
inline Eigen::Isometry3d small_motion() {
  Eigen::Isometry3d X_WW = Eigen::Isometry3d::Identity();
  X_WW.linear() = Eigen::AngleAxisd(0.0035, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  X_WW.translation() << 0.03, -0.02, 0.025;
  return X_WW;
}

}  // namespace kintsugi::segmenter::testing
