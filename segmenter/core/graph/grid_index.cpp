#include "segmenter/core/graph/grid_index.hpp"

#include <cassert>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

namespace kintsugi::segmenter {
namespace {

constexpr std::size_t kPointsPerTask = 2048;

constexpr PointIndex kNoPoint = UINT32_MAX;

}  // namespace

GridIndex::GridIndex(const PointCloud& cloud, float radius_m)
    : cloud_(cloud),
      squared_radius_m2_(radius_m * radius_m),
      cell_m_(static_cast<double>(radius_m) * kCellsPerRadius) {
  assert(radius_m > 0.0F);
}

GridIndex::~GridIndex() = default;

/// Creates the block if it does not exist.
GridIndex::Block& GridIndex::block_at(const Cell& block) {
  std::unique_ptr<Tile>& tile = tiles_[tile_of(block)];
  if (!tile) tile = std::make_unique<Tile>();
  std::unique_ptr<Block>& place = tile->blocks[place_in_tile(block)];
  if (!place) {
    place = std::make_unique<Block>(&pool_);
    ++num_blocks_;
  }
  return *place;
}

void GridIndex::insert(std::span<const PointIndex> points) {
  std::vector<Block*> block_of_point;
  block_of_point.reserve(points.size());
  std::vector<Block*> touched;
  for (const PointIndex i : points) {
    const CloudPoint& p = cloud_[i];
    Block& block = block_at(block_of(cell_of(p.x, p.y, p.z)));
    if (block.num_arrivals++ == 0) touched.push_back(&block);
    block_of_point.push_back(&block);
  }
  // No spare room: a block that gets points is rewritten anyway.
  for (Block* const block : touched) {
    block->entries.reserve(block->entries.size() + block->num_arrivals);
    block->num_arrivals = 0;
  }
  for (std::size_t k = 0; k < points.size(); ++k) {
    const CloudPoint& p = cloud_[points[k]];
    block_of_point[k]->entries.push_back({p.x, p.y, p.z, points[k]});
  }
  std::vector<Entry> scratch;
  for (Block* const block : touched) sort_by_row(*block, scratch);
}

/// A stable counting sort.
void GridIndex::sort_by_row(Block& block, std::vector<Entry>& scratch) const {
  scratch.assign(block.entries.begin(), block.entries.end());
  std::array<std::uint32_t, kNumRows + 1> next{};
  for (const Entry& entry : scratch) ++next[row_of(entry) + 1];
  for (std::int32_t row = 0; row < kNumRows; ++row) next[row + 1] += next[row];
  block.first = next;
  for (const Entry& entry : scratch) block.entries[next[row_of(entry)]++] = entry;
}

void GridIndex::remove(std::span<const PointIndex> points) {
  for (const PointIndex point : points) remove(point);
}

void GridIndex::remove(PointIndex point) {
  const CloudPoint& p = cloud_[point];
  const Cell cell = cell_of(p.x, p.y, p.z);
  Block& block = block_at(block_of(cell));
  const std::int32_t row = row_in_block(cell.y, cell.z);
  const auto first = block.entries.begin() + block.first[row];
  const auto last = block.entries.begin() + block.first[row + 1];
  const auto found = std::find_if(first, last, [&](const Entry& e) { return e.point == point; });
  assert(found != last);
  if (found == last) return;
  block.entries.erase(found);
  for (std::int32_t r = row + 1; r <= kNumRows; ++r) --block.first[r];
  if (block.entries.size() <= block.entries.capacity() / 2) block.entries.shrink_to_fit();
}

void GridIndex::visit(std::span<const PointIndex> points, const Visit& visit_point) const {
  Cursor cursor(*this);
  std::vector<PointIndex> neighbours;
  for (const PointIndex point : points) {
    neighbours.clear();
    cursor.for_each_neighbour(point, [&](PointIndex j) { neighbours.push_back(j); });
    visit_point(point, neighbours);
  }
}

void GridIndex::visit_places(std::span<const CloudPoint> places_W, const Visit& visit_place) const {
  Cursor cursor(*this);
  std::vector<PointIndex> neighbours;
  for (PointIndex k = 0; k < places_W.size(); ++k) {
    neighbours.clear();
    cursor.for_each_near(places_W[k], kNoPoint, [&](PointIndex j) { neighbours.push_back(j); });
    visit_place(k, neighbours);
  }
}

void GridIndex::visit_concurrently(std::span<const PointIndex> points,
                                   const Visit& visit_point) const {
  using Range = oneapi::tbb::blocked_range<std::size_t>;
  oneapi::tbb::parallel_for(Range(0, points.size(), kPointsPerTask), [&](const Range& range) {
    visit(points.subspan(range.begin(), range.size()), visit_point);
  });
}

void GridIndex::visit_all(const Visit& visit_point) const {
  std::vector<const Tile*> tiles;
  tiles.reserve(tiles_.size());
  for (const auto& [cell, tile] : tiles_) tiles.push_back(tile.get());
  oneapi::tbb::parallel_for(std::size_t{0}, tiles.size(), [&](std::size_t t) {
    std::vector<PointIndex> points;
    for (const std::unique_ptr<Block>& block : tiles[t]->blocks) {
      if (!block) continue;
      for (const Entry& entry : block->entries) points.push_back(entry.point);
    }
    visit(points, visit_point);
  });
}

std::size_t GridIndex::bytes() const {
  return arena_.bytes() + num_blocks_ * sizeof(Block) +
         tiles_.size() * (sizeof(Tile) + sizeof(Cell) + 4 * sizeof(void*));
}

}  // namespace kintsugi::segmenter
