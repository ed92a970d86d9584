#include "segmenter/core/exact/exact_engine.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <oneapi/tbb/parallel_invoke.h>

#include "lcmtypes/base/stopwatch.hpp"
#include "segmenter/core/exact/bulk_build.hpp"
#include "segmenter/core/graph/make_neighbour_index.hpp"

namespace kintsugi::segmenter {
namespace {

using exact::EdgeKey;

}  // namespace

ExactEngine::ExactEngine(const PointCloud& cloud, const EngineConfig& config)
    : cloud_(cloud),
      config_(config),
      rule_{config.threshold, config.scale},
      index_(make_neighbour_index(config.neighbour_search, cloud, config.radius_m())),
      edges_of_(cloud, *index_, config),
      edges_ahead_(cloud, *index_, config),
      state_(rule_),
      propagation_(state_, edges_of_),
      names_(state_.vertices, state_.forest) {}

ExactEngine::~ExactEngine() = default;

RunStatistics ExactEngine::update(const CloudChange& change) {
  RunStatistics statistics{.num_iterations = 1};
  Stopwatch stopwatch;
  std::optional<std::vector<EdgeKey>> edges = edges_ahead_.take(change.added);
  // Some may lead to points that are gone, or elsewhere.
  if (!change.removed.empty() || !change.moved_in_place.empty()) edges.reset();
  const bool is_rebuilt = is_cheaper_to_rebuild(change);
  add_vertices(change);
  if (is_rebuilt) {
    rebuild(change, true, statistics);
  } else {
    erase_watches_of(change.removed);
    index_->remove(change.removed);
    index_->insert(change.added);
    if (!edges) edges = find_new_edges(change.added);
    start_look_ahead();
    statistics.neighbours_ms = stopwatch.lap_ms();
    if (!propagate(change, std::move(*edges), statistics)) rebuild(change, false, statistics);
    edges_ahead_.finish();
  }
  next_slice_W_.clear();
  return statistics;
}

void ExactEngine::look_ahead(std::span<const CloudPoint> slice_W) {
  next_slice_W_.assign(slice_W.begin(), slice_W.end());
}

/// The search runs while index and cloud do not change.
void ExactEngine::start_look_ahead() {
  if (!next_slice_W_.empty()) edges_ahead_.start(next_slice_W_);
}

bool ExactEngine::is_cheaper_to_rebuild(const CloudChange& change) const {
  if (!change.moved_in_place.empty()) return true;
  const auto num_changed = static_cast<double>(change.added.size() + change.removed.size());
  return num_changed > config_.rebuild_share * static_cast<double>(num_points_);
}

/// Marks the added ones as touched.
void ExactEngine::add_vertices(const CloudChange& change) {
  state_.vertices.resize(cloud_.size());
  for (const PointIndex x : change.added) {
    state_.vertices.reset(x);
    state_.vertices[x].is_touched = 1;
  }
  num_points_ += std::ssize(change.added) - std::ssize(change.removed);
}

/// The watches at the other ends of their edges. The index must still hold the points.
void ExactEngine::erase_watches_of(std::span<const PointIndex> removed) {
  edges_of_.for_each(removed, [&](PointIndex x, PointIndex neighbour, const EdgeKey&) {
    state_.watches.erase(neighbour, x);
  });
}

/// Each edge of the added points, which must be touched, once.
std::vector<EdgeKey> ExactEngine::find_new_edges(std::span<const PointIndex> added) const {
  std::vector<EdgeKey> edges;
  edges_of_.for_each(added, [&](PointIndex x, PointIndex other, const EdgeKey& key) {
    const bool comes_again = state_.vertices[other].is_touched && x < other;
    if (!comes_again) edges.push_back(key);
  });
  return edges;
}

bool ExactEngine::propagate(const CloudChange& change, std::vector<EdgeKey> edges,
                            RunStatistics& statistics) {
  Stopwatch stopwatch;
  std::vector<PointIndex>& touched = propagation_.touched();
  touched = change.added;
  statistics.num_edges = std::ssize(edges);
  const auto max_explored = static_cast<std::int64_t>(
      std::max(config_.explore_at_least, config_.explore_share * static_cast<double>(num_points_)));
  const bool is_done = propagation_.run(change.removed, std::move(edges), max_explored);
  statistics.joins_ms = stopwatch.lap_ms();
  if (!is_done) return false;
  names_.update(touched, change.removed);
  statistics.naming_ms = stopwatch.lap_ms();
  statistics.num_joins = propagation_.num_joins();
  statistics.num_points = std::ssize(change.added) + propagation_.num_explored();
  statistics.num_explored = propagation_.num_explored();
  return true;
}

/// `also_index`: the index, too, is not up to date.
void ExactEngine::rebuild(const CloudChange& change, bool also_index, RunStatistics& statistics) {
  Stopwatch stopwatch;
  for (const PointIndex x : change.removed) state_.vertices[x].is_gone = 1;
  propagation_.reset();
  std::vector<PointIndex> points;
  points.reserve(static_cast<std::size_t>(num_points_));
  for (PointIndex x = 0; x < state_.vertices.size(); ++x) {
    if (!state_.vertices[x].is_gone) points.push_back(x);
  }
  // At the same time, here and below: neither needs the other.
  oneapi::tbb::parallel_invoke(
      [&] { state_.clear(); },
      [&] { rows_ = std::make_unique<PointRows>(cloud_, points, config_.radius_m()); });
  BatchStatistics batch;
  oneapi::tbb::parallel_invoke(
      [&] {
        if (also_index) index_->assign(*rows_);
      },
      [&] { batch = exact::build_state(*rows_, config_, state_); });
  if (config_.fragment_limit() == 0) rows_.reset();  // nobody will take them
  statistics.joins_ms += stopwatch.lap_ms();
  names_.update_all(change.removed);
  statistics.naming_ms = stopwatch.lap_ms();
  statistics.num_edges = batch.num_edges;
  statistics.num_joins = batch.num_joins;
  statistics.num_points = num_points_;
  statistics.is_rebuilt = true;
}

double ExactEngine::theta(ComponentId component) const {
  return state_.forest.history().final_theta(names_.root(component));
}

void ExactEngine::swap_to(SwapSpace& space) {
  index_->swap_to(space);
  state_.swap_to(space);
  names_.swap_to(space);
}

std::size_t ExactEngine::bytes() const { return index_->bytes() + state_.bytes() + names_.bytes(); }

}  // namespace kintsugi::segmenter
