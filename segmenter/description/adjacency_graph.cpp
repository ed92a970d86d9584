#include "segmenter/description/adjacency_graph.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <unordered_map>
#include <utility>

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include "segmenter/core/points/point_rows.hpp"

namespace kintsugi::segmenter {
namespace {

/// Two segment ids, the smaller one in the high half: ordered as AdjacencyEdges.
using SegmentPair = std::uint64_t;

SegmentPair pair_of(std::uint32_t a, std::uint32_t b) {
  return (std::uint64_t{std::min(a, b)} << 32U) | std::max(a, b);
}
std::uint32_t first_of(SegmentPair pair) { return static_cast<std::uint32_t>(pair >> 32U); }
std::uint32_t second_of(SegmentPair pair) { return static_cast<std::uint32_t>(pair); }

using PairCounts = std::unordered_map<SegmentPair, std::int64_t>;

/// Counts pairs of neighbours in two different segments for which keep(id, id) holds.
template <class Keep>
std::map<SegmentPair, std::int64_t> count_pairs(const LabelledCloud& cloud,
                                                std::span<const PointIndex> points,
                                                const Keep& keep) {
  const PointRows rows(cloud.points_W, points, cloud.radius_m);
  std::vector<std::uint32_t> ids;  // by slot
  ids.reserve(points.size());
  for (const PointRows::Point& point : rows.points()) {
    ids.push_back(cloud.segment_ids[point.index]);
  }
  oneapi::tbb::enumerable_thread_specific<PairCounts> found;
  oneapi::tbb::parallel_for(std::size_t{0}, rows.num_rows(), [&](std::size_t row) {
    PairCounts& counts = found.local();
    rows.for_each_pair(
        row,
        [&](PointRows::Slot a, PointRows::Slot b) {
          return ids[a] != ids[b] && keep(ids[a], ids[b]);
        },
        [&](PointRows::Slot a, PointRows::Slot b) { ++counts[pair_of(ids[a], ids[b])]; });
  });
  std::map<SegmentPair, std::int64_t> sum;
  for (const PairCounts& counts : found) {
    for (const auto& [pair, count] : counts) sum[pair] += count;
  }
  return sum;
}

/// Whether `point` may be a neighbour of one in the segment's box.
bool is_near(const CloudPoint& point, const SegmentStatistics& segment, double radius_m) {
  const std::array<float, 3> p_W{point.x, point.y, point.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // Distances are rounded, so points slightly more than r apart may be neighbours.
    const double reach_m = 1.001 * radius_m;
    if (p_W[axis] < segment.box_min_W[axis] - reach_m ||
        p_W[axis] > segment.box_max_W[axis] + reach_m) {
      return false;
    }
  }
  return true;
}

}  // namespace

AdjacencyGraph adjacency_graph(const LabelledCloud& cloud) {
  std::vector<PointIndex> points;
  points.reserve(cloud.segment_ids.size());
  AdjacencyGraph graph;
  for (PointIndex i = 0; i < cloud.segment_ids.size(); ++i) {
    if (cloud.segment_ids[i] == kNoSegment) continue;
    points.push_back(i);
    graph.segment_ids.push_back(cloud.segment_ids[i]);
  }
  std::sort(graph.segment_ids.begin(), graph.segment_ids.end());
  const auto end = std::unique(graph.segment_ids.begin(), graph.segment_ids.end());
  graph.segment_ids.erase(end, graph.segment_ids.end());
  const auto counts =
      count_pairs(cloud, points, [](std::uint32_t /*a*/, std::uint32_t /*b*/) { return true; });
  graph.edges.reserve(counts.size());
  for (const auto& [pair, count] : counts) {
    graph.edges.push_back({first_of(pair), second_of(pair), count});
  }
  return graph;
}

std::vector<SegmentNeighbour> neighbours_of(const LabelledCloud& cloud,
                                            const SegmentStatistics& segment) {
  const std::uint32_t id = segment.segment_id;
  std::vector<PointIndex> points;
  for (PointIndex i = 0; i < cloud.segment_ids.size(); ++i) {
    if (cloud.segment_ids[i] != kNoSegment && is_near(cloud.points_W[i], segment, cloud.radius_m)) {
      points.push_back(i);
    }
  }
  const auto counts = count_pairs(
      cloud, points, [id](std::uint32_t a, std::uint32_t b) { return a == id || b == id; });
  std::vector<SegmentNeighbour> neighbours;
  neighbours.reserve(counts.size());
  for (const auto& [pair, count] : counts) {
    const std::uint32_t other = first_of(pair) == id ? second_of(pair) : first_of(pair);
    neighbours.push_back({other, count});
  }
  return neighbours;
}

}  // namespace kintsugi::segmenter
