#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <memory_resource>
#include <span>
#include <unordered_map>
#include <vector>

#include "lcmtypes/base/reserved_arena.hpp"
#include "segmenter/core/graph/neighbour_index.hpp"
#include "segmenter/core/points/cell.hpp"

namespace kintsugi::segmenter {

/// Neighbours by a uniform grid of cells slightly wider than r.
///
///   tile   8 x 8 x 8 blocks; found by hash
///   block  4 x 4 x 4 cells; its points in one run of memory, sorted by row
///   row    the 4 cells of a block with the same y and z
///
/// A change rewrites the blocks that its points lie in and nothing else. Only the directory of
/// tiles is ever rehashed as a whole, and each of its entries stands for thousands of points.
class GridIndex final : public NeighbourIndex {
 public:
  class Cursor;

  GridIndex(const PointCloud& cloud, float radius_m);
  ~GridIndex() override;

  void insert(std::span<const PointIndex> points) override;
  void remove(std::span<const PointIndex> points) override;
  void assign(const PointRows& rows) override;
  void visit(std::span<const PointIndex> points, const Visit& visit_point) const override;
  void visit_places(std::span<const CloudPoint> places_W, const Visit& visit_place) const override;
  void visit_concurrently(std::span<const PointIndex> points,
                          const Visit& visit_point) const override;
  void visit_all(const Visit& visit_point) const override;
  void swap_to(SwapSpace& space) override { arena_.swap_to(space); }
  std::size_t bytes() const override;

  /// Calls fn(PointIndex) for each neighbour of `point`, in no particular order, without allocating
  /// memory. For many points one after the other a Cursor is faster.
  template <typename Fn>
  void for_each_neighbour(PointIndex point, Fn&& fn) const;

 private:
  static constexpr int kBlockBits = 2;
  static constexpr std::int32_t kBlockSide = 1 << kBlockBits;  ///< cells along an edge of a block
  static constexpr std::int32_t kNumRows = kBlockSide * kBlockSide;
  static constexpr int kTileBits = 3;
  static constexpr std::int32_t kTileSide = 1 << kTileBits;  ///< blocks along an edge of a tile
  static constexpr std::int32_t kNumBlocks = kTileSide * kTileSide * kTileSide;

  struct Entry {
    float x, y, z;
    PointIndex point;
  };
  struct Block {
    explicit Block(std::pmr::memory_resource* memory) : entries(memory) {}

    std::array<std::uint32_t, kNumRows + 1> first{};  ///< by row, y fastest: its first entry
    std::uint32_t num_arrivals = 0;                   ///< used by insert(), else zero
    std::pmr::vector<Entry> entries;                  ///< sorted by row
  };
  struct Run;
  struct Tile {
    std::array<std::unique_ptr<Block>, kNumBlocks> blocks;  ///< x fastest
  };

  // Defined here so that inner loops inline them. Sides are powers of two: >> and & round towards
  // minus infinity, as a grid needs.
  static Cell block_of(const Cell& cell) {
    return {cell.x >> kBlockBits, cell.y >> kBlockBits, cell.z >> kBlockBits};
  }
  static Cell tile_of(const Cell& block) {
    return {block.x >> kTileBits, block.y >> kTileBits, block.z >> kTileBits};
  }
  static std::int32_t place_in_tile(const Cell& block) {
    constexpr std::int32_t kMask = kTileSide - 1;
    return ((block.z & kMask) * kTileSide + (block.y & kMask)) * kTileSide + (block.x & kMask);
  }
  static std::int32_t row_in_block(std::int32_t cell_y, std::int32_t cell_z) {
    constexpr std::int32_t kMask = kBlockSide - 1;
    return (cell_z & kMask) * kBlockSide + (cell_y & kMask);
  }
  Cell cell_of(float x, float y, float z) const {
    return {cell_coordinate(x, cell_m_), cell_coordinate(y, cell_m_), cell_coordinate(z, cell_m_)};
  }
  std::int32_t row_of(const Entry& entry) const {
    return row_in_block(cell_coordinate(entry.y, cell_m_), cell_coordinate(entry.z, cell_m_));
  }
  const Tile* find_tile(const Cell& tile) const {
    const auto found = tiles_.find(tile);
    return found == tiles_.end() ? nullptr : found->second.get();
  }
  Block& block_at(const Cell& block);
  void sort_by_row(Block& block, std::vector<Entry>& scratch) const;
  void remove(PointIndex point);
  void empty_blocks();
  void append_runs(const PointRows& rows, std::size_t row, std::vector<Run>& runs);
  static void fill_layer(const PointRows& rows, std::span<const Run> runs);

  const PointCloud& cloud_;
  float squared_radius_m2_;
  double cell_m_;
  ReservedArena arena_;
  std::pmr::synchronized_pool_resource pool_{&arena_};  ///< of the entries
  std::unordered_map<Cell, std::unique_ptr<Tile>, CellHash> tiles_;
  std::size_t num_blocks_ = 0;
};

/// Finds the neighbours of one point after the other. It is fast where consecutive points are in
/// one tile. Valid until the index changes.
class GridIndex::Cursor {
 public:
  /// Of no index; to be assigned to.
  Cursor() = default;
  explicit Cursor(const GridIndex& index) : index_(&index) {}

  /// As GridIndex::for_each_neighbour().
  template <typename Fn>
  void for_each_neighbour(PointIndex point, Fn&& fn) {
    for_each_near(index_->cloud_[point], point, fn);
  }
  /// The same for any position, except that `left_out` is not reported.
  template <typename Fn>
  void for_each_near(const CloudPoint& p, PointIndex left_out, Fn&& fn) {
    const Cell cell = index_->cell_of(p.x, p.y, p.z);
    const Cell first = block_of({cell.x - 1, cell.y - 1, cell.z - 1});
    const Cell last = block_of({cell.x + 1, cell.y + 1, cell.z + 1});
    for (Cell at = first; at.z <= last.z; ++at.z) {
      for (at.y = first.y; at.y <= last.y; ++at.y) {
        for (at.x = first.x; at.x <= last.x; ++at.x) {
          if (const Block* const block = find_block(at)) scan(*block, at, cell, p, left_out, fn);
        }
      }
    }
  }

 private:
  const Block* find_block(const Cell& block) {
    const Cell tile_cell = tile_of(block);
    if (tile_ == nullptr || !(tile_cell == tile_cell_)) {
      tile_ = index_->find_tile(tile_cell);
      tile_cell_ = tile_cell;
    }
    return tile_ == nullptr ? nullptr : tile_->blocks[place_in_tile(block)].get();
  }

  /// Visits the rows of `block` around `cell`. For each z they are contiguous, since y is fastest.
  template <typename Fn>
  void scan(const Block& block, const Cell& at, const Cell& cell, const CloudPoint& p,
            PointIndex left_out, Fn& fn) const {
    const auto first_in_block = [](std::int32_t b) { return b * kBlockSide; };
    const auto last_in_block = [](std::int32_t b) { return b * kBlockSide + kBlockSide - 1; };
    const std::int32_t first_y = std::max(cell.y - 1, first_in_block(at.y));
    const std::int32_t last_y = std::min(cell.y + 1, last_in_block(at.y));
    const std::int32_t last_z = std::min(cell.z + 1, last_in_block(at.z));
    for (std::int32_t z = std::max(cell.z - 1, first_in_block(at.z)); z <= last_z; ++z) {
      const Entry* const begin = block.entries.data() + block.first[row_in_block(first_y, z)];
      const Entry* const end = block.entries.data() + block.first[row_in_block(last_y, z) + 1];
      for (const Entry* e = begin; e != end; ++e) {
        const float dx = p.x - e->x;
        const float dy = p.y - e->y;
        const float dz = p.z - e->z;
        // The order of operations of squared_distance().
        const bool is_near = (dx * dx + dy * dy) + dz * dz < index_->squared_radius_m2_;
        if (is_near && e->point != left_out) fn(e->point);
      }
    }
  }

  const GridIndex* index_ = nullptr;
  const Tile* tile_ = nullptr;
  Cell tile_cell_;
};

template <typename Fn>
void GridIndex::for_each_neighbour(PointIndex point, Fn&& fn) const {
  Cursor(*this).for_each_neighbour(point, fn);
}

}  // namespace kintsugi::segmenter
