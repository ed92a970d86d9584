#include "segmenter/objects/recognition/labelled_map.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace kintsugi::segmenter {

namespace {

Eigen::Vector3f position(const CloudPoint& p) { return {p.x, p.y, p.z}; }

}  // namespace

LabelledMap::Change LabelledMap::set_piece(std::int32_t id, Points points_W,
                                           std::vector<std::uint32_t> segment_ids) {
  if (points_W->size() != segment_ids.size()) {
    throw std::invalid_argument("piece " + std::to_string(id) + " has " +
                                std::to_string(points_W->size()) + " points and " +
                                std::to_string(segment_ids.size()) + " labels");
  }
  Piece piece;
  for (std::size_t i = 0; i < segment_ids.size(); ++i) {
    if (segment_ids[i] == kNoSegment) continue;
    Part& part = piece.segments[segment_ids[i]];
    part.indices.push_back(static_cast<std::uint32_t>(i));
    part.box.extend(position((*points_W)[i]));
    part.blocks.insert(block_of(position((*points_W)[i])));
  }
  piece.points_W = std::move(points_W);
  piece.segment_ids = std::move(segment_ids);

  Change change;
  const auto old = pieces_.find(id);
  const bool is_new = old == pieces_.end();
  const bool has_new_points = is_new || old->second.points_W != piece.points_W;
  if (!is_new) {
    // A patch is sent again as a whole, also when little of it has changed.
    for (const auto& [segment, part] : old->second.segments) {
      if (!has_same_points(old->second, piece, segment)) change.segments.insert(segment);
    }
  }
  for (const auto& [segment, part] : piece.segments) {
    if (is_new || !old->second.segments.contains(segment)) change.segments.insert(segment);
  }
  for (const std::uint32_t segment : change.segments) {
    if (!is_new) add_blocks(old->second, segment, change.labelled_blocks);
    add_blocks(piece, segment, change.labelled_blocks);
  }
  if (!is_new) {
    remove_labels(id, old->second);
    if (has_new_points) change.blocks = remove_points(id, old->second);
  }
  add_labels(id, piece);
  if (has_new_points) change.blocks.merge(add_points(id, piece));
  pieces_[id] = std::move(piece);
  return change;
}

/// In the same order. `a` has the segment.
bool LabelledMap::has_same_points(const Piece& a, const Piece& b, std::uint32_t segment) {
  const auto there = b.segments.find(segment);
  if (there == b.segments.end()) return false;
  const std::vector<std::uint32_t>& of_a = a.segments.at(segment).indices;
  const std::vector<std::uint32_t>& of_b = there->second.indices;
  if (a.points_W == b.points_W) return of_a == of_b;
  return std::ranges::equal(of_a, of_b, [&](std::uint32_t i, std::uint32_t j) {
    return (*a.points_W)[i] == (*b.points_W)[j];
  });
}

void LabelledMap::add_blocks(const Piece& piece, std::uint32_t segment,
                             std::set<BlockKey>& blocks) {
  const auto part = piece.segments.find(segment);
  if (part == piece.segments.end()) return;
  blocks.insert(part->second.blocks.begin(), part->second.blocks.end());
}

void LabelledMap::remove_labels(std::int32_t id, const Piece& piece) {
  for (const auto& [segment, part] : piece.segments) {
    const auto of = segments_.find(segment);
    of->second.pieces.erase(id);
    of->second.count -= std::ssize(part.indices);
    if (of->second.pieces.empty()) segments_.erase(of);
  }
}

void LabelledMap::add_labels(std::int32_t id, const Piece& piece) {
  for (const auto& [segment, part] : piece.segments) {
    Segment& of = segments_[segment];
    of.pieces.insert(id);
    of.count += std::ssize(part.indices);
  }
}

std::set<BlockKey> LabelledMap::remove_points(std::int32_t id, const Piece& piece) {
  std::set<BlockKey> changed;
  for (const CloudPoint& point : *piece.points_W) changed.insert(block_of(position(point)));
  for (const BlockKey& key : changed) {
    const auto block = blocks_.find(key);
    std::erase_if(block->second, [id](const PointRef& ref) { return ref.piece == id; });
    if (block->second.empty()) blocks_.erase(block);
  }
  up_.remove(*piece.points_W);
  num_points_ -= std::ssize(*piece.points_W);
  return changed;
}

std::set<BlockKey> LabelledMap::add_points(std::int32_t id, const Piece& piece) {
  std::set<BlockKey> changed;
  for (std::size_t i = 0; i < piece.points_W->size(); ++i) {
    const BlockKey key = block_of(position((*piece.points_W)[i]));
    blocks_[key].push_back({id, static_cast<std::uint32_t>(i)});
    changed.insert(key);
  }
  for (const BlockKey& key : changed) std::ranges::sort(blocks_.at(key));
  up_.add(*piece.points_W);
  num_points_ += std::ssize(*piece.points_W);
  return changed;
}

LabelledMap::Points LabelledMap::points_of_piece(std::int32_t id) const {
  const auto piece = pieces_.find(id);
  return piece == pieces_.end() ? nullptr : piece->second.points_W;
}

BlockKey LabelledMap::block_of(const Eigen::Vector3f& p_W) const {
  const Eigen::Vector3i key = (p_W / block_m_).array().floor().cast<int>();
  return {key.x(), key.y(), key.z()};
}

Eigen::AlignedBox3f LabelledMap::box_of(const BlockKey& block, float margin_m) const {
  const Eigen::Vector3f low_W =
      block_m_ * Eigen::Vector3f(static_cast<float>(block[0]), static_cast<float>(block[1]),
                                 static_cast<float>(block[2]));
  return {low_W.array() - margin_m, low_W.array() + (block_m_ + margin_m)};
}

LabelledExcerpt LabelledMap::points_in(const Eigen::AlignedBox3f& box_W) const {
  LabelledExcerpt excerpt;
  if (box_W.isEmpty()) return excerpt;
  const BlockKey low = block_of(box_W.min());
  const BlockKey high = block_of(box_W.max());
  for (std::int32_t z = low[2]; z <= high[2]; ++z) {
    for (std::int32_t y = low[1]; y <= high[1]; ++y) {
      for (std::int32_t x = low[0]; x <= high[0]; ++x) {
        visit_points_in({x, y, z}, [&](PointRef, const CloudPoint& point_W, std::uint32_t id) {
          if (!box_W.contains(position(point_W))) return;
          excerpt.points_W.push_back(point_W);
          excerpt.segment_ids.push_back(id);
        });
      }
    }
  }
  return excerpt;
}

std::vector<CloudPoint> LabelledMap::points_of(std::uint32_t id) const {
  std::vector<CloudPoint> points_W;
  const auto of = segments_.find(id);
  if (of == segments_.end()) return points_W;
  points_W.reserve(static_cast<std::size_t>(of->second.count));
  for (const std::int32_t piece_id : of->second.pieces) {
    const Piece& piece = pieces_.at(piece_id);
    for (const std::uint32_t i : piece.segments.at(id).indices) {
      points_W.push_back((*piece.points_W)[i]);
    }
  }
  return points_W;
}

std::int64_t LabelledMap::num_points(std::uint32_t id) const {
  const auto of = segments_.find(id);
  return of == segments_.end() ? 0 : of->second.count;
}

std::vector<std::uint32_t> LabelledMap::segments() const {
  std::vector<std::pair<std::int64_t, std::uint32_t>> by_size;
  by_size.reserve(segments_.size());
  for (const auto& [id, segment] : segments_) by_size.emplace_back(-segment.count, id);
  std::sort(by_size.begin(), by_size.end());
  std::vector<std::uint32_t> ids;
  ids.reserve(by_size.size());
  for (const auto& [size, id] : by_size) ids.push_back(id);
  return ids;
}

std::set<BlockKey> LabelledMap::blocks_of(std::uint32_t id) const {
  std::set<BlockKey> blocks;
  const auto of = segments_.find(id);
  if (of == segments_.end()) return blocks;
  for (const std::int32_t piece : of->second.pieces) add_blocks(pieces_.at(piece), id, blocks);
  return blocks;
}

Eigen::AlignedBox3f LabelledMap::box_of(std::uint32_t id) const {
  Eigen::AlignedBox3f box;
  const auto of = segments_.find(id);
  if (of == segments_.end()) return box;
  for (const std::int32_t piece : of->second.pieces) {
    box.extend(pieces_.at(piece).segments.at(id).box);
  }
  return box;
}

}  // namespace kintsugi::segmenter
