#include "segmenter/map/block_extents.hpp"

#include <algorithm>

namespace kintsugi::segmenter {
namespace {

/// The extent of the points in the block; empty when the block has none of the segment.
Extent extent_of(std::uint32_t block, const PointCloud& cloud, std::span<const std::uint32_t> ids,
                 std::uint32_t segment_id) {
  Extent extent;
  SliceFinder slice_of(cloud);
  const PointIndex first = block * BlockExtents::kBlockPoints;
  const auto size = std::min<std::size_t>(ids.size() - first, BlockExtents::kBlockPoints);
  for (PointIndex i = first; i < first + size; ++i) {
    if (ids[i] == segment_id) extent.include(cloud[i], slice_of(i).slice_id);
  }
  return extent;
}

}  // namespace

void BlockExtents::refresh(std::span<const std::uint32_t> blocks, const PointCloud& cloud,
                           std::span<const std::uint32_t> ids, std::uint32_t segment_id) {
  const auto by_number = [](const Block& a, const Block& b) { return a.number < b.number; };
  const auto num_old = std::ssize(blocks_);
  auto known = blocks_.begin();
  std::vector<Block> more;
  bool is_any_gone = false;
  for (const std::uint32_t number : blocks) {
    const Block block{number, extent_of(number, cloud, ids, segment_id)};
    is_any_gone = is_any_gone || block.extent.is_empty();
    known = std::lower_bound(known, blocks_.end(), block, by_number);
    if (known != blocks_.end() && known->number == number) {
      known->extent = block.extent;
    } else if (!block.extent.is_empty()) {
      more.push_back(block);
    }
  }
  if (!more.empty()) {
    blocks_.insert(blocks_.end(), more.begin(), more.end());
    std::inplace_merge(blocks_.begin(), blocks_.begin() + num_old, blocks_.end(), by_number);
  }
  if (is_any_gone) {
    std::erase_if(blocks_, [](const Block& block) { return block.extent.is_empty(); });
  }
}

Extent BlockExtents::combined() const {
  Extent extent;
  for (const Block& block : blocks_) extent.include(block.extent);
  return extent;
}

}  // namespace kintsugi::segmenter
