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

/// Records a run of Algorithm 1: joins as tree edges with their owners, in order, with the host and
/// size of each guest beside them; rejected edges as watches.
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
    // A frozen component never changes again, so its root stays the root.
    state_.watches.insert(is_j_frozen ? root_j : forest_.find(edge.i),
                          is_j_frozen ? edge.j : edge.i, EdgeKey::of(edge.weight, edge.i, edge.j));
  }

  /// Enters the joins into the vertices. The guests of a host are a linked list at first, the last
  /// one in front: from `history` of the host along `left`.
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

/// Turns the list of guests that the recorder made into a balanced tree.
void build_history(PointIndex host, State& state, std::vector<PointIndex>& guests) {
  guests.clear();
  PointIndex guest = std::exchange(state.vertices[host].history, kNone);
  for (; guest != kNone; guest = state.vertices[guest].left) guests.push_back(guest);
  std::reverse(guests.begin(), guests.end());
  state.forest.build_history(host, guests);
}

}  // namespace

BatchStatistics build_state(const PointRows& rows, const EngineConfig& config, State& state) {
  SegmentForest forest(config.threshold, config.scale);
  forest.grow(static_cast<PointIndex>(state.vertices.size()));
  Recorder recorder(forest, state, rows.points().size());
  const BatchStatistics statistics = segment_points(rows, config, forest, recorder);
  recorder.enter_joins();

  using Range = oneapi::tbb::blocked_range<std::size_t>;
  oneapi::tbb::parallel_for(Range(0, state.vertices.size(), kPointsPerTask),
                            [&](const Range& range) {
                              std::vector<PointIndex> guests;
                              for (std::size_t k = range.begin(); k < range.end(); ++k) {
                                const auto x = static_cast<PointIndex>(k);
                                if (state.vertices[x].history != kNone)
                                  build_history(x, state, guests);
                              }
                            });
  return statistics;
}

}  // namespace kintsugi::segmenter::exact
