#include "segmenter/description/segment_description.hpp"

#include <algorithm>
#include <cassert>
#include <span>
#include <utility>

#include <oneapi/tbb/parallel_for.h>

#include "segmenter/core/points/point_cloud.hpp"
#include "segmenter/map/map_snapshot.hpp"
#include "segmenter/map/segment_map.hpp"

namespace kintsugi::segmenter {
namespace {

/// The index of a segment in `segments`, which is sorted by id; where it would be if it is not
/// there.
std::size_t find_segment(std::span<const SegmentStatistics> segments, std::uint32_t segment_id) {
  const auto found = std::partition_point(
      segments.begin(), segments.end(),
      [&](const SegmentStatistics& segment) { return segment.segment_id < segment_id; });
  return static_cast<std::size_t>(found - segments.begin());
}

std::vector<CloudPoint> points_of(const LabelledCloud& cloud, std::uint32_t segment_id) {
  std::vector<CloudPoint> points_W;
  for (std::size_t i = 0; i < cloud.segment_ids.size(); ++i) {
    if (cloud.segment_ids[i] == segment_id) points_W.push_back(cloud.points_W[i]);
  }
  return points_W;
}

/// The points of every segment, in the order of the cloud.
class PointsBySegment {
 public:
  PointsBySegment(const LabelledCloud& cloud, std::span<const SegmentStatistics> segments) {
    first_.reserve(segments.size() + 1);
    std::size_t num_points = 0;
    for (const SegmentStatistics& segment : segments) {
      first_.push_back(num_points);
      num_points += segment.num_points;
    }
    first_.push_back(num_points);
    points_W_.resize(num_points);
    std::vector<std::size_t> next = first_;
    for (std::size_t i = 0; i < cloud.segment_ids.size(); ++i) {
      const std::uint32_t id = cloud.segment_ids[i];
      if (id == kNoSegment) continue;
      points_W_[next[find_segment(segments, id)]++] = cloud.points_W[i];
    }
  }

  std::span<const CloudPoint> operator[](std::size_t segment) const {
    return std::span(points_W_).subspan(first_[segment], first_[segment + 1] - first_[segment]);
  }

 private:
  std::vector<std::size_t> first_;
  std::vector<CloudPoint> points_W_;
};

/// In the order of `segments`.
std::vector<std::vector<SegmentNeighbour>> neighbours_by_segment(
    const AdjacencyGraph& graph, std::span<const SegmentStatistics> segments) {
  std::vector<std::vector<SegmentNeighbour>> neighbours(segments.size());
  const auto place_of = [&](std::uint32_t id) { return find_segment(segments, id); };
  // Edges are sorted by (a, b). So the neighbours with smaller ids are appended first.
  for (const AdjacencyEdge& edge : graph.edges) {
    neighbours[place_of(edge.b)].push_back({edge.a, edge.num_pairs});
  }
  for (const AdjacencyEdge& edge : graph.edges) {
    neighbours[place_of(edge.a)].push_back({edge.b, edge.num_pairs});
  }
  return neighbours;
}

}  // namespace

std::optional<SegmentDescription> describe_segment(const SegmentMap& map,
                                                   std::uint32_t segment_id) {
  if (map.segment_ids().num_points_of(segment_id) == 0) return std::nullopt;
  return describe_segment(labelled_cloud(map), map.statistics()(segment_id),
                          map.statistics().last_change(segment_id));
}

std::optional<SegmentDescription> describe_segment(const MapSnapshot& map,
                                                   std::uint32_t segment_id) {
  const std::size_t place = find_segment(map.segments, segment_id);
  if (place == map.segments.size() || map.segments[place].segment_id != segment_id) {
    return std::nullopt;
  }
  const auto& last_changes = map.state.last_changes;
  return describe_segment(labelled_cloud(map), map.segments[place],
                          last_changes.empty() ? LastChange{} : last_changes[place]);
}

SegmentDescription describe_segment(const LabelledCloud& cloud, const SegmentStatistics& statistics,
                                    const LastChange& last_change) {
  const auto points_W = points_of(cloud, statistics.segment_id);
  return {statistics, last_change, shape_of(points_W, cloud.resolution_m),
          neighbours_of(cloud, statistics)};
}

std::vector<SegmentDescription> describe_segments(const LabelledCloud& cloud,
                                                  std::span<const SegmentStatistics> segments,
                                                  std::span<const LastChange> last_changes,
                                                  const AdjacencyGraph& graph) {
  assert(last_changes.empty() || last_changes.size() == segments.size());
  const PointsBySegment points_of(cloud, segments);
  auto neighbours = neighbours_by_segment(graph, segments);
  std::vector<SegmentDescription> descriptions(segments.size());
  oneapi::tbb::parallel_for(std::size_t{0}, segments.size(), [&](std::size_t i) {
    descriptions[i] = {segments[i], last_changes.empty() ? LastChange{} : last_changes[i],
                       shape_of(points_of[i], cloud.resolution_m), std::move(neighbours[i])};
  });
  return descriptions;
}

std::vector<SegmentDescription> describe_segments(const MapSnapshot& map) {
  const LabelledCloud cloud = labelled_cloud(map);
  return describe_segments(cloud, map.segments, map.state.last_changes, adjacency_graph(cloud));
}

}  // namespace kintsugi::segmenter
