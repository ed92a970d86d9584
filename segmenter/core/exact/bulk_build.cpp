#include "segmenter/core/exact/bulk_build.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "segmenter/core/felzenszwalb.hpp"

namespace kintsugi::segmenter::exact {
namespace {

/// Writes down what happens. The children of a host are a list meanwhile, the last one first:
/// `history` of the host begins it, `left` goes on.
class Recorder final : public JoinObserver {
 public:
  Recorder(SegmentForest& forest, State& state) : forest_(forest), state_(state) {}

  void joined(const Edge& edge, PointIndex host, PointIndex guest) override {
    const EdgeKey key = EdgeKey::of(edge.weight, edge.i, edge.j);
    const TreeEdgeId id = state_.edges.add(key);
    state_.edges.set_owner(id, guest);
    state_.edges.link(id);
    state_.vertices.set_absorbed(guest, host, id, key.weight_bits);
    state_.vertices[guest].left = std::exchange(state_.vertices[host].history, guest);
  }

  void rejected(const Edge& edge) override {
    const PointIndex root_j = forest_.find(edge.j);
    const bool is_j_frozen = !(static_cast<double>(edge.weight) < forest_.theta_at(root_j));
    // A frozen component never changes again: its root will stay the root.
    state_.watches.insert(is_j_frozen ? root_j : forest_.find(edge.i),
                          is_j_frozen ? edge.j : edge.i, EdgeKey::of(edge.weight, edge.i, edge.j));
  }

 private:
  SegmentForest& forest_;
  State& state_;
};

void build_history(PointIndex host, State& state, std::vector<PointIndex>& children) {
  children.clear();
  PointIndex child = std::exchange(state.vertices[host].history, kNone);
  for (; child != kNone; child = state.vertices[child].left) children.push_back(child);
  std::reverse(children.begin(), children.end());
  state.forest.build_history(host, children);
}

}  // namespace

BatchStatistics build_state(const PointCloud& cloud, std::span<const PointIndex> points,
                            float radius_m, const JoinRule& rule, State& state) {
  SegmentForest forest(rule.threshold, rule.scale);
  forest.grow(static_cast<PointIndex>(state.vertices.size()));
  Recorder recorder(forest, state);
  const BatchStatistics statistics =
      segment_points(cloud, points, radius_m, rule.threshold + rule.scale, forest, recorder);

  // Edges have their ids in the order of the joins: whoever is absorbed has made its own before.
  std::vector<PointIndex> children;
  for (TreeEdgeId id = 0; id < statistics.num_joins; ++id) {
    const PointIndex guest = state.edges.owner(id);
    build_history(guest, state, children);
    state.vertices[guest].size = state.forest.history().total(guest);
  }
  for (const PointIndex x : points) {
    if (state.vertices.is_root(x)) build_history(x, state, children);
  }
  return statistics;
}

}  // namespace kintsugi::segmenter::exact
