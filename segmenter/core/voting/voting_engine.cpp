#include "segmenter/core/voting/voting_engine.hpp"

#include <algorithm>
#include <cmath>

#include <oneapi/tbb/enumerable_thread_specific.h>

#include "segmenter/core/batch/felzenszwalb.hpp"
#include "segmenter/core/graph/make_neighbour_index.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr PointIndex kNoPoint = UINT32_MAX;

}  // namespace

double vote_threshold(double beta, int c) { return 1.0 - std::pow(beta, c); }

VotingEngine::VotingEngine(const PointCloud& cloud, const EngineConfig& config)
    : cloud_(cloud),
      config_(config),
      index_(make_neighbour_index(config.neighbour_search, cloud, config.radius_m())),
      forest_(config.threshold, config.scale) {}

/// Algorithm 3.
RunStatistics VotingEngine::update(const CloudChange& change) {
  RunStatistics statistics;
  first_round_ = round_;
  std::vector<PointIndex> added = remove_points(change.removed);
  add_points(change.added);
  added.insert(added.end(), change.added.begin(), change.added.end());
  for (int c = 0; c == 0 || !added.empty(); ++c, ++round_) {
    add_to_D(added);
    extend_graph(added);
    statistics.num_joins = segment_graph();
    added = vote(c);
    statistics.num_iterations = c + 1;
  }
  statistics.num_points = static_cast<std::int64_t>(D_.size());
  statistics.num_edges = static_cast<std::int64_t>(inner_edges_.size() + border_edges_.size());
  commit();
  return statistics;
}

void VotingEngine::resume(const CloudChange& everything, std::span<const ComponentId> components,
                          std::span<const double> thetas) {
  add_points(everything.added);
  for (const PointIndex i : everything.added) {
    forest_.restore(i, components[i], thetas[components[i]]);
  }
  D_ = everything.added;
  commit();
}

/// Returns the remaining points of the segments that lost a point.
std::vector<PointIndex> VotingEngine::remove_points(std::span<const PointIndex> removed) {
  index_->remove(removed);
  std::vector<PointIndex> left;
  for (const PointIndex i : removed) {
    // At the first removed point of a segment, the whole segment is collected.
    if (round_added_[i] != round_) {
      const auto first = static_cast<std::ptrdiff_t>(left.size());
      append_segment(components_[i], left);
      for (auto j = left.begin() + first; j != left.end(); ++j) round_added_[*j] = round_;
    }
  }
  for (const PointIndex i : removed) {
    forest_.reset(i);
    components_[i] = kNoComponent;
  }
  std::erase_if(left, [&](PointIndex i) { return components_[i] == kNoComponent; });
  return left;
}

void VotingEngine::add_points(std::span<const PointIndex> added) {
  index_->insert(added);
  forest_.grow(cloud_.size());
  components_.resize(cloud_.size(), kNoComponent);
  next_.resize(cloud_.size());
  representative_at_.resize(cloud_.size());
  round_added_.resize(cloud_.size(), 0);
  round_discrepant_.resize(cloud_.size(), 0);
  ballots_.resize(cloud_.size());
}

void VotingEngine::add_to_D(std::span<const PointIndex> points) {
  D_.insert(D_.end(), points.begin(), points.end());
  for (const PointIndex i : points) round_added_[i] = round_;
}

/// Algorithm 2 for D and its border D^B. Edges between points that were already in D stay.
void VotingEngine::extend_graph(std::span<const PointIndex> added) {
  struct Found {
    std::vector<Edge> inner;
    std::vector<Edge> border;
  };
  const double max_weight = config_.max_weight();
  const EdgeWeight weight_of = config_.edge_weight();
  oneapi::tbb::enumerable_thread_specific<Found> found;
  index_->visit_concurrently(added, [&](PointIndex i, std::span<const PointIndex> neighbours) {
    Found& edges = found.local();
    for (const PointIndex j : neighbours) {
      if (!is_in_D(j)) {
        // In the vote every edge counts, even one that is too heavy to join anything.
        edges.border.push_back({weight_of.directed(cloud_[i], cloud_[j]), i, j});
      } else if (round_added_[j] < round_ || i < j) {
        const float weight = weight_of(cloud_[i], cloud_[j]);
        if (weight < max_weight) edges.inner.push_back({weight, std::min(i, j), std::max(i, j)});
      }
    }
  });
  std::erase_if(border_edges_, [&](const Edge& edge) { return is_in_D(edge.j); });
  for (const Found& edges : found) {
    inner_edges_.insert(inner_edges_.end(), edges.inner.begin(), edges.inner.end());
    border_edges_.insert(border_edges_.end(), edges.border.begin(), edges.border.end());
  }
}

/// Algorithm 4: segments D and marks the points D^Delta where the border disagrees.
///
/// The paper tests a border edge when its turn in the order of edges comes. Its segment in D is
/// then alive (weight below theta) if and only if it is so with the final theta: each later join
/// leaves theta above the weight of that join, and a frozen segment makes no later joins.
std::int64_t VotingEngine::segment_graph() {
  for (const PointIndex i : D_) forest_.reset(i);
  const std::int64_t num_joins = join_segments(inner_edges_, forest_);
  for (const Edge& edge : border_edges_) {
    const double w = edge.weight;
    if (w < forest_.theta_at(forest_.find(edge.i)) && w < forest_.theta_at(forest_.find(edge.j))) {
      round_discrepant_[edge.j] = round_;
    }
  }
  return num_joins;
}

/// Algorithm 5: the points of the segments S^Delta, which are to be segmented again.
std::vector<PointIndex> VotingEngine::vote(int c) {
  std::vector<PointIndex> candidates;
  for (const Edge& edge : border_edges_) {
    Ballot& ballot = ballots_[components_[edge.j]];
    if (ballot.num_edges++ == 0) candidates.push_back(components_[edge.j]);
    ballot.num_discrepant_edges += round_discrepant_[edge.j] == round_;
  }
  std::sort(candidates.begin(), candidates.end());

  std::vector<PointIndex> points;
  const double alpha = vote_threshold(config_.beta, c);
  for (const PointIndex segment : candidates) {
    const Ballot ballot = std::exchange(ballots_[segment], {});
    const double share = static_cast<double>(ballot.num_discrepant_edges) / ballot.num_edges;
    if (share > alpha) append_segment(segment, points);
  }
  return points;
}

void VotingEngine::append_segment(PointIndex representative,
                                  std::vector<PointIndex>& points) const {
  PointIndex i = representative;
  do {
    points.push_back(i);
    i = next_[i];
  } while (i != representative);
}

/// Algorithm 3, line 10: the segments of D become part of S.
void VotingEngine::commit() {
  for (const PointIndex i : D_) representative_at_[i] = kNoPoint;
  std::sort(D_.begin(), D_.end());
  changed_.clear();
  for (const PointIndex i : D_) {
    PointIndex& representative = representative_at_[forest_.find(i)];
    if (representative == kNoPoint) {
      representative = i;
      next_[i] = i;
    } else {
      next_[i] = std::exchange(next_[representative], i);
    }
    if (components_[i] != representative) changed_.push_back(i);
    components_[i] = representative;
  }
  D_.clear();
  inner_edges_.clear();
  border_edges_.clear();
}

double VotingEngine::theta(ComponentId component) const {
  return forest_.theta_at(forest_.root(component));
}

std::size_t VotingEngine::bytes() const {
  const std::size_t by_point = components_.capacity() + next_.capacity() +
                               representative_at_.capacity() + changed_.capacity() + D_.capacity() +
                               round_added_.capacity() + round_discrepant_.capacity();
  return index_->bytes() + forest_.bytes() + by_point * sizeof(PointIndex) +
         (inner_edges_.capacity() + border_edges_.capacity()) * sizeof(Edge) +
         ballots_.capacity() * sizeof(Ballot);
}

}  // namespace kintsugi::segmenter
