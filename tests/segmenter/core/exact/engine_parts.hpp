#pragma once

#include <cstdint>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "segmenter/core/exact/bulk_build.hpp"
#include "segmenter/core/exact/change_propagation.hpp"
#include "segmenter/core/exact/component_names.hpp"
#include "segmenter/core/exact/state.hpp"
#include "segmenter/core/graph/make_neighbour_index.hpp"
#include "segmenter/core/parameters/engine_config.hpp"
#include "tests/segmenter/core/exact/invariants.hpp"
#include "tests/segmenter/core/exact/names_check.hpp"

namespace kintsugi::segmenter::exact::testing {

/// State, ChangePropagation and ComponentNames over a pool of points, driven by hand. Each is in
/// the map or not; the vertex of a point has its number in the pool.
class EngineParts {
 public:
  static constexpr EngineConfig kConfig{.threshold = 0.001, .scale = 0.0005, .color_weight = 0.01};
  static constexpr JoinRule kRule{.threshold = kConfig.threshold, .scale = kConfig.scale};

  explicit EngineParts(const std::vector<CloudPoint>& pool_W)
      : index_(make_neighbour_index(NeighbourSearch::kGrid, cloud_, kConfig.radius_m())) {
    cloud_.add_slice(0, pool_W);
    EXPECT_EQ(cloud_.num_live(), pool_W.size());
    state_.vertices.resize(cloud_.size());
    for (PointIndex a = 0; a < cloud_.size(); ++a) {
      for (PointIndex b = a + 1; b < cloud_.size(); ++b) {
        if (!are_neighbours(cloud_[a], cloud_[b], kConfig.radius_m())) continue;
        const float weight = kConfig.edge_weight()(cloud_[a], cloud_[b]);
        if (weight >= kConfig.max_weight()) continue;
        possible_edges_.insert(EdgeKey::of(weight, a, b));
      }
    }
  }

  State& state() { return state_; }
  const ChangePropagation& propagation() const { return propagation_; }
  const ComponentNames& names() const { return names_; }
  bool is_in(PointIndex x) const { return state_.vertices[x].is_gone == 0; }

  /// All edges below T + k between points in the map.
  std::set<EdgeKey> edges() const {
    std::set<EdgeKey> edges;
    for (const EdgeKey& key : possible_edges_) {
      if (is_in(key.a) && is_in(key.b)) edges.insert(key);
    }
    return edges;
  }

  /// One run. False when more than `max_explored` points had to be explored; then rebuild().
  bool update(const std::vector<PointIndex>& added, const std::vector<PointIndex>& removed,
              std::int64_t max_explored = INT64_MAX) {
    edges_of_.for_each(removed, [&](PointIndex x, PointIndex neighbour, const EdgeKey&) {
      state_.watches.erase(neighbour, x);
    });
    index_->remove(removed);
    index_->insert(added);
    for (const PointIndex x : added) state_.vertices.reset(x);
    std::set<EdgeKey> new_edges;
    edges_of_.for_each(added,
                       [&](PointIndex, PointIndex, const EdgeKey& key) { new_edges.insert(key); });
    propagation_.touched() = added;
    for (const PointIndex x : added) state_.vertices[x].is_touched = 1;
    if (!propagation_.run(removed, {new_edges.begin(), new_edges.end()}, max_explored))
      return false;
    names_.update(propagation_.touched(), removed);
    names_check_.expect(added);
    return true;
  }

  /// Rebuilds the state, after a run that gave up or at any time. `added` and `removed` as in
  /// update().
  void rebuild(const std::vector<PointIndex>& added = {},
               const std::vector<PointIndex>& removed = {}) {
    propagation_.reset();
    state_.clear();
    std::vector<PointIndex> points;
    for (PointIndex x = 0; x < cloud_.size(); ++x) {
      if (is_in(x)) points.push_back(x);
    }
    build_state(PointRows(cloud_, points, kConfig.radius_m()), kConfig, state_);
    names_.update_all(removed);
    names_check_.expect(added);
  }

  void expect_invariants() const { testing::expect_invariants(state_, kRule, edges()); }

 private:
  PointCloud cloud_;
  std::unique_ptr<NeighbourIndex> index_;
  std::set<EdgeKey> possible_edges_;
  State state_{kRule};
  EdgeFinder edges_of_{cloud_, *index_, kConfig};
  ChangePropagation propagation_{state_, edges_of_};
  ComponentNames names_{state_.vertices, state_.forest};
  NamesCheck names_check_{state_.vertices, state_.forest, names_};
};

}  // namespace kintsugi::segmenter::exact::testing
