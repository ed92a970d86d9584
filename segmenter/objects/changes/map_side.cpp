#include "segmenter/objects/changes/map_side.hpp"

#include <cmath>
#include <utility>

#include "segmenter/objects/maps/surface_samples.hpp"

namespace kintsugi::segmenter {
namespace {

// As large as objects: then what is around one is in few cells.
constexpr float kCell_m = 0.5F;

std::int32_t index_of(float x) { return static_cast<std::int32_t>(std::floor(x / kCell_m)); }

}  // namespace

MapSide::MapSide(std::vector<CloudPoint> points, std::span<const std::uint32_t> segment_ids,
                 double voxel_m)
    : points_(std::move(points)),
      segment_ids_(segment_ids),
      space_(voxel_m),
      voxel_m_(voxel_m),
      colors_(unthinned(points_, static_cast<float>(voxel_m))),
      tree_(points_) {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const CloudPoint& p = points_[i];
    by_segment_[segment_ids_[i]].push_back(i);
    by_cell_[{index_of(p.x), index_of(p.y), index_of(p.z)}].push_back(i);
  }
}

const std::vector<std::size_t>& MapSide::points_of(std::uint32_t segment) const {
  static const std::vector<std::size_t> kNone;
  const auto found = by_segment_.find(segment);
  return found == by_segment_.end() ? kNone : found->second;
}

std::vector<CloudPoint> MapSide::points_at(std::span<const std::size_t> indices) const {
  std::vector<CloudPoint> points;
  points.reserve(indices.size());
  for (const std::size_t i : indices) points.push_back(points_[i]);
  return points;
}

std::vector<std::size_t> MapSide::points_in(const Eigen::AlignedBox3f& box) const {
  std::vector<std::size_t> inside;
  for (std::int32_t x = index_of(box.min().x()); x <= index_of(box.max().x()); ++x) {
    for (std::int32_t y = index_of(box.min().y()); y <= index_of(box.max().y()); ++y) {
      for (std::int32_t z = index_of(box.min().z()); z <= index_of(box.max().z()); ++z) {
        const auto found = by_cell_.find({x, y, z});
        if (found == by_cell_.end()) continue;
        for (const std::size_t i : found->second) {
          if (box.contains(position_of(points_[i]))) inside.push_back(i);
        }
      }
    }
  }
  return inside;
}

std::unique_ptr<Scene> MapSide::scene() const {
  auto scene = std::make_unique<Scene>(static_cast<float>(voxel_m_));
  scene->set_piece(0, std::make_shared<const std::vector<CloudPoint>>(points_),
                   {segment_ids_.begin(), segment_ids_.end()});
  if (!space_.empty()) scene->set_observed(&space_);
  return scene;
}

}  // namespace kintsugi::segmenter
