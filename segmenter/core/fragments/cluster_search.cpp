#include "segmenter/core/fragments/cluster_search.hpp"

#include <algorithm>
#include <optional>

namespace kintsugi::segmenter {

ClusterSearch::Found ClusterSearch::operator()(PointIndex from) {
  begin();
  add_component_of(from);
  std::optional<Edge> last;    // the latest, in the order of edges, of those taken so far
  std::size_t num_before = 0;  // points reached before it
  while (!edges_.empty()) {
    const Edge edge = take_first_edge();
    if (is_seen(edge.j)) continue;
    if (!last || order_(*last, edge)) {
      last = edge;
      num_before = points_.size();
    }
    const auto num_points = static_cast<std::int64_t>(points_.size());
    if (num_points + components_.num_points(components_[edge.j]) >= components_.limit()) {
      return {std::span(points_).first(num_before), Exit::along(*last)};
    }
    add_component_of(edge.j);
  }
  return {points_, Exit::none(last ? order_.first_point(*last) : from)};
}

void ClusterSearch::begin() {
  // The number has wrapped around: marks of old searches would count for new ones.
  if (++search_ == 0) {
    for (std::uint32_t& seen : seen_) seen = 0;
    search_ = 1;
  }
  points_.clear();
  edges_.clear();
  first_to_large_ = Exit::none(Exit::kNowhere);
}

/// Reaches all points of a component, which is connected, from one of them.
void ClusterSearch::add_component_of(PointIndex point) {
  NeighbourCursor cursor(index_);
  const ComponentId name = components_[point];
  std::size_t next = points_.size();
  see(point);
  for (; next < points_.size(); ++next) {
    const PointIndex i = points_[next];
    cursor.for_each_neighbour(i, [&](PointIndex j) {
      if (is_seen(j)) return;
      if (components_[j] == name) {
        see(j);
      } else {
        look_at({weight_of_(cloud_[i], cloud_[j]), i, j});
      }
    });
  }
}

void ClusterSearch::look_at(const Edge& edge) {
  if (!order_(edge, first_to_large_)) return;
  if (!components_.is_in_fragment(edge.j)) first_to_large_ = edge;
  edges_.push_back(edge);
  std::push_heap(edges_.begin(), edges_.end(),
                 [this](const Edge& a, const Edge& b) { return order_(b, a); });
}

Edge ClusterSearch::take_first_edge() {
  std::pop_heap(edges_.begin(), edges_.end(),
                [this](const Edge& a, const Edge& b) { return order_(b, a); });
  const Edge edge = edges_.back();
  edges_.pop_back();
  return edge;
}

}  // namespace kintsugi::segmenter
