#include "segmenter/query/answer.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "segmenter/description/segment_description.hpp"
#include "segmenter/map/map_snapshot.hpp"
#include "segmenter/query/place_search.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr double kDefaultRadius_vox = 2.0;
// For more segments it is faster to describe all segments of the map in parallel.
constexpr std::size_t kFewSegments = 8;

Eigen::Vector3d vector(const double (&v)[3]) { return {v[0], v[1], v[2]}; }

template <class Vector>
void copy_vector(const Vector& from, float (&to)[3]) {
  for (int axis = 0; axis < 3; ++axis) to[axis] = static_cast<float>(from[axis]);
}

/// The indices in MapSnapshot::segments of the ids that exist, ascending.
std::vector<std::size_t> places_of(const MapSnapshot& map, std::vector<std::uint32_t> ids) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  std::vector<std::size_t> places;
  places.reserve(ids.size());
  for (const std::uint32_t id : ids) {
    const auto found =
        std::ranges::lower_bound(map.segments, id, {}, &SegmentStatistics::segment_id);
    if (found != map.segments.end() && found->segment_id == id) {
      places.push_back(static_cast<std::size_t>(found - map.segments.begin()));
    }
  }
  return places;
}

std::optional<Hit> find_hit(const LabelledCloud& cloud, const SegmentQuery& query) {
  const double radius_m =
      query.radius_m > 0.0 ? query.radius_m : kDefaultRadius_vox * cloud.resolution_m;
  if (query.place == QueryPlace::kPoint) {
    return nearest_point(cloud, vector(query.point_W), radius_m);
  }
  return visible_point(cloud, {vector(query.point_W), vector(query.direction_W)}, radius_m);
}

/// The segments at the place of the query. If a point was hit, it is entered into `answer`.
std::vector<std::size_t> find_segments(const MapSnapshot& map, const SegmentQuery& query,
                                       SegmentAnswer& answer, double& distance_m) {
  const LabelledCloud cloud = labelled_cloud(map);
  switch (query.place) {
    case QueryPlace::kPoint:
    case QueryPlace::kRay: {
      const auto hit = find_hit(cloud, query);
      if (!hit) return {};
      const CloudPoint& point = cloud.points_W[hit->point];
      answer.has_hit = true;
      copy_vector(std::array{point.x, point.y, point.z}, answer.hit_W);
      distance_m = hit->distance_m;
      return places_of(map, {cloud.segment_ids[hit->point]});
    }
    case QueryPlace::kBox:
      return places_of(map,
                       segments_in_box(cloud, {vector(query.box_min_W), vector(query.box_max_W)}));
    case QueryPlace::kIds:
      return places_of(map, query.segment_ids);
    case QueryPlace::kPixel:
      answer.problem = "there is no view of the camera";
      return {};
    case QueryPlace::kAnywhere:
      break;
  }
  std::vector<std::size_t> all(map.segments.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// The descriptions of the segments with these indices.
std::vector<SegmentDescription> describe(const MapSnapshot& map,
                                         const std::vector<std::size_t>& places) {
  std::vector<SegmentDescription> descriptions;
  descriptions.reserve(places.size());
  if (places.size() <= kFewSegments) {
    for (const std::size_t place : places) {
      descriptions.push_back(describe_segment(map, map.segments[place].segment_id).value());
    }
    return descriptions;
  }
  std::vector<SegmentDescription> all = describe_segments(map);
  for (const std::size_t place : places) descriptions.push_back(std::move(all[place]));
  return descriptions;
}

bool is_larger(const SegmentStatistics& a, const SegmentStatistics& b) {
  return std::pair(b.num_points, a.segment_id) < std::pair(a.num_points, b.segment_id);
}

template <class Segments>
void limit(const SegmentQuery& query, Segments& segments) {
  if (query.max_segments > 0 && std::ssize(segments) > query.max_segments) {
    segments.resize(static_cast<std::size_t>(query.max_segments));
  }
}

DescribedSegment to_message(const SegmentDescription& description) {
  const auto& [box, plane, is_planar] = description.shape;
  DescribedSegment segment;
  segment.statistics = description.statistics;
  segment.last_change_utime = description.last_change.utime;
  copy_vector(box.X_WB.translation(), segment.oriented_box_center_W);
  for (int axis = 0; axis < 3; ++axis) {
    copy_vector(box.X_WB.linear().col(axis), segment.oriented_box_axes_W[axis]);
  }
  copy_vector(box.size_m, segment.oriented_box_size_m);
  copy_vector(plane.normal_W, segment.plane_normal_W);
  segment.plane_offset_m = static_cast<float>(plane.offset_m);
  segment.plane_rms_m = static_cast<float>(plane.rms_m);
  segment.plane_share = static_cast<float>(plane.inlier_share);
  segment.is_planar = is_planar ? 1 : 0;
  return segment;
}

void append(const SegmentDescription& description, double distance_m, SegmentAnswer& answer) {
  DescribedSegment& segment = answer.segments.emplace_back(to_message(description));
  segment.distance_m = static_cast<float>(distance_m);
  for (const SegmentNeighbour& neighbour : description.neighbours) {
    answer.contacts.push_back({segment.statistics.segment_id, neighbour.segment_id,
                               static_cast<std::uint32_t>(neighbour.num_pairs)});
  }
}

SegmentAnswer begin_answer(const MapSnapshot& map, const SegmentQuery& query) {
  SegmentAnswer answer;
  answer.session = map.state.session;
  answer.client = query.client;
  answer.number = query.number;
  answer.map_session = map.state.map_session;
  answer.map_name = map.state.map_name;
  answer.map_slices = static_cast<std::int32_t>(map.state.slices.size());
  answer.map_points = std::ssize(map.state.points_W);
  answer.map_segments = std::ssize(map.segments);
  return answer;
}

}  // namespace

SegmentAnswer answer(const MapSnapshot& map, const SegmentQuery& query) {
  SegmentAnswer answer = begin_answer(map, query);
  double distance_m = 0.0;
  std::vector<std::size_t> places = find_segments(map, query, answer, distance_m);
  if (query.changed_since > 0) {
    const auto& changes = map.state.last_changes;  // empty for files that do not have them
    std::erase_if(places, [&](std::size_t place) {
      return changes.empty() || changes[place].utime <= query.changed_since;
    });
  }
  std::ranges::sort(places, [&](std::size_t a, std::size_t b) {
    return is_larger(map.segments[a], map.segments[b]);
  });
  if (!query.only_planar) {
    answer.num_matching = std::ssize(places);
    limit(query, places);
  }
  std::vector<SegmentDescription> segments = describe(map, places);
  if (query.only_planar) {  // known only after the segments are described
    std::erase_if(segments, [](const auto& segment) { return !segment.shape.is_planar; });
    answer.num_matching = std::ssize(segments);
    limit(query, segments);
  }
  for (const SegmentDescription& segment : segments) append(segment, distance_m, answer);
  return answer;
}

}  // namespace kintsugi::segmenter
