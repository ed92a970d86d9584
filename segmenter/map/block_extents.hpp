#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "segmenter/core/points/point_cloud.hpp"
#include "segmenter/map/extent.hpp"

namespace kintsugi::segmenter {

/// The extent of one large segment by blocks of places in the cloud. When points leave a segment of
/// a million, only their blocks are looked at again, and the extents of some thousand blocks
/// folded.
class BlockExtents {
 public:
  static constexpr PointIndex kBlockPoints = 256;

  /// Looks at `blocks` again, ascending: the points there that have `segment_id` in `ids`.
  void refresh(std::span<const std::uint32_t> blocks, const PointCloud& cloud,
               std::span<const std::uint32_t> ids, std::uint32_t segment_id);

  /// Of all blocks.
  [[nodiscard]] Extent fold() const;

  [[nodiscard]] std::size_t bytes() const { return blocks_.capacity() * sizeof(Block); }

 private:
  struct Block {
    std::uint32_t number;
    Extent extent;
  };
  std::vector<Block> blocks_;  ///< that have points of the segment, by ascending number
};

}  // namespace kintsugi::segmenter
