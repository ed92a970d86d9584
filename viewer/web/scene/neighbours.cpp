#include "viewer/web/scene/neighbours.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

namespace kintsugi::viewer {
namespace {

using scene::Tile;

/// A cell of a grid as one number, relative to an origin near the segment.
class Grid {
 public:
  Grid(const Eigen::Vector3d& origin_W, double cell_m) : origin_W_(origin_W), cell_m_(cell_m) {}

  std::array<std::int64_t, 3> cell(const Eigen::Vector3d& p_W) const {
    const Eigen::Vector3d p = (p_W - origin_W_) / cell_m_;
    return {static_cast<std::int64_t>(std::floor(p.x())),
            static_cast<std::int64_t>(std::floor(p.y())),
            static_cast<std::int64_t>(std::floor(p.z()))};
  }
  static std::int64_t key(const std::array<std::int64_t, 3>& cell) {
    constexpr std::int64_t kMask = (1 << 21) - 1;
    return (cell[0] & kMask) << 42 | (cell[1] & kMask) << 21 | (cell[2] & kMask);
  }

 private:
  Eigen::Vector3d origin_W_;
  double cell_m_;
};

Eigen::AlignedBox3d box_W(const Tile& tile) {
  const Eigen::Vector3d min_P = tile.points->box_min_P.cast<double>();
  Eigen::AlignedBox3d box_P(min_P, min_P + tile.points->box_size_P.cast<double>());
  return box_P.transformed(tile.X_WP.pose());
}

template <class Function>
void for_each_point(const Tile& tile, Function&& function) {
  const Pose X_WP = tile.X_WP.pose();
  for (std::uint32_t i = 0; i < tile.points->count; ++i) {
    function(tile.labels->label(i),
             [&] { return Eigen::Vector3d(X_WP * tile.points->position_P(i).cast<double>()); });
  }
}

bool has(const Tile& tile, std::uint32_t segment_id) {
  return std::ranges::find(tile.labels->table, segment_id) != tile.labels->table.end();
}

}  // namespace

std::vector<Neighbour> neighbours_of(std::span<const Tile> tiles, std::uint32_t segment_id) {
  const auto first = std::ranges::find_if(tiles, [&](const Tile& t) { return has(t, segment_id); });
  if (first == tiles.end() || first->points->count == 0) return {};
  const double cell_m = 2.0 * first->resolution_m;
  const Grid grid(box_W(*first).center(), cell_m);

  Eigen::AlignedBox3d segment_box_W;
  std::unordered_set<std::int64_t> own;    // cells of the segment
  std::unordered_set<std::int64_t> cells;  // these, and those that share a face with one
  for (const Tile& tile : tiles) {
    if (tile.part != first->part || !has(tile, segment_id)) continue;
    for_each_point(tile, [&](std::uint32_t id, const auto& position_W) {
      if (id != segment_id) return;
      const Eigen::Vector3d p_W = position_W();
      segment_box_W.extend(p_W);
      const auto cell = grid.cell(p_W);
      if (!own.insert(Grid::key(cell)).second) return;
      cells.insert(Grid::key(cell));
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const int step : {-1, 1}) {
          auto beside = cell;
          beside[axis] += step;
          cells.insert(Grid::key(beside));
        }
      }
    });
  }
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(cell_m);
  const Eigen::AlignedBox3d reach_W(segment_box_W.min() - margin, segment_box_W.max() + margin);
  std::unordered_map<std::uint32_t, std::uint32_t> contacts;
  for (const Tile& tile : tiles) {
    if (tile.part != first->part || tile.points->count == 0) continue;
    if (!reach_W.intersects(box_W(tile))) continue;
    for_each_point(tile, [&](std::uint32_t id, const auto& position_W) {
      if (id == segment_id || id == kNoSegment) return;
      const Eigen::Vector3d p_W = position_W();
      if (reach_W.contains(p_W) && cells.contains(Grid::key(grid.cell(p_W)))) ++contacts[id];
    });
  }
  std::vector<Neighbour> neighbours;
  neighbours.reserve(contacts.size());
  for (const auto& [id, count] : contacts) neighbours.push_back({id, count});
  std::ranges::sort(neighbours, [](const Neighbour& a, const Neighbour& b) {
    return a.contacts != b.contacts ? a.contacts > b.contacts : a.segment_id < b.segment_id;
  });
  return neighbours;
}

}  // namespace kintsugi::viewer
