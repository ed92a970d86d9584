#include "segmenter/objects/recognition/segment_borders.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include "segmenter/core/graph/neighbour_index.hpp"

namespace kintsugi::segmenter {

namespace {

Eigen::Vector3f position(const CloudPoint& p) { return {p.x, p.y, p.z}; }

}  // namespace

struct SegmentBorders::LabelledPoint {
  CloudPoint point_W;
  std::uint32_t segment = kNoSegment;
  bool is_inside = false;  // of the block
};

void SegmentBorders::forget(const LabelledMap::Change& change) {
  for (const BlockKey& changed : change.labelled_blocks) {
    for_each_around(changed, [this](const BlockKey& key) {
      const auto block = blocks_.find(key);
      if (block == blocks_.end()) return;
      for (const std::uint32_t segment : block->second.segments) neighbours_.unsafe_erase(segment);
      blocks_.unsafe_erase(block);
    });
  }
  for (const std::uint32_t segment : change.segments) neighbours_.unsafe_erase(segment);
}

const std::vector<SegmentNeighbour>& SegmentBorders::neighbours_of(std::uint32_t segment) const {
  const auto known = neighbours_.find(segment);
  if (known != neighbours_.end()) return known->second;
  std::map<std::uint32_t, std::int64_t> pairs;
  for (const BlockKey& key : map_.blocks_of(segment)) {
    const auto borders =
        std::ranges::equal_range(block(key).borders, segment, {}, &Border::segment);
    for (const Border& border : borders) {
      pairs[border.neighbour.segment_id] += border.neighbour.num_pairs;
    }
  }
  std::vector<SegmentNeighbour> neighbours;
  neighbours.reserve(pairs.size());
  for (const auto& [id, num_pairs] : pairs) neighbours.push_back({id, num_pairs});
  return neighbours_.emplace(segment, std::move(neighbours)).first->second;
}

const SegmentBorders::Block& SegmentBorders::block(const BlockKey& key) const {
  const auto known = blocks_.find(key);
  if (known != blocks_.end()) return known->second;
  return blocks_.emplace(key, counted(key)).first->second;
}

SegmentBorders::Block SegmentBorders::counted(const BlockKey& key) const {
  std::vector<LabelledPoint> points_W = points_around(key);
  Block block;
  for (const LabelledPoint& point : points_W) {
    if (point.is_inside) block.segments.push_back(point.segment);
  }
  std::ranges::sort(block.segments);
  block.segments.erase(std::ranges::unique(block.segments).begin(), block.segments.end());
  const bool has_borders = std::ranges::any_of(points_W, [&](const LabelledPoint& point) {
    return point.segment != points_W.front().segment;
  });
  if (has_borders) block.borders = borders_between(std::move(points_W));
  return block;
}

/// With segments: those in the block, and others that may be neighbours of these.
std::vector<SegmentBorders::LabelledPoint> SegmentBorders::points_around(
    const BlockKey& key) const {
  // Distances are rounded, so points slightly more than the radius apart may be neighbours.
  const Eigen::AlignedBox3f box_W = map_.box_of(key, 1.001F * radius_m_);
  std::vector<LabelledPoint> points_W;
  for_each_around(key, [&](const BlockKey& from) {
    map_.visit_points_in(
        from, [&](LabelledMap::PointRef, const CloudPoint& point_W, std::uint32_t segment) {
          if (segment == kNoSegment) return;
          if (from != key && !box_W.contains(position(point_W))) return;
          points_W.push_back({point_W, segment, from == key});
        });
  });
  return points_W;
}

/// All pairs of which one point is in the block, once for each point that is. The points are sorted
/// along the axis in which they reach farthest, so that few others are within the radius along it.
std::vector<SegmentBorders::Border> SegmentBorders::borders_between(
    std::vector<LabelledPoint> points_W) const {
  Eigen::AlignedBox3f box_W;
  for (const LabelledPoint& point : points_W) box_W.extend(position(point.point_W));
  Eigen::Index axis = 0;
  box_W.sizes().maxCoeff(&axis);
  const auto along = [axis](const LabelledPoint& point) { return position(point.point_W)[axis]; };
  std::ranges::sort(points_W, {}, along);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (auto a = points_W.begin(); a != points_W.end(); ++a) {
    for (auto b = a + 1; b != points_W.end() && along(*b) - along(*a) <= radius_m_; ++b) {
      if (a->segment == b->segment || !(a->is_inside || b->is_inside)) continue;
      if (!are_neighbours(a->point_W, b->point_W, radius_m_)) continue;
      if (a->is_inside) pairs.emplace_back(a->segment, b->segment);
      if (b->is_inside) pairs.emplace_back(b->segment, a->segment);
    }
  }
  std::ranges::sort(pairs);
  std::vector<Border> borders;
  for (const auto& [segment, other] : pairs) {
    const bool is_next = borders.empty() || borders.back().segment != segment ||
                         borders.back().neighbour.segment_id != other;
    if (is_next) borders.push_back({segment, {other, 0}});
    ++borders.back().neighbour.num_pairs;
  }
  return borders;
}

}  // namespace kintsugi::segmenter
