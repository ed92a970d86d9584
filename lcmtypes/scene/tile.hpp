#pragma once
// A piece of the map as the page in a browser gets it: its points, quantised and in an order in
// which every prefix is a coarser level of detail, and the segments of these points.
//
// Points and labels have revisions of their own: segments that change resend no points. Points are
// in the frame P of their patch: a correction resends only its pose.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::scene {

/// Bytes of a point in a tile: position (3 x uint16), normal (2), red, green, blue.
inline constexpr std::size_t kPointBytes = 11;

/// The index in the map of the i-th point of a tile of `count` points, 0 <= i < count. A step near
/// the golden ratio, without a common divisor with `count`, so that each point comes once and those
/// of any prefix lie evenly apart in the order of the map, which follows the surface.
class TileOrder {
 public:
  explicit TileOrder(std::uint32_t count);
  std::uint32_t operator()(std::uint32_t i) const {
    return static_cast<std::uint32_t>(std::uint64_t{i} * step_ % count_);
  }

 private:
  std::uint64_t count_;
  std::uint64_t step_ = 1;
};

/// The points of a tile, as they are transferred. Immutable once made.
///
/// A coordinate is box_min + q / 65535 * box_size: its error is at most box_size / 131070. The
/// normal is octahedral, with an error of at most 1 degree; 255, 255 stands for no normal.
struct TilePoints {
  std::uint32_t revision = 0;
  std::uint32_t count = 0;
  Eigen::Vector3f box_min_P = Eigen::Vector3f::Zero();   ///< metres
  Eigen::Vector3f box_size_P = Eigen::Vector3f::Zero();  ///< metres
  std::vector<std::uint8_t> records;                     ///< kPointBytes each, in tile order

  /// The i-th point in tile order, metres, P.
  Eigen::Vector3f position_P(std::uint32_t i) const;
};

/// The segment of each point of a tile, as an index into a table of ids. Immutable once made.
struct TileLabels {
  std::uint32_t revision = 0;
  std::vector<std::uint32_t> table;
  std::uint32_t index_bytes = 1;      ///< of each index: 1, 2 or 4
  std::vector<std::uint8_t> indices;  ///< little-endian, in tile order

  std::uint32_t label(std::uint32_t i) const;  ///< segment id of the i-th point in tile order
};

/// Points that are not finite become the least corner of the box.
TilePoints make_points(std::span<const CloudPoint> points_P, std::uint32_t revision);
TileLabels make_labels(std::span<const std::uint32_t> segment_ids, std::uint32_t revision);

/// Where a tile is, its points and its labels.
struct Tile {
  std::uint32_t id = 0;
  std::int32_t part = 0;  ///< of the map
  float resolution_m = 0.0F;
  PatchPose X_WP;
  std::shared_ptr<const TilePoints> points;  ///< not null
  std::shared_ptr<const TileLabels> labels;  ///< not null, of as many points
};

/// Appends a block: the points [first, first + count) of the tile with their labels, or with
/// `with_points` false their labels only. Both are cut off at the end of the tile. All values are
/// little-endian:
///
///   uint32 magic "KTL1", id, revision of the points, revision of the labels, first, count, count
///          of the whole tile, length of the table, bytes of an index, 1 if there are points
///   float  box_min_P[3], box_size_P[3]
///   uint32 table[], then the indices, filled up to 4 bytes, then the points, filled up to 4 bytes
void append_block(const Tile& tile, std::uint32_t first, std::uint32_t count, bool with_points,
                  std::string& out);

/// The most bytes that append_block() appends for so many points, without the table.
constexpr std::size_t max_block_bytes(std::size_t count) { return 72 + count * (kPointBytes + 4); }

}  // namespace kintsugi::scene
