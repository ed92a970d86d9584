#include "segmenter/core/exact/bulk_build.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include "segmenter/core/felzenszwalb.hpp"

namespace kintsugi::segmenter::exact {
namespace {

constexpr std::size_t kPointsPerTask = 8192;

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
    state_.vertices[guest].size = forest_.size_at(guest);
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

/// Makes a balanced tree of the children that the recorder has listed.
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

  using Range = oneapi::tbb::blocked_range<std::size_t>;
  oneapi::tbb::parallel_for(Range(0, points.size(), kPointsPerTask), [&](const Range& range) {
    std::vector<PointIndex> children;
    for (const PointIndex x : points.subspan(range.begin(), range.size())) {
      if (state.vertices[x].history != kNone) build_history(x, state, children);
    }
  });
  return statistics;
}

}  // namespace kintsugi::segmenter::exact
