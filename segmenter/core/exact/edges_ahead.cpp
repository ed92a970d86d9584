#include "segmenter/core/exact/edges_ahead.hpp"

#include <algorithm>
#include <utility>

#include "segmenter/core/graph/make_neighbour_index.hpp"

namespace kintsugi::segmenter::exact {

void EdgesAhead::start(std::span<const CloudPoint> slice_W) {
  finish();
  search_ = std::async(std::launch::async,
                       [this, points_W = std::vector(slice_W.begin(), slice_W.end())]() mutable {
                         return find(std::move(points_W));
                       });
}

void EdgesAhead::finish() {
  if (search_.valid()) found_ = search_.get();
}

EdgesAhead::Found EdgesAhead::find(std::vector<CloudPoint> slice_W) const {
  const EdgeWeight weight_of = config_.edge_weight();
  const double max_weight = config_.max_weight();
  Found found;
  found.slice.add_slice(0, slice_W);
  const std::vector<PointIndex> all = found.slice.take_change().added;
  const auto own_index =
      make_neighbour_index(NeighbourSearch::kGrid, found.slice, config_.radius_m());
  own_index->insert(all);
  own_index->visit(all, [&](PointIndex i, std::span<const PointIndex> neighbours) {
    for (const PointIndex j : neighbours) {
      if (j < i) continue;
      const float weight = weight_of(found.slice[i], found.slice[j]);
      if (weight < max_weight) found.inner.push_back({weight, i, j});
    }
  });
  index_.visit_places(found.slice.points_W(), [&](PointIndex i, std::span<const PointIndex> near) {
    for (const PointIndex j : near) {
      const float weight = weight_of(found.slice[i], cloud_[j]);
      if (weight < max_weight) found.outer.push_back({weight, i, j});
    }
  });
  return found;
}

std::optional<std::vector<EdgeKey>> EdgesAhead::take(std::span<const PointIndex> added) {
  finish();
  const std::optional<Found> found = std::exchange(found_, std::nullopt);
  const auto is_same = [this](const CloudPoint& point, PointIndex x) { return point == cloud_[x]; };
  if (!found || !std::ranges::equal(found->slice.points_W(), added, is_same)) return std::nullopt;
  std::vector<EdgeKey> edges;
  edges.reserve(found->inner.size() + found->outer.size());
  for (const AheadEdge& e : found->inner) {
    edges.push_back(EdgeKey::of(e.weight, added[e.i], added[e.other]));
  }
  for (const AheadEdge& e : found->outer) {
    edges.push_back(EdgeKey::of(e.weight, added[e.i], e.other));
  }
  return edges;
}

}  // namespace kintsugi::segmenter::exact
