#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "segmenter/core/cell.hpp"
#include "segmenter/core/neighbour_index.hpp"

namespace kintsugi::segmenter {

/// Neighbours by a uniform grid: cells a trifle wider than r, in blocks of 8 x 8 x 8 cells.
///
/// A block keeps its points sorted by cell, so the three cells of a row are one run of memory. Only
/// the blocks that a slice touches are sorted again.
class GridIndex final : public NeighbourIndex {
 public:
  GridIndex(const PointCloud& cloud, float radius_m);

  void update() override;
  void visit(std::span<const PointIndex> points, const Visit& visit_point) const override;
  void visit_all(const Visit& visit_point) const override;

 private:
  static constexpr int kSideBits = 3;
  static constexpr std::int32_t kSide = 1 << kSideBits;  ///< cells along an edge of a block
  static constexpr std::int32_t kNumCells = kSide * kSide * kSide;
  static constexpr std::uint32_t kNoBlock = UINT32_MAX;

  struct Entry {
    float x, y, z;
    PointIndex point;
  };
  struct Block {
    Cell cell;                                         ///< of the block, in units of kSide cells
    std::array<std::uint32_t, kNumCells + 1> first{};  ///< entry where each cell begins; x fastest
    std::vector<Entry> entries;                        ///< by cell, then by point
  };
  struct Neighbourhood;

  // In the header, for the inner loops: position-independent code calls what is not inline.
  // kSide is a power of two: >> and & round towards minus infinity, as the grid needs.
  static Cell block_of(const Cell& cell) {
    return {cell.x >> kSideBits, cell.y >> kSideBits, cell.z >> kSideBits};
  }
  /// Place of a cell in its block, x fastest.
  static std::int32_t place_of(const Cell& cell) {
    constexpr std::int32_t kMask = kSide - 1;
    return ((cell.z & kMask) * kSide + (cell.y & kMask)) * kSide + (cell.x & kMask);
  }
  Cell cell_of(float x, float y, float z) const {
    return {cell_coordinate(x, cell_m_), cell_coordinate(y, cell_m_), cell_coordinate(z, cell_m_)};
  }
  std::uint32_t find_block(const Cell& block) const;
  Neighbourhood neighbourhood_of(const Cell& block) const;
  void find_neighbours(const Entry& query, const Cell& cell, const Neighbourhood& around,
                       std::vector<PointIndex>& neighbours) const;
  void insert(Block& block, std::span<const PointIndex> points) const;

  const PointCloud& cloud_;
  float squared_radius_m2_;
  double cell_m_;
  PointIndex num_indexed_ = 0;
  std::vector<Block> blocks_;
  std::unordered_map<Cell, std::uint32_t, CellHash> block_at_;
};

}  // namespace kintsugi::segmenter
