#pragma once
// Which segments of a growing map touch.

#include <cstdint>
#include <vector>

#include <oneapi/tbb/concurrent_unordered_map.h>

#include "segmenter/description/adjacency_graph.hpp"
#include "segmenter/objects/recognition/labelled_map.hpp"

namespace kintsugi::segmenter {

/// The neighbours of segments, as neighbours_of() of a whole cloud has them. Pairs of points are
/// counted block by block when they are first asked for, and kept until the block or one beside it
/// changes: where the map grows, all segments of a place change at once. Several threads may ask,
/// while nobody changes the map.
class SegmentBorders {
 public:
  /// `map` must outlive this. @param radius_m of neighbours, > 0, less than a block
  SegmentBorders(const LabelledMap& map, float radius_m) : map_(map), radius_m_(radius_m) {}

  /// The map has changed.
  void forget(const LabelledMap::Change& change);

  /// By ascending id; none if there is no such segment.
  [[nodiscard]] const std::vector<SegmentNeighbour>& neighbours_of(std::uint32_t segment) const;

 private:
  struct Border {
    std::uint32_t segment = kNoSegment;
    SegmentNeighbour neighbour;
  };
  struct Block {
    std::vector<std::uint32_t> segments;  // that have points in it, ascending
    /// Pairs of a point in the block and one in or around it, by ascending segment and neighbour.
    std::vector<Border> borders;
  };
  struct LabelledPoint;

  [[nodiscard]] const Block& block(const BlockKey& key) const;
  [[nodiscard]] Block counted(const BlockKey& key) const;
  [[nodiscard]] std::vector<LabelledPoint> points_around(const BlockKey& key) const;
  [[nodiscard]] std::vector<Border> borders_between(std::vector<LabelledPoint> points_W) const;

  const LabelledMap& map_;
  float radius_m_;
  // Of those that were asked for.
  mutable oneapi::tbb::concurrent_unordered_map<BlockKey, Block, BlockKeyHash> blocks_;
  mutable oneapi::tbb::concurrent_unordered_map<std::uint32_t, std::vector<SegmentNeighbour>>
      neighbours_;
};

}  // namespace kintsugi::segmenter
