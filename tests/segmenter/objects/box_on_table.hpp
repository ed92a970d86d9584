#pragma once
// A small map for tests: a box and a ball on a table, as a camera above and before them sees them.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "segmenter/core/points/transformed_points.hpp"
#include "segmenter/objects/model/make_model.hpp"
#include "segmenter/views/observed_map.hpp"

namespace kintsugi::segmenter::testing {

inline constexpr std::uint32_t kTable = 1;
inline constexpr std::uint32_t kBox = 2;
inline constexpr std::uint32_t kBall = 3;

/// Frame U: z up, the table is at z = 0.
class MapOfThings {
 public:
  explicit MapOfThings(float resolution_m = 0.01F) {
    map_.source = "things";
    map_.map_name = "hall";
    map_.map_session = 7;
    map_.resolution_m = resolution_m;
  }

  /// A rectangle from `corner` along the vectors `a` and `b`; its normal is a x b.
  void add_face(const Eigen::Vector3f& corner, const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                const Eigen::Vector3i& color, std::uint32_t id) {
    const Eigen::Vector3f normal = a.cross(b).normalized();
    const int rows = steps(b.norm());
    const int columns = steps(a.norm());
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        const Eigen::Vector3f p =
            corner + a * ((static_cast<float>(i) + 0.5F) / static_cast<float>(columns)) +
            b * ((static_cast<float>(j) + 0.5F) / static_cast<float>(rows));
        add(p, normal, color, id);
      }
    }
  }

  /// The sides of a box on the table that are named by their normals, among them "x", "-y", "z".
  /// @param size_m along x, y and z before it is turned by `turn_rad` about z
  void add_box(const Eigen::Vector3f& center, float turn_rad, const Eigen::Vector3f& size_m,
               const std::vector<std::string>& sides, std::uint32_t id) {
    const Eigen::Matrix3f R =
        Eigen::AngleAxisf(turn_rad, Eigen::Vector3f::UnitZ()).toRotationMatrix();
    const Eigen::Vector3f x = R.col(0) * size_m.x();
    const Eigen::Vector3f y = R.col(1) * size_m.y();
    const Eigen::Vector3f z = R.col(2) * size_m.z();
    const Eigen::Vector3f low = center - x / 2 - y / 2;  // a corner at the table
    for (const std::string& side : sides) {
      if (side == "z") add_face(low + z, x, y, {200, 60, 40}, id);
      if (side == "x") add_face(low + x, y, z, {180, 160, 40}, id);
      if (side == "-x") add_face(low + y, -y, z, {90, 40, 120}, id);
      if (side == "-y") add_face(low, x, z, {30, 120, 60}, id);
      if (side == "y") add_face(low + x + y, -x, z, {40, 70, 160}, id);
    }
  }

  /// The upper half of a ball that lies on the table.
  void add_ball(const Eigen::Vector3f& center, float radius_m, std::uint32_t id) {
    const int rows = steps(radius_m * std::numbers::pi_v<float> / 2);
    for (int j = 0; j < rows; ++j) {
      const float height =
          (static_cast<float>(j) + 0.5F) / static_cast<float>(rows) * std::numbers::pi_v<float> / 2;
      const int columns = steps(2 * std::numbers::pi_v<float> * radius_m * std::cos(height));
      for (int i = 0; i < columns; ++i) {
        const float turn =
            2 * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(columns);
        const Eigen::Vector3f n(std::cos(turn) * std::cos(height),
                                std::sin(turn) * std::cos(height), std::sin(height));
        add(center + radius_m * n + Eigen::Vector3f(0, 0, radius_m), n, {230, 230, 225}, id);
      }
    }
  }

  void add(const Eigen::Vector3f& p, const Eigen::Vector3f& n, const Eigen::Vector3i& color,
           std::uint32_t id) {
    CloudPoint point;
    point.x = p.x();
    point.y = p.y();
    point.z = p.z();
    point.nx = n.x();
    point.ny = n.y();
    point.nz = n.z();
    point.red = static_cast<std::uint8_t>(color.x());
    point.green = static_cast<std::uint8_t>(color.y());
    point.blue = static_cast<std::uint8_t>(color.z());
    point.weight = 4.0F;
    map_.points_W.push_back(transformed(point, X_WU()));
    map_.segment_ids.push_back(id);
  }

  [[nodiscard]] ObservedMap take() { return std::move(map_); }

  /// W of a level camera: y down.
  static Pose X_WU() {
    Pose X = Pose::Identity();
    X.linear().col(0) = Eigen::Vector3d::UnitX();
    X.linear().col(1) = Eigen::Vector3d::UnitZ();
    X.linear().col(2) = -Eigen::Vector3d::UnitY();
    X.translation() = Eigen::Vector3d(0.1, 0.6, 1.5);
    return X;
  }

 private:
  [[nodiscard]] int steps(float length_m) const {
    return std::max(1, static_cast<int>(std::lround(length_m / map_.resolution_m)));
  }

  ObservedMap map_;
};

inline const Eigen::Vector3f kBoxSize_m(0.24F, 0.16F, 0.12F);

/// @param shift of the box on the table, metres; `turn_rad` about the vertical
inline ObservedMap box_on_table(const std::vector<std::string>& sides = {"z", "-y", "x"},
                                const Eigen::Vector3f& shift = Eigen::Vector3f::Zero(),
                                float turn_rad = 0.0F, const Eigen::Vector3f& size_m = kBoxSize_m) {
  MapOfThings things;
  things.add_face({-0.6F, -0.5F, 0.0F}, {1.2F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, {150, 140, 130},
                  kTable);
  things.add_box(shift, turn_rad, size_m, sides, kBox);
  things.add_ball({0.35F, 0.3F, 0.0F}, 0.08F, kBall);
  return things.take();
}

}  // namespace kintsugi::segmenter::testing
