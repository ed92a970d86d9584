#include "mapper/core/loop_closure/keyframe_tree.hpp"

#include <limits>
#include <utility>

namespace kintsugi::mapper {

void KeyframeTree::add(std::optional<int> from, double distance_m) {
  const int number = size();
  nodes_.push_back({from.value_or(number), distance_m, from ? nodes_[*from].level + 1 : 0, {}});
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
  double way_m = 0.0;
  while (a != b) {
    int& deeper = nodes_[a].level < nodes_[b].level ? b : a;
    const Node& node = nodes_[deeper];
    if (node.level == 0) return std::numeric_limits<double>::infinity();  // two roots
    way_m += node.distance_m;
    deeper = node.from;
  }
  return way_m;
}

}  // namespace kintsugi::mapper
