#include "segmenter/core/grid_index.hpp"

#include <algorithm>
#include <cassert>
#include <optional>
#include <utility>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

namespace kintsugi::segmenter {
namespace {

// Two neighbours may lie a rounding of float32 further apart than r (relative 2^-22 or so); cells
// this much wider than r keep them in adjacent cells nevertheless.
constexpr double kCellsPerRadius = 1.0 + 1e-5;

constexpr std::size_t kPointsPerTask = 2048;
constexpr std::size_t kBlocksPerTask = 8;

}  // namespace

/// The 3 x 3 x 3 blocks around one, nullptr where there is none.
struct GridIndex::Neighbourhood {
  Cell centre;
  std::array<const Block*, 27> blocks{};
};

GridIndex::GridIndex(const PointCloud& cloud, float radius_m)
    : cloud_(cloud),
      squared_radius_m2_(radius_m * radius_m),
      cell_m_(static_cast<double>(radius_m) * kCellsPerRadius) {
  assert(radius_m > 0.0F);
}

std::uint32_t GridIndex::find_block(const Cell& block) const {
  const auto found = block_at_.find(block);
  return found == block_at_.end() ? kNoBlock : found->second;
}

GridIndex::Neighbourhood GridIndex::neighbourhood_of(const Cell& block) const {
  Neighbourhood around{.centre = block};
  std::size_t i = 0;
  for (std::int32_t dz = -1; dz <= 1; ++dz) {
    for (std::int32_t dy = -1; dy <= 1; ++dy) {
      for (std::int32_t dx = -1; dx <= 1; ++dx, ++i) {
        const std::uint32_t found = find_block({block.x + dx, block.y + dy, block.z + dz});
        if (found != kNoBlock) around.blocks[i] = &blocks_[found];
      }
    }
  }
  return around;
}

void GridIndex::update() {
  // The new points by block, in the order of their index.
  std::vector<std::pair<std::uint32_t, PointIndex>> arrivals;
  arrivals.reserve(cloud_.size() - num_indexed_);
  for (PointIndex i = num_indexed_; i < cloud_.size(); ++i) {
    const CloudPoint& p = cloud_[i];
    const Cell cell = block_of(cell_of(p.x, p.y, p.z));
    const auto [at, is_new] =
        block_at_.try_emplace(cell, static_cast<std::uint32_t>(blocks_.size()));
    if (is_new) blocks_.emplace_back().cell = cell;
    arrivals.emplace_back(at->second, i);
  }
  num_indexed_ = cloud_.size();
  std::sort(arrivals.begin(), arrivals.end());

  std::vector<PointIndex> points;
  for (auto first = arrivals.begin(); first != arrivals.end();) {
    const std::uint32_t block = first->first;
    points.clear();
    for (; first != arrivals.end() && first->first == block; ++first) {
      points.push_back(first->second);
    }
    insert(blocks_[block], points);
  }
}

/// Counting sort of the block's entries by cell; entries of a cell keep their order.
void GridIndex::insert(Block& block, std::span<const PointIndex> points) const {
  std::vector<Entry> unsorted = std::move(block.entries);
  for (const PointIndex i : points) unsorted.push_back({cloud_[i].x, cloud_[i].y, cloud_[i].z, i});
  const auto place = [&](const Entry& e) { return place_of(cell_of(e.x, e.y, e.z)); };

  std::array<std::uint32_t, kNumCells + 1> next{};
  for (const Entry& entry : unsorted) ++next[place(entry) + 1];
  for (std::int32_t c = 0; c < kNumCells; ++c) next[c + 1] += next[c];
  block.first = next;
  block.entries.resize(unsorted.size());
  for (const Entry& entry : unsorted) block.entries[next[place(entry)]++] = entry;
}

void GridIndex::find_neighbours(const Entry& query, const Cell& cell, const Neighbourhood& around,
                                std::vector<PointIndex>& neighbours) const {
  const auto scan = [&](const Block& block, std::int32_t first_cell, std::int32_t last_cell) {
    const Entry* const end = block.entries.data() + block.first[last_cell + 1];
    for (const Entry* e = block.entries.data() + block.first[first_cell]; e != end; ++e) {
      const float dx = query.x - e->x;
      const float dy = query.y - e->y;
      const float dz = query.z - e->z;
      // The order of squared_distance().
      if ((dx * dx + dy * dy) + dz * dz < squared_radius_m2_ && e->point != query.point) {
        neighbours.push_back(e->point);
      }
    }
  };
  neighbours.clear();
  for (std::int32_t z = cell.z - 1; z <= cell.z + 1; ++z) {
    for (std::int32_t y = cell.y - 1; y <= cell.y + 1; ++y) {
      const Cell first_block = block_of({cell.x - 1, y, z});
      const std::int32_t row_of_blocks =
          ((first_block.z - around.centre.z + 1) * 3 + (first_block.y - around.centre.y + 1)) * 3;
      // The row x - 1 .. x + 1 lies in one block or in two.
      for (std::int32_t x = cell.x - 1; x <= cell.x + 1;) {
        const std::int32_t block_x = x >> kSideBits;
        const std::int32_t last_x = std::min(cell.x + 1, block_x * kSide + kSide - 1);
        const Block* block = around.blocks[row_of_blocks + block_x - around.centre.x + 1];
        if (block != nullptr) scan(*block, place_of({x, y, z}), place_of({last_x, y, z}));
        x = last_x + 1;
      }
    }
  }
}

void GridIndex::visit(std::span<const PointIndex> points, const Visit& visit_point) const {
  using Range = oneapi::tbb::blocked_range<std::size_t>;
  oneapi::tbb::parallel_for(Range(0, points.size(), kPointsPerTask), [&](const Range& range) {
    std::vector<PointIndex> neighbours;
    std::optional<Neighbourhood> around;
    for (std::size_t k = range.begin(); k != range.end(); ++k) {
      const CloudPoint& p = cloud_[points[k]];
      const Cell cell = cell_of(p.x, p.y, p.z);
      // Points come in runs from one block: most find the blocks around looked up already.
      if (!around || around->centre != block_of(cell)) around = neighbourhood_of(block_of(cell));
      find_neighbours({p.x, p.y, p.z, points[k]}, cell, *around, neighbours);
      visit_point(points[k], neighbours);
    }
  });
}

void GridIndex::visit_all(const Visit& visit_point) const {
  using Range = oneapi::tbb::blocked_range<std::size_t>;
  oneapi::tbb::parallel_for(Range(0, blocks_.size(), kBlocksPerTask), [&](const Range& range) {
    std::vector<PointIndex> neighbours;
    for (std::size_t b = range.begin(); b != range.end(); ++b) {
      const Neighbourhood around = neighbourhood_of(blocks_[b].cell);
      for (const Entry& e : blocks_[b].entries) {
        find_neighbours(e, cell_of(e.x, e.y, e.z), around, neighbours);
        visit_point(e.point, neighbours);
      }
    }
  });
}

}  // namespace kintsugi::segmenter
