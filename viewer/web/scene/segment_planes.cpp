#include "viewer/web/scene/segment_planes.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

namespace kintsugi::viewer {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void SegmentPlanes::Moments::add(const Vector3d& p) {
  count += 1.0;
  sum += p;
  square += p * p.transpose();
}

void SegmentPlanes::Moments::add(const Moments& other, double sign) {
  count += sign * other.count;
  sum += sign * other.sum;
  square += sign * other.square;
}

SegmentPlanes::Moments SegmentPlanes::Moments::moved(const Pose& X_AB) const {
  const Matrix3d R = X_AB.linear();
  const Vector3d t = X_AB.translation();
  const Vector3d turned = R * sum;
  Moments result;
  result.count = count;
  result.sum = turned + count * t;
  result.square = R * square * R.transpose() + turned * t.transpose() + t * turned.transpose() +
                  count * t * t.transpose();
  return result;
}

SegmentPlanes::OfTile SegmentPlanes::moments_of(const scene::Tile& tile) {
  const scene::TileLabels& labels = *tile.labels;
  std::vector<Moments> of_index(labels.table.size());
  std::unordered_map<std::uint32_t, std::size_t> index_of;
  for (std::size_t i = 0; i < labels.table.size(); ++i) index_of.emplace(labels.table[i], i);
  for (std::uint32_t i = 0; i < tile.points->count; ++i) {
    of_index[index_of.at(labels.label(i))].add(tile.points->position_P(i).cast<double>());
  }
  const Pose X_WP = tile.X_WP.pose();
  OfTile result;
  for (std::size_t i = 0; i < of_index.size(); ++i) {
    if (labels.table[i] == kNoSegment) continue;
    result.emplace(labels.table[i], of_index[i].moved(X_WP));
  }
  return result;
}

void SegmentPlanes::set(const scene::Tile& tile) {
  remove(tile.id);
  const OfTile& added = tiles_[tile.id] = moments_of(tile);
  for (const auto& [id, moments] : added) {
    segments_[id].add(moments, 1.0);
    changed_.insert(id);
  }
}

void SegmentPlanes::remove(std::uint32_t tile_id) {
  const auto found = tiles_.find(tile_id);
  if (found == tiles_.end()) return;
  for (const auto& [id, moments] : found->second) {
    Moments& all = segments_[id];
    all.add(moments, -1.0);
    if (all.count < 0.5) segments_.erase(id);
    changed_.insert(id);
  }
  tiles_.erase(found);
}

scene::SegmentPlane SegmentPlanes::plane(std::uint32_t segment_id, const Vector3d& mean_normal_W,
                                         double resolution_m) const {
  constexpr double kMaxRms_vox = 0.6;
  constexpr double kMinWidth_vox = 5.0;
  scene::SegmentPlane plane;
  const auto found = segments_.find(segment_id);
  if (found == segments_.end() || found->second.count < 2.5) return plane;
  const Moments& all = found->second;
  const Vector3d mean = all.sum / all.count;
  const Matrix3d covariance = all.square / all.count - mean * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(covariance);
  plane.normal_W = solver.eigenvectors().col(0);
  if (plane.normal_W.dot(mean_normal_W) < 0.0) plane.normal_W = -plane.normal_W;
  plane.offset_m = plane.normal_W.dot(mean);
  plane.rms_m = std::sqrt(std::max(0.0, solver.eigenvalues()[0]));
  // The width of a rectangle with this variance.
  const double width_m = std::sqrt(12.0 * std::max(0.0, solver.eigenvalues()[1]));
  plane.is_planar =
      plane.rms_m <= kMaxRms_vox * resolution_m && width_m >= kMinWidth_vox * resolution_m;
  return plane;
}

}  // namespace kintsugi::viewer
