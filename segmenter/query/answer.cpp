#include "segmenter/query/answer.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "segmenter/description/segment_description.hpp"
#include "segmenter/map/map_snapshot.hpp"
#include "segmenter/query/find_segments.hpp"
#include "segmenter/query/map_excerpt.hpp"

namespace kintsugi::segmenter {
namespace {

// For more segments it is faster to describe all segments of the map in parallel.
constexpr std::size_t kFewSegments = 8;

/// Segments and points that descriptions are made from.
struct Source {
  LabelledCloud cloud;
  std::span<const SegmentStatistics> segments;  // by ascending id
  std::span<const LastChange> last_changes;     // of each; empty: not known

  LastChange last_change(std::size_t place) const {
    return last_changes.empty() ? LastChange{} : last_changes[place];
  }
};

template <class Vector>
void copy_vector(const Vector& from, float (&to)[3]) {
  for (int axis = 0; axis < 3; ++axis) to[axis] = static_cast<float>(from[axis]);
}

std::vector<std::size_t> all_places(const Source& source) {
  std::vector<std::size_t> all(source.segments.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// The indices in Source::segments of the ids that exist, ascending.
std::vector<std::size_t> places_of(const Source& source, std::vector<std::uint32_t> ids) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  std::vector<std::size_t> places;
  places.reserve(ids.size());
  for (const std::uint32_t id : ids) {
    const auto found =
        std::ranges::lower_bound(source.segments, id, {}, &SegmentStatistics::segment_id);
    if (found != source.segments.end() && found->segment_id == id) {
      places.push_back(static_cast<std::size_t>(found - source.segments.begin()));
    }
  }
  return places;
}

/// The descriptions of the segments with these indices.
std::vector<SegmentDescription> describe(const Source& source,
                                         const std::vector<std::size_t>& places) {
  std::vector<SegmentDescription> descriptions;
  descriptions.reserve(places.size());
  if (places.size() <= kFewSegments) {
    for (const std::size_t place : places) {
      descriptions.push_back(
          describe_segment(source.cloud, source.segments[place], source.last_change(place)));
    }
    return descriptions;
  }
  std::vector<SegmentDescription> all = describe_segments(
      source.cloud, source.segments, source.last_changes, adjacency_graph(source.cloud));
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

void append(const SegmentDescription& description, float distance_m, SegmentAnswer& answer) {
  DescribedSegment& segment = answer.segments.emplace_back(to_message(description));
  segment.distance_m = distance_m;
  for (const SegmentNeighbour& neighbour : description.neighbours) {
    answer.contacts.push_back({segment.statistics.segment_id, neighbour.segment_id,
                               static_cast<std::uint32_t>(neighbour.num_pairs)});
  }
}

void enter(const FoundSegments& found, SegmentAnswer& answer) {
  answer.has_hit = found.has_hit;
  std::ranges::copy(found.hit_W, answer.hit_W);
  answer.view_utime = found.view_utime;
  answer.surface_distance_m = found.surface_distance_m;
}

/// Applies the filters of the query and describes what passes them.
/// @param distance_m of each segment
void enter_segments(const Source& source, const SegmentQuery& query,
                    std::vector<std::size_t> places, float distance_m, SegmentAnswer& answer) {
  if (query.changed_since > 0) {  // what is not known does not pass
    std::erase_if(places, [&](std::size_t place) {
      return source.last_changes.empty() || source.last_changes[place].utime <= query.changed_since;
    });
  }
  std::ranges::sort(places, [&](std::size_t a, std::size_t b) {
    return is_larger(source.segments[a], source.segments[b]);
  });
  if (!query.only_planar) {
    answer.num_matching = std::ssize(places);
    limit(query, places);
  }
  std::vector<SegmentDescription> segments = describe(source, places);
  if (query.only_planar) {  // known only after the segments are described
    std::erase_if(segments, [](const auto& segment) { return !segment.shape.is_planar; });
    answer.num_matching = std::ssize(segments);
    limit(query, segments);
  }
  for (const SegmentDescription& segment : segments) append(segment, distance_m, answer);
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

SegmentAnswer begin_answer(const MapExcerpt& map, const SegmentQuery& query) {
  SegmentAnswer answer;
  answer.session = map.session;
  answer.client = query.client;
  answer.number = query.number;
  answer.map_session = map.map_session;
  answer.map_name = map.map_name;
  answer.map_slices = map.map_slices;
  answer.map_points = map.map_points;
  answer.map_segments = map.map_segments;
  return answer;
}

}  // namespace

SegmentAnswer answer(const MapSnapshot& map, const SegmentQuery& query, const CameraView* view) {
  SegmentAnswer answer = begin_answer(map, query);
  const Source source{labelled_cloud(map), map.segments, map.state.last_changes};
  if (query.place == QueryPlace::kAnywhere) {
    enter_segments(source, query, all_places(source), 0.0F, answer);
    return answer;
  }
  const FoundSegments found = find_segments(source.cloud, query, view);
  enter(found, answer);
  enter_segments(source, query, places_of(source, found.ids), found.distance_m, answer);
  return answer;
}

SegmentAnswer answer(const MapExcerpt& excerpt, const SegmentQuery& query) {
  SegmentAnswer answer = begin_answer(excerpt, query);
  const Source source{excerpt.cloud(), excerpt.segments, excerpt.last_changes};
  enter(excerpt.found, answer);
  enter_segments(source, query, all_places(source), excerpt.found.distance_m, answer);
  return answer;
}

}  // namespace kintsugi::segmenter
