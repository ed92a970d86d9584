#include "segmenter/core/exact/exact_engine.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include <oneapi/tbb/parallel_invoke.h>

#include "segmenter/core/exact/bulk_build.hpp"

namespace kintsugi::segmenter {
namespace {

using exact::EdgeKey;

class Stopwatch {
 public:
  double lap_ms() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double, std::milli>(now - std::exchange(start_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

ExactEngine::ExactEngine(const PointCloud& cloud, const EngineConfig& config)
    : cloud_(cloud),
      config_(config),
      rule_{config.threshold, config.scale},
      index_(make_neighbour_index(config.neighbour_search, cloud, config.radius_m())),
      edges_of_(cloud, *index_, config),
      edges_ahead_(cloud, *index_, config),
      state_(rule_),
      replay_(state_, edges_of_),
      names_(state_.vertices, state_.forest) {}

ExactEngine::~ExactEngine() = default;

RunStatistics ExactEngine::update(const CloudChange& change) {
  RunStatistics statistics{.num_iterations = 1};
  Stopwatch stopwatch;
  std::optional<std::vector<EdgeKey>> edges = edges_ahead_.take(change.added);
  if (!change.removed.empty()) edges.reset();
  const bool is_rebuilt = is_cheaper_to_rebuild(change);
  add_vertices(change);
  if (is_rebuilt) {
    // At once: neither needs the other.
    oneapi::tbb::parallel_invoke([&] { update_index(change); },
                                 [&] { rebuild(change, statistics); });
  } else {
    forget_watches_of(change.removed);
    update_index(change);
    if (!edges) edges = find_new_edges(change.added);
    begin_to_look_ahead();
    statistics.neighbours_ms = stopwatch.lap_ms();
    if (!replay(change, std::move(*edges), statistics)) rebuild(change, statistics);
    edges_ahead_.finish();
  }
  next_slice_W_.clear();
  return statistics;
}

void ExactEngine::look_ahead(std::span<const CloudPoint> slice_W) {
  next_slice_W_.assign(slice_W.begin(), slice_W.end());
}

/// While index and cloud stay as they are.
void ExactEngine::begin_to_look_ahead() {
  if (!next_slice_W_.empty()) edges_ahead_.start(next_slice_W_);
}

bool ExactEngine::is_cheaper_to_rebuild(const CloudChange& change) const {
  const auto num_changed = static_cast<double>(change.added.size() + change.removed.size());
  return num_changed > config_.rebuild_share * static_cast<double>(num_points_);
}

/// The added ones are touched.
void ExactEngine::add_vertices(const CloudChange& change) {
  state_.vertices.resize(cloud_.size());
  for (const PointIndex x : change.added) {
    state_.vertices.reset(x);
    state_.vertices[x].is_touched = 1;
  }
  num_points_ += std::ssize(change.added) - std::ssize(change.removed);
}

/// Those that stand at the other ends of their edges; the index still has the points.
void ExactEngine::forget_watches_of(std::span<const PointIndex> removed) {
  edges_of_.for_each(removed, [&](PointIndex x, PointIndex neighbour, const EdgeKey&) {
    state_.watches.erase(neighbour, x);
  });
}

void ExactEngine::update_index(const CloudChange& change) {
  index_->remove(change.removed);
  index_->insert(change.added);
}

/// Each edge of the added points once; those are touched.
std::vector<EdgeKey> ExactEngine::find_new_edges(std::span<const PointIndex> added) const {
  std::vector<EdgeKey> edges;
  edges_of_.for_each(added, [&](PointIndex x, PointIndex other, const EdgeKey& key) {
    const bool comes_again = state_.vertices[other].is_touched && x < other;
    if (!comes_again) edges.push_back(key);
  });
  return edges;
}

bool ExactEngine::replay(const CloudChange& change, std::vector<EdgeKey> edges,
                         RunStatistics& statistics) {
  Stopwatch stopwatch;
  std::vector<PointIndex>& touched = replay_.touched();
  touched = change.added;
  statistics.num_edges = std::ssize(edges);
  const auto max_explored =
      std::max(config_.explore_at_least,
               static_cast<std::int64_t>(config_.explore_share * static_cast<double>(num_points_)));
  const bool is_done = replay_.run(change.removed, std::move(edges), max_explored);
  statistics.replay_ms = stopwatch.lap_ms();
  if (!is_done) return false;
  names_.update(touched, change.removed);
  statistics.naming_ms = stopwatch.lap_ms();
  statistics.num_joins = replay_.num_joins();
  statistics.num_points = std::ssize(change.added) + replay_.num_explored();
  statistics.num_explored = replay_.num_explored();
  return true;
}

void ExactEngine::rebuild(const CloudChange& change, RunStatistics& statistics) {
  Stopwatch stopwatch;
  for (const PointIndex x : change.removed) state_.vertices[x].is_gone = 1;
  replay_.reset();
  state_.clear();
  std::vector<PointIndex> points;
  points.reserve(static_cast<std::size_t>(num_points_));
  for (PointIndex x = 0; x < state_.vertices.size(); ++x) {
    if (!state_.vertices[x].is_gone) points.push_back(x);
  }
  const BatchStatistics batch = exact::build_state(cloud_, points, config_, state_);
  statistics.replay_ms += stopwatch.lap_ms();
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

std::size_t ExactEngine::bytes() const { return index_->bytes() + state_.bytes() + names_.bytes(); }

}  // namespace kintsugi::segmenter
