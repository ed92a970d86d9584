#pragma once
// The points of a growing map by segment and by place.

#include <Eigen/Geometry>
#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <unordered_map>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "lcmtypes/scene/up_direction.hpp"

namespace kintsugi::segmenter {

/// The map is cut into cubes, which are numbered along the axes of W.
using BlockKey = std::array<std::int32_t, 3>;

struct BlockKeyHash {
  std::size_t operator()(const BlockKey& key) const {
    // Teschner et al., "Optimized spatial hashing for collision detection of deformable objects"
    // (2003).
    return (static_cast<std::size_t>(key[0]) * 73'856'093U) ^
           (static_cast<std::size_t>(key[1]) * 19'349'663U) ^
           (static_cast<std::size_t>(key[2]) * 83'492'791U);
  }
};

/// Calls visit(const BlockKey&) for a block and the 26 around it.
template <class Visit>
void for_each_around(const BlockKey& key, const Visit& visit) {
  for (std::int32_t z = key[2] - 1; z <= key[2] + 1; ++z) {
    for (std::int32_t y = key[1] - 1; y <= key[1] + 1; ++y) {
      for (std::int32_t x = key[0] - 1; x <= key[0] + 1; ++x) visit(BlockKey{x, y, z});
    }
  }
}

/// The map around a place.
struct LabelledExcerpt {
  std::vector<CloudPoint> points_W;
  std::vector<std::uint32_t> segment_ids;  ///< of each point
};

/// Pieces (slices of the map) with labels, as a client of the bus has them, or a saved map as one
/// piece.
class LabelledMap {
 public:
  using Points = std::shared_ptr<const std::vector<CloudPoint>>;

  /// Where a point is kept.
  struct PointRef {
    std::int32_t piece = 0;
    std::uint32_t index = 0;

    auto operator<=>(const PointRef&) const = default;
  };

  /// What set_piece() has changed.
  struct Change {
    std::set<std::uint32_t> segments;  ///< that lost, gained or changed points
    std::set<BlockKey> blocks;         ///< in which points came or went; none: only labels changed
    std::set<BlockKey> labelled_blocks;  ///< in which these segments have, or had, such points
  };

  /// @param block_m side of a block, > 0
  explicit LabelledMap(float block_m) : block_m_(block_m) {}

  /// Adds or replaces a piece; `segment_ids` of each point, 0 for none.
  /// @throws std::invalid_argument unless there is a label for each point
  Change set_piece(std::int32_t id, Points points_W, std::vector<std::uint32_t> segment_ids);

  /// The points of a piece; null: there is none of this id.
  [[nodiscard]] Points points_of_piece(std::int32_t id) const;
  /// The labels of the points of a piece. There must be one of this id.
  [[nodiscard]] std::span<const std::uint32_t> labels_of_piece(std::int32_t id) const {
    return pieces_.at(id).segment_ids;
  }

  [[nodiscard]] float block_m() const { return block_m_; }
  [[nodiscard]] BlockKey block_of(const Eigen::Vector3f& p_W) const;
  /// @param margin_m by which the box is larger than the block on each side
  [[nodiscard]] Eigen::AlignedBox3f box_of(const BlockKey& block, float margin_m) const;
  /// Whether there are points in a block.
  [[nodiscard]] bool has_points_in(const BlockKey& block) const { return blocks_.contains(block); }
  /// Calls visit(PointRef, const CloudPoint& point_W, segment id) for all points of a block, by
  /// ascending PointRef: means over them must not depend on the order in which the pieces came.
  template <class Visit>
  void visit_points_in(const BlockKey& block, const Visit& visit) const;

  /// All points in the box.
  [[nodiscard]] LabelledExcerpt points_in(const Eigen::AlignedBox3f& box_W) const;
  /// All points of a segment.
  [[nodiscard]] std::vector<CloudPoint> points_of(std::uint32_t id) const;
  /// Of a segment; 0 if there is none of this id.
  [[nodiscard]] std::int64_t num_points(std::uint32_t id) const;
  [[nodiscard]] std::int64_t num_points() const { return num_points_; }
  [[nodiscard]] std::size_t num_segments() const { return segments_.size(); }
  /// The ids of all segments, the one with most points first.
  [[nodiscard]] std::vector<std::uint32_t> segments() const;
  /// The blocks in which a segment has points, ascending.
  [[nodiscard]] std::set<BlockKey> blocks_of(std::uint32_t id) const;
  /// The box of a segment; empty if there is none of this id.
  [[nodiscard]] Eigen::AlignedBox3f box_of(std::uint32_t id) const;
  /// The direction that is up in W.
  [[nodiscard]] Eigen::Vector3d up_W() const { return up_.up_W(); }

 private:
  struct Part {
    std::vector<std::uint32_t> indices;  // in the piece
    Eigen::AlignedBox3f box;
    std::set<BlockKey> blocks;
  };
  struct Piece {
    Points points_W;
    std::vector<std::uint32_t> segment_ids;
    std::map<std::uint32_t, Part> segments;
  };
  struct Segment {
    std::set<std::int32_t> pieces;
    std::int64_t count = 0;
  };

  static bool has_same_points(const Piece& a, const Piece& b, std::uint32_t segment);
  /// Adds the blocks in which a segment has points of the piece.
  static void add_blocks(const Piece& piece, std::uint32_t segment, std::set<BlockKey>& blocks);
  void remove_labels(std::int32_t id, const Piece& piece);
  void add_labels(std::int32_t id, const Piece& piece);
  std::set<BlockKey> remove_points(std::int32_t id, const Piece& piece);
  std::set<BlockKey> add_points(std::int32_t id, const Piece& piece);

  float block_m_;
  std::map<std::int32_t, Piece> pieces_;
  std::map<std::uint32_t, Segment> segments_;
  std::unordered_map<BlockKey, std::vector<PointRef>, BlockKeyHash> blocks_;
  UpDirection up_;
  std::int64_t num_points_ = 0;
};

template <class Visit>
void LabelledMap::visit_points_in(const BlockKey& block, const Visit& visit) const {
  const auto at = blocks_.find(block);
  if (at == blocks_.end()) return;
  std::int32_t id = 0;
  const Piece* piece = nullptr;  // of this id, once one of its points was found
  for (const PointRef& ref : at->second) {
    if (piece == nullptr || ref.piece != id) {
      id = ref.piece;
      piece = &pieces_.at(id);
    }
    visit(ref, (*piece->points_W)[ref.index], piece->segment_ids[ref.index]);
  }
}

}  // namespace kintsugi::segmenter
