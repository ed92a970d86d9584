#pragma once
// The points of a growing map by segment and by place.

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "lcmtypes/scene/up_direction.hpp"
#include "segmenter/objects/recognition/object_recognizer.hpp"

namespace kintsugi::segmenter {

/// Pieces (slices of the map) with labels, as a client of the bus has them, or a saved map as one
/// piece.
class LabelledMap {
 public:
  using Points = std::shared_ptr<const std::vector<CloudPoint>>;

  /// Adds or replaces a piece; `segment_ids` of each point, 0 for none. Returns the segments that
  /// lost or gained points.
  /// @throws std::invalid_argument unless there is a label for each point
  std::set<std::uint32_t> set_piece(std::int32_t id, Points points_W,
                                    std::vector<std::uint32_t> segment_ids);

  /// All points in the box.
  [[nodiscard]] MapExcerpt points_in(const Eigen::AlignedBox3f& box_W) const;
  /// All points of these segments, which are given in ascending order.
  [[nodiscard]] std::vector<CloudPoint> points_of(std::span<const std::uint32_t> ids) const;
  /// Of a segment; 0 if there is none of this id.
  [[nodiscard]] std::int64_t num_points(std::uint32_t id) const;
  [[nodiscard]] std::int64_t num_points() const { return num_points_; }
  [[nodiscard]] std::size_t num_segments() const { return pieces_of_.size(); }
  /// The ids of all segments, the one with most points first.
  [[nodiscard]] std::vector<std::uint32_t> segments() const;
  /// The box of a segment; empty if there is none of this id.
  [[nodiscard]] Eigen::AlignedBox3f box_of(std::uint32_t id) const;
  /// The direction that is up in W.
  [[nodiscard]] Eigen::Vector3d up_W() const { return up_.up_W(); }

 private:
  struct Part {
    std::int64_t count = 0;
    Eigen::AlignedBox3f box;
  };
  struct Piece {
    Points points_W;
    std::vector<std::uint32_t> segment_ids;
    Eigen::AlignedBox3f box;
    std::map<std::uint32_t, Part> segments;
  };

  std::map<std::int32_t, Piece> pieces_;
  std::map<std::uint32_t, std::set<std::int32_t>> pieces_of_;  // by segment
  UpDirection up_;
  std::int64_t num_points_ = 0;
};

}  // namespace kintsugi::segmenter
