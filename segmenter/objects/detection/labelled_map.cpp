#include "segmenter/objects/detection/labelled_map.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>

namespace kintsugi::segmenter {

namespace {

Eigen::Vector3f position(const CloudPoint& p) { return {p.x, p.y, p.z}; }

}  // namespace

std::set<std::uint32_t> LabelledMap::set_piece(std::int32_t id, Points points_W,
                                               std::vector<std::uint32_t> segment_ids) {
  if (points_W->size() != segment_ids.size()) {
    throw std::invalid_argument("piece " + std::to_string(id) + " has " +
                                std::to_string(points_W->size()) + " points and " +
                                std::to_string(segment_ids.size()) + " labels");
  }
  Piece piece;
  for (std::size_t i = 0; i < segment_ids.size(); ++i) {
    const Eigen::Vector3f p_W = position((*points_W)[i]);
    piece.box.extend(p_W);
    if (segment_ids[i] == kNoSegment) continue;
    Part& part = piece.segments[segment_ids[i]];
    ++part.count;
    part.box.extend(p_W);
  }
  piece.points_W = std::move(points_W);
  piece.segment_ids = std::move(segment_ids);

  std::set<std::uint32_t> changed;
  const auto old = pieces_.find(id);
  if (old != pieces_.end()) {
    for (const auto& [segment, part] : old->second.segments) {
      // The same points in the same segment: nothing has changed.
      const auto now = piece.segments.find(segment);
      if (now == piece.segments.end() || now->second.count != part.count ||
          old->second.points_W != piece.points_W) {
        changed.insert(segment);
      }
      const auto of = pieces_of_.find(segment);
      of->second.erase(id);
      if (of->second.empty()) pieces_of_.erase(of);
    }
    up_.remove(*old->second.points_W);
    num_points_ -= static_cast<std::int64_t>(old->second.points_W->size());
  }
  for (const auto& [segment, part] : piece.segments) {
    if (old == pieces_.end() || !old->second.segments.contains(segment)) changed.insert(segment);
    pieces_of_[segment].insert(id);
  }
  up_.add(*piece.points_W);
  num_points_ += static_cast<std::int64_t>(piece.points_W->size());
  pieces_[id] = std::move(piece);
  return changed;
}

MapExcerpt LabelledMap::points_in(const Eigen::AlignedBox3f& box_W) const {
  MapExcerpt excerpt;
  for (const auto& [id, piece] : pieces_) {
    if (!box_W.intersects(piece.box)) continue;
    for (std::size_t i = 0; i < piece.segment_ids.size(); ++i) {
      const CloudPoint& point = (*piece.points_W)[i];
      if (!box_W.contains(position(point))) continue;
      excerpt.points_W.push_back(point);
      excerpt.segment_ids.push_back(piece.segment_ids[i]);
    }
  }
  return excerpt;
}

std::vector<CloudPoint> LabelledMap::points_of(std::span<const std::uint32_t> ids) const {
  std::set<std::int32_t> pieces;
  for (const std::uint32_t id : ids) {
    const auto of = pieces_of_.find(id);
    if (of != pieces_of_.end()) pieces.insert(of->second.begin(), of->second.end());
  }
  std::vector<CloudPoint> points_W;
  for (const std::int32_t piece_id : pieces) {
    const Piece& piece = pieces_.at(piece_id);
    for (std::size_t i = 0; i < piece.segment_ids.size(); ++i) {
      if (std::binary_search(ids.begin(), ids.end(), piece.segment_ids[i])) {
        points_W.push_back((*piece.points_W)[i]);
      }
    }
  }
  return points_W;
}

std::int64_t LabelledMap::num_points(std::uint32_t id) const {
  const auto of = pieces_of_.find(id);
  if (of == pieces_of_.end()) return 0;
  std::int64_t count = 0;
  for (const std::int32_t piece : of->second) count += pieces_.at(piece).segments.at(id).count;
  return count;
}

Eigen::AlignedBox3f LabelledMap::box_of(std::uint32_t id) const {
  Eigen::AlignedBox3f box;
  const auto of = pieces_of_.find(id);
  if (of == pieces_of_.end()) return box;
  for (const std::int32_t piece : of->second) box.extend(pieces_.at(piece).segments.at(id).box);
  return box;
}

}  // namespace kintsugi::segmenter
