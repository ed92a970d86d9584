// Filling the grid with all points at once, from points that are sorted into rows.

#include <cassert>
#include <vector>

#include <oneapi/tbb/parallel_for.h>

#include "segmenter/core/graph/grid_index.hpp"

namespace kintsugi::segmenter {

/// The points of a row that are in one block.
struct GridIndex::Run {
  Block* block;
  std::int32_t row;  ///< in the block
  PointRows::Slot first;
  PointRows::Slot last;  ///< one past it
};

/// The rows of `rows` are as wide as those of the blocks. So these are filled in their order.
void GridIndex::assign(const PointRows& rows) {
  empty_blocks();
  // Rows come by z. A layer of blocks is filled by one thread, so each block is.
  std::vector<std::vector<Run>> layers;
  std::int32_t last_z = 0;
  for (std::size_t r = 0; r < rows.num_rows(); ++r) {
    const std::int32_t z = rows.row(r).z >> kBlockBits;
    if (layers.empty() || z != last_z) layers.emplace_back();
    last_z = z;
    append_runs(rows, r, layers.back());
  }
  oneapi::tbb::parallel_for(std::size_t{0}, layers.size(),
                            [&](std::size_t k) { fill_layer(rows, layers[k]); });
}

/// Blocks that had points keep their memory: most of them will have points again.
void GridIndex::empty_blocks() {
  for (const auto& [cell, tile] : tiles_) {
    for (std::unique_ptr<Block>& block : tile->blocks) {
      if (!block) continue;
      if (block->entries.empty()) {
        --num_blocks_;
        block.reset();
      } else {
        block->entries.clear();
        block->first.fill(0);
      }
    }
  }
}

void GridIndex::append_runs(const PointRows& rows, std::size_t row, std::vector<Run>& runs) {
  const auto [z, y, first, last] = rows.row(row);
  const auto block_x = [&](PointRows::Slot slot) {
    return cell_coordinate(rows.points()[slot].x, cell_m_) >> kBlockBits;
  };
  for (PointRows::Slot slot = first; slot < last;) {
    const std::int32_t x = block_x(slot);
    Run run{&block_at({x, y >> kBlockBits, z >> kBlockBits}), row_in_block(y, z), slot, slot};
    while (run.last < last && block_x(run.last) == x) ++run.last;
    slot = run.last;
    runs.push_back(run);
  }
}

void GridIndex::fill_layer(const PointRows& rows, std::span<const Run> runs) {
  std::vector<Block*> blocks;
  for (const Run& run : runs) {
    if (run.block->num_arrivals == 0) blocks.push_back(run.block);
    run.block->num_arrivals += run.last - run.first;
  }
  for (Block* const block : blocks) {
    block->entries.reserve(block->num_arrivals);
    block->num_arrivals = 0;
  }
  for (const Run& run : runs) {
    for (PointRows::Slot slot = run.first; slot < run.last; ++slot) {
      const PointRows::Point& p = rows.points()[slot];
      run.block->entries.push_back({p.x, p.y, p.z, p.index});
    }
    run.block->first.at(static_cast<std::size_t>(run.row) + 1) += run.last - run.first;
  }
  for (Block* const block : blocks) {
    for (std::size_t row = 0; row < kNumRows; ++row)
      block->first.at(row + 1) += block->first.at(row);
  }
}

}  // namespace kintsugi::segmenter
