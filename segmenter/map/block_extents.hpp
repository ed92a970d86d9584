#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "segmenter/core/points/point_cloud.hpp"
#include "segmenter/map/extent.hpp"

namespace kintsugi::segmenter {

/// The extent of one large segment, by blocks of PointIndices. When points leave a segment of a
/// million, only their blocks are scanned again; then the extents of some thousand blocks are
/// combined.
class BlockExtents {
 public:
  static constexpr PointIndex kBlockPoints = 256;

  /// Scans `blocks`, given in ascending order, for the points that have `segment_id` in `ids`.
  void refresh(std::span<const std::uint32_t> blocks, const PointCloud& cloud,
               std::span<const std::uint32_t> ids, std::uint32_t segment_id);

  /// The extent of all blocks together.
  [[nodiscard]] Extent combined() const;

  [[nodiscard]] std::size_t bytes() const { return blocks_.capacity() * sizeof(Block); }

 private:
  struct Block {
    std::uint32_t number;
    Extent extent;
  };
  std::vector<Block> blocks_;  ///< that have points of the segment, by ascending number
};

}  // namespace kintsugi::segmenter
