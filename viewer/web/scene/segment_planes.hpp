#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <set>
#include <unordered_map>

#include "lcmtypes/scene/scene_json.hpp"
#include "lcmtypes/scene/tile.hpp"

namespace kintsugi::viewer {

/// The least-squares plane of each segment of a map whose tiles change, from the first and second
/// moments of its points in each tile: a tile that changes costs time for its own points.
class SegmentPlanes {
 public:
  /// Adds the tile, or replaces what was there under its id.
  void set(const scene::Tile& tile);
  void remove(std::uint32_t tile_id);

  /// Segments whose points changed since the last call.
  std::set<std::uint32_t> take_changed() { return std::exchange(changed_, {}); }

  /// Its normal points to the side of `mean_normal_W`. Planar: the rms of the distances is at most
  /// 0.6 voxels, with which nine of ten points are within a voxel of the plane, and the points are
  /// at least 5 voxels wide. kintsugi-query counts the points themselves, so that it may decide
  /// otherwise at the limit. Without a plane for fewer than three points.
  scene::SegmentPlane plane(std::uint32_t segment_id, const Eigen::Vector3d& mean_normal_W,
                            double resolution_m) const;

 private:
  /// Of points: their number, sum, and sum of p p^T. Metres, W.
  struct Moments {
    double count = 0.0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d square = Eigen::Matrix3d::Zero();

    void add(const Eigen::Vector3d& p);
    void add(const Moments& other, double sign);
    Moments moved(const Pose& X_AB) const;
  };
  using OfTile = std::unordered_map<std::uint32_t, Moments>;

  static OfTile moments_of(const scene::Tile& tile);

  std::map<std::uint32_t, OfTile> tiles_;
  std::unordered_map<std::uint32_t, Moments> segments_;
  std::set<std::uint32_t> changed_;
};

}  // namespace kintsugi::viewer
