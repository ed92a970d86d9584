#include "segmenter/core/graph/flann_index.hpp"

#include <algorithm>
#include <cstddef>
#include <unordered_set>

#include <flann/flann.hpp>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

namespace kintsugi::segmenter {
namespace {

constexpr double kTile_m = 1.0;
constexpr std::size_t kPointsPerTask = 2048;

// FLANN prunes with its own float32 sums, whose error is a few 2^-24 of r^2 at each level of the
// tree. So it is asked for a radius that is larger by much more than that, and every candidate is
// tested by are_neighbours().
constexpr float kSlack = 1.0F + 1e-4F;

using KdTree = flann::KDTreeSingleIndex<flann::L2_3D<float>>;

/// Collects what FLANN finds, without the allocations of its own result sets.
class Candidates final : public flann::ResultSet<float> {
 public:
  Candidates(float squared_radius_m2, std::vector<std::size_t>& found)
      : squared_radius_m2_(squared_radius_m2), found_(found) {}

  bool full() const override { return true; }
  void addPoint(float /*squared_distance*/, std::size_t index) override { found_.push_back(index); }
  float worstDist() const override { return squared_radius_m2_; }

 private:
  float squared_radius_m2_;
  std::vector<std::size_t>& found_;
};

}  // namespace

struct FlannIndex::Tile {
  std::vector<PointIndex> points;
  std::vector<float> positions_W;  ///< three for each point: FLANN keeps a pointer to them
  std::unique_ptr<KdTree> tree;    ///< null: to be built, or no points

  void build(const PointCloud& cloud) {
    positions_W.clear();
    for (const PointIndex i : points) {
      positions_W.insert(positions_W.end(), {cloud[i].x, cloud[i].y, cloud[i].z});
    }
    if (points.empty()) return;
    tree = std::make_unique<KdTree>(flann::Matrix<float>(positions_W.data(), points.size(), 3));
    tree->buildIndex();
  }
};

FlannIndex::FlannIndex(const PointCloud& cloud, float radius_m)
    : cloud_(cloud), radius_m_(radius_m) {}

FlannIndex::~FlannIndex() = default;

std::unique_ptr<FlannIndex::Tile>& FlannIndex::tile_at(PointIndex point) {
  const CloudPoint& p = cloud_[point];
  std::unique_ptr<Tile>& tile = tiles_[{
      cell_coordinate(p.x, kTile_m), cell_coordinate(p.y, kTile_m), cell_coordinate(p.z, kTile_m)}];
  if (!tile) tile = std::make_unique<Tile>();
  return tile;
}

void FlannIndex::build(std::span<Tile* const> tiles) const {
  oneapi::tbb::parallel_for(std::size_t{0}, tiles.size(),
                            [&](std::size_t k) { tiles[k]->build(cloud_); });
}

void FlannIndex::insert(std::span<const PointIndex> points) {
  std::vector<Tile*> dirty;
  for (const PointIndex i : points) {
    Tile& tile = *tile_at(i);
    if (tile.points.empty() || tile.tree) dirty.push_back(&tile);
    tile.tree.reset();
    tile.points.push_back(i);
  }
  build(dirty);
}

void FlannIndex::remove(std::span<const PointIndex> points) {
  std::unordered_map<Tile*, std::unordered_set<PointIndex>> leaving;
  for (const PointIndex i : points) leaving[tile_at(i).get()].insert(i);
  std::vector<Tile*> dirty;
  // The result does not depend on the order in which trees are built.
  for (const auto& [tile, gone] : leaving) {  // NOLINT(*-nondeterministic-pointer-iteration-order)
    std::erase_if(tile->points, [&gone = gone](PointIndex i) { return gone.contains(i); });
    tile->tree.reset();
    dirty.push_back(tile);
  }
  build(dirty);
}

void FlannIndex::assign(const PointRows& rows) {
  tiles_.clear();
  std::vector<PointIndex> points;
  points.reserve(rows.points().size());
  for (const PointRows::Point& point : rows.points()) points.push_back(point.index);
  insert(points);
}

void FlannIndex::find_neighbours(const CloudPoint& p, PointIndex left_out,
                                 std::vector<PointIndex>& neighbours) const {
  const float position_W[3] = {p.x, p.y, p.z};
  const double reach_m = static_cast<double>(radius_m_) * static_cast<double>(kSlack);
  Cell first;
  Cell last;
  std::int32_t* const firsts[3] = {&first.x, &first.y, &first.z};
  std::int32_t* const lasts[3] = {&last.x, &last.y, &last.z};
  for (int axis = 0; axis < 3; ++axis) {
    *firsts[axis] = cell_coordinate(position_W[axis] - reach_m, kTile_m);
    *lasts[axis] = cell_coordinate(position_W[axis] + reach_m, kTile_m);
  }

  neighbours.clear();
  std::vector<std::size_t> found;
  Candidates candidates(radius_m_ * radius_m_ * kSlack, found);
  for (Cell at = first; at.z <= last.z; ++at.z) {
    for (at.y = first.y; at.y <= last.y; ++at.y) {
      for (at.x = first.x; at.x <= last.x; ++at.x) {
        const auto tile = tiles_.find(at);
        if (tile == tiles_.end() || !tile->second->tree) continue;
        found.clear();
        tile->second->tree->findNeighbors(candidates, position_W, flann::SearchParams(-1));
        for (const std::size_t k : found) {
          const PointIndex candidate = tile->second->points[k];
          if (candidate != left_out && are_neighbours(p, cloud_[candidate], radius_m_)) {
            neighbours.push_back(candidate);
          }
        }
      }
    }
  }
}

void FlannIndex::visit(std::span<const PointIndex> points, const Visit& visit_point) const {
  std::vector<PointIndex> neighbours;
  for (const PointIndex point : points) {
    find_neighbours(cloud_[point], point, neighbours);
    visit_point(point, neighbours);
  }
}

void FlannIndex::visit_places(std::span<const CloudPoint> places_W,
                              const Visit& visit_place) const {
  constexpr PointIndex kNoPoint = UINT32_MAX;
  std::vector<PointIndex> neighbours;
  for (PointIndex k = 0; k < places_W.size(); ++k) {
    find_neighbours(places_W[k], kNoPoint, neighbours);
    visit_place(k, neighbours);
  }
}

void FlannIndex::visit_concurrently(std::span<const PointIndex> points,
                                    const Visit& visit_point) const {
  using Range = oneapi::tbb::blocked_range<std::size_t>;
  oneapi::tbb::parallel_for(Range(0, points.size(), kPointsPerTask), [&](const Range& range) {
    visit(points.subspan(range.begin(), range.size()), visit_point);
  });
}

void FlannIndex::visit_all(const Visit& visit_point) const {
  std::vector<PointIndex> points;
  for (const auto& [cell, tile] : tiles_) {
    points.insert(points.end(), tile->points.begin(), tile->points.end());
  }
  visit_concurrently(points, visit_point);
}

std::size_t FlannIndex::bytes() const {
  std::size_t sum = 0;
  for (const auto& [cell, tile] : tiles_) {
    sum += sizeof(Cell) + sizeof(Tile) + tile->points.capacity() * sizeof(PointIndex) +
           tile->positions_W.capacity() * sizeof(float);
    if (tile->tree) sum += static_cast<std::size_t>(tile->tree->usedMemory());
  }
  return sum;
}

}  // namespace kintsugi::segmenter
