#include "segmenter/core/batch/batch_segmentation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

namespace kintsugi::segmenter {
namespace {

// Measured on maps of 4 M points: with less than a third in the first pass many edges are computed
// twice; with more, many are kept that lie inside a segment when their turn comes.
constexpr std::size_t kFirstShare = 3;
// For fewer points one pass takes hardly any time.
constexpr std::size_t kMinPointsForTwoPasses = 100'000;
constexpr std::size_t kRowsPerSample = 64;

/// Weights that are >= from and < to.
struct WeightRange {
  double from;
  double to;
};

using EdgesByThread = oneapi::tbb::enumerable_thread_specific<EdgeBuckets>;

/// The edges with a weight in `range` between points for which keep() holds.
template <typename Keep>
EdgesByThread find_edges(const PointRows& rows, EdgeWeight weight_of, const WeightRange& range,
                         const Keep& keep) {
  EdgesByThread found;
  oneapi::tbb::parallel_for(std::size_t{0}, rows.num_rows(), [&](std::size_t row) {
    EdgeBuckets& edges = found.local();
    rows.for_each_pair(row, keep, [&](PointRows::Slot a, PointRows::Slot b) {
      const PointRows::Point& p = rows.points()[a];
      const PointRows::Point& q = rows.points()[b];
      const float weight = weight_of(p, q);
      if (weight >= range.from && weight < range.to) {
        edges.add({weight, std::min(p.index, q.index), std::max(p.index, q.index)});
      }
    });
  });
  return found;
}

/// Joins along the edges, in ascending order.
BatchStatistics join(EdgesByThread& found, SegmentForest& forest, JoinObserver& observer) {
  BatchStatistics statistics;
  std::vector<Edge> between;
  for (std::size_t b = 0; b < EdgeBuckets::kNumBuckets; ++b) {
    between.clear();
    for (EdgeBuckets& edges : found) {
      edges.take(b, [&](std::span<const Edge> some) {
        statistics.num_edges += static_cast<std::int64_t>(some.size());
        append_edges_between_segments(some, forest, between);
      });
    }
    statistics.num_joins += join_in_order(std::span(between), forest, observer);
  }
  return statistics;
}

/// A weight that about one in kFirstShare edges is below, estimated from a sample of the rows.
double weight_of_first_share(const PointRows& rows, EdgeWeight weight_of, double max_weight) {
  std::vector<float> weights;
  for (std::size_t row = 0; row < rows.num_rows(); row += kRowsPerSample) {
    rows.for_each_pair(
        row, [](PointRows::Slot, PointRows::Slot) { return true; },
        [&](PointRows::Slot a, PointRows::Slot b) {
          const float weight = weight_of(rows.points()[a], rows.points()[b]);
          if (weight < max_weight) weights.push_back(weight);
        });
  }
  if (weights.empty()) return max_weight;
  const auto at = weights.begin() + static_cast<std::ptrdiff_t>(weights.size() / kFirstShare);
  std::nth_element(weights.begin(), at, weights.end());
  return std::nextafter(
      *at, std::numeric_limits<float>::max());  // so that edges of this very weight are below
}

}  // namespace

BatchStatistics segment_points(const PointCloud& cloud, std::span<const PointIndex> points,
                               const EngineConfig& config, SegmentForest& forest,
                               JoinObserver& observer) {
  return segment_points(PointRows(cloud, points, config.radius_m()), config, forest, observer);
}

BatchStatistics segment_points(const PointRows& rows, const EngineConfig& config,
                               SegmentForest& forest, JoinObserver& observer) {
  const EdgeWeight weight_of = config.edge_weight();
  const double max_weight = config.max_weight();
  const double limit = rows.points().size() < kMinPointsForTwoPasses
                           ? max_weight
                           : weight_of_first_share(rows, weight_of, max_weight);
  EdgesByThread light = find_edges(rows, weight_of, WeightRange{0.0, limit},
                                   [](PointRows::Slot, PointRows::Slot) { return true; });
  const BatchStatistics first = join(light, forest, observer);
  if (limit >= max_weight) return first;

  std::vector<PointIndex> segments(rows.points().size());
  for (std::size_t k = 0; k < segments.size(); ++k) {
    segments[k] = forest.find(rows.points()[k].index);
  }
  EdgesByThread heavy =
      find_edges(rows, weight_of, WeightRange{limit, max_weight},
                 [&](PointRows::Slot a, PointRows::Slot b) { return segments[a] != segments[b]; });
  const BatchStatistics second = join(heavy, forest, observer);
  return {first.num_edges + second.num_edges, first.num_joins + second.num_joins};
}

}  // namespace kintsugi::segmenter
