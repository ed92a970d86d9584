#include "mapper/core/loop_closure/keyframe_tree.hpp"

#include <functional>
#include <limits>
#include <map>
#include <queue>

namespace kintsugi::mapper {

void KeyframeTree::add(std::optional<int> from, double distance_m) {
  const int number = size();
  nodes_.push_back({.from = from.value_or(number),
                    .distance_m = distance_m,
                    .level = from ? nodes_[*from].level + 1 : 0,
                    .root = from ? nodes_[*from].root : number,
                    .to = {}});
  if (from) nodes_[*from].to.push_back(number);
}

std::vector<bool> KeyframeTree::within(int keyframe, double reach_m) const {
  std::vector<bool> is_within(nodes_.size(), false);
  if (keyframe >= size()) return is_within;
  std::vector<std::pair<int, double>> open = {{keyframe, 0.0}};
  while (!open.empty()) {
    const auto [at, distance_m] = open.back();
    open.pop_back();
    if (distance_m > reach_m || is_within[at]) continue;
    is_within[at] = true;
    const Node& node = nodes_[at];
    open.emplace_back(node.from, distance_m + node.distance_m);
    for (const int next : node.to) open.emplace_back(next, distance_m + nodes_[next].distance_m);
  }
  return is_within;
}

double KeyframeTree::way_m(int a, int b) const {
  if (nodes_[a].root != nodes_[b].root) return std::numeric_limits<double>::infinity();
  double way_m = 0.0;
  while (a != b) {
    int& deeper = nodes_[a].level < nodes_[b].level ? b : a;
    const Node& node = nodes_[deeper];
    way_m += node.distance_m;
    deeper = node.from;
  }
  return way_m;
}

double KeyframeTree::way_m(int a, int b, std::span<const std::pair<int, int>> joins) const {
  return nodes_[a].root == nodes_[b].root ? way_m(a, b) : least_ways_m(a, joins, b)[b];
}

std::vector<double> KeyframeTree::ways_m(int from,
                                         std::span<const std::pair<int, int>> joins) const {
  std::vector<double> ways_m = least_ways_m(from, {});
  const std::vector<double> over_joins_m = least_ways_m(from, joins);
  for (int i = 0; i < size(); ++i) {
    if (nodes_[i].root != nodes_[from].root) ways_m[i] = over_joins_m[i];
  }
  return ways_m;
}

/// Over joins of different trees, by number; right for `until` and all that are nearer, or for all.
std::vector<double> KeyframeTree::least_ways_m(int from, std::span<const std::pair<int, int>> joins,
                                               std::optional<int> until) const {
  std::multimap<int, int> joined;
  for (const auto& [c, d] : joins) {
    if (nodes_[c].root == nodes_[d].root) continue;
    joined.emplace(c, d);
    joined.emplace(d, c);
  }
  // Dijkstra (1959).
  std::vector<double> least_m(nodes_.size(), std::numeric_limits<double>::infinity());
  using Open = std::pair<double, int>;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
  const auto reach = [&](int keyframe, double way_m) {
    if (!(way_m < least_m[keyframe])) return;
    least_m[keyframe] = way_m;
    open.emplace(way_m, keyframe);
  };
  reach(from, 0.0);
  while (!open.empty() && open.top().second != until) {
    const auto [way_m, at] = open.top();
    open.pop();
    const Node& node = nodes_[at];
    reach(node.from, way_m + node.distance_m);
    for (const int next : node.to) reach(next, way_m + nodes_[next].distance_m);
    const auto [first, last] = joined.equal_range(at);
    for (auto join = first; join != last; ++join) reach(join->second, way_m);
  }
  return least_m;
}

}  // namespace kintsugi::mapper
