#include "segmenter/core/exact/bulk_build.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include "segmenter/core/batch/felzenszwalb.hpp"

namespace kintsugi::segmenter::exact {
namespace {

constexpr std::size_t kPointsPerTask = 8192;

/// Writes down what happens: joins as tree edges with their owners, in order, and beside them what
/// else there is to know of the guests.
class Recorder final : public JoinObserver {
 public:
  Recorder(SegmentForest& forest, State& state, std::size_t num_points)
      : forest_(forest), state_(state) {
    guests_.reserve(num_points);
  }

  void joined(const Edge& edge, PointIndex host, PointIndex guest) override {
    const TreeEdgeId id = state_.edges.add(EdgeKey::of(edge.weight, edge.i, edge.j));
    state_.edges.set_owner(id, guest);
    guests_.push_back({host, forest_.size_at(guest)});
  }

  void rejected(const Edge& edge) override {
    const PointIndex root_j = forest_.find(edge.j);
    const bool is_j_frozen = !(static_cast<double>(edge.weight) < forest_.theta_at(root_j));
    // A frozen component never changes again: its root will stay the root.
    state_.watches.insert(is_j_frozen ? root_j : forest_.find(edge.i),
                          is_j_frozen ? edge.j : edge.i, EdgeKey::of(edge.weight, edge.i, edge.j));
  }

  /// Enters the joins into the vertices. The children of a host are a list for now, the last one
  /// first: `history` of the host begins it, `left` goes on.
  void enter_joins() {
    Vertices& vertices = state_.vertices;
    for (TreeEdgeId id = 0; id < guests_.size(); ++id) {
      prefetch(id + kPrefetchDistance);
      const EdgeKey& key = state_.edges.key(id);
      const PointIndex guest = state_.edges.owner(id);
      const auto [host, size] = guests_[id];
      vertices.set_absorbed(guest, host, id, key.weight_bits);
      vertices[guest].size = size;
      vertices[guest].left = std::exchange(vertices[host].history, guest);
      state_.edges.link(id);
    }
  }

 private:
  static constexpr TreeEdgeId kPrefetchDistance = 16;

  struct Guest {
    PointIndex host;
    std::uint32_t size;
  };

  void prefetch(TreeEdgeId id) const {
    if (id >= guests_.size()) return;
    const EdgeKey& key = state_.edges.key(id);
    for (const PointIndex x : {key.a, key.b, state_.edges.owner(id), guests_[id].host}) {
      state_.vertices.prefetch_record(x);
    }
    state_.vertices.prefetch(state_.edges.owner(id));
  }

  SegmentForest& forest_;
  State& state_;
  std::vector<Guest> guests_;  ///< by tree edge
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
                            const EngineConfig& config, State& state) {
  SegmentForest forest(config.threshold, config.scale);
  forest.grow(static_cast<PointIndex>(state.vertices.size()));
  Recorder recorder(forest, state, points.size());
  const BatchStatistics statistics = segment_points(cloud, points, config, forest, recorder);
  recorder.enter_joins();

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
