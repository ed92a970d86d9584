#include "mapper/core/loop_closure/keyframe_tree.hpp"

#include <utility>

namespace kintsugi::mapper {

void KeyframeTree::add(std::optional<int> from, double distance_m) {
  const int number = size();
  nodes_.push_back({from.value_or(number), distance_m, {}});
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

}  // namespace kintsugi::mapper
