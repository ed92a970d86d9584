#pragma once
// What the segmenter publishes of segments, and what clients ask it.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace kintsugi {

/// Version of the packed records below. Raise it with every change of their layout: the order, type
/// or meaning of a field. A receiver refuses records of another version.
inline constexpr std::int16_t kSegmentRecordsVersion = 2;

/// Segment id of a point that belongs to no segment, because it was rejected when its slice was
/// added. Ids of segments start at 1.
inline constexpr std::uint32_t kNoSegment = 0;

/// A run of consecutive points of one slice that now have the label `segment_id`.
struct LabelRun {
  std::int32_t slice_id = 0;
  std::int32_t first = 0;  ///< index of the first point in its slice
  std::int32_t count = 0;  ///< > 0
  std::uint32_t segment_id = 0;
  std::int32_t slice_revision = 0;  ///< a point is identified by slice, revision and index

  bool operator==(const LabelRun&) const = default;
};
static_assert(sizeof(LabelRun) == 20, "another layout: raise kSegmentRecordsVersion");

enum class SegmentEventType : std::uint32_t {
  kCreated = 0,
  kGrown = 1,    ///< other_id is 0
  kMerged = 2,   ///< segment_id absorbed other_id, one event for each id absorbed
  kSplit = 3,    ///< other_id was split off segment_id, one event for each new id
  kRetired = 4,  ///< segment_id has lost all its points and no longer exists
};

struct SegmentEvent {
  SegmentEventType type = SegmentEventType::kCreated;
  std::uint32_t segment_id = 0;
  std::uint32_t other_id = 0;

  bool operator==(const SegmentEvent&) const = default;
};
static_assert(sizeof(SegmentEvent) == 12, "another layout: raise kSegmentRecordsVersion");

/// A field of SegmentStatistics: its key in JSON, CSV and Python, and its unit.
struct StatisticsField {
  const char* name;
  const char* unit;
};

/// What is known of one segment.
///
/// visit_fields() is the only list of the fields: the checks of the codec, JSON, the CSV file and
/// the Python description of the record use it.
struct SegmentStatistics {
  std::uint32_t segment_id = 0;
  std::uint32_t num_points = 0;
  float box_min_W[3] = {};  ///< axis-aligned bounding box
  float box_max_W[3] = {};
  float centroid_W[3] = {};
  float mean_normal_W[3] = {};  ///< unit, or zero when the normals cancel out
  std::uint8_t mean_color[3] = {};
  std::uint8_t reserved = 0;           ///< zero; in no list
  float area_m2 = 0.0F;                ///< num_points * resolution^2
  std::int32_t first_slice = 0;        ///< the lowest slice_id of its points
  std::int32_t last_slice = 0;         ///< the highest
  std::uint32_t points_in_volume = 0;  ///< of patches that may still change

  bool operator==(const SegmentStatistics&) const = default;

  /// Calls visit(StatisticsField, the field of each of `s`...) for every field, in the order of the
  /// record.
  template <class Visit, class... Statistics>
  static constexpr void visit_fields(const Visit& visit, Statistics&... s) {
    visit(StatisticsField{"id", ""}, s.segment_id...);
    visit(StatisticsField{"points", ""}, s.num_points...);
    visit(StatisticsField{"box_min", "m, W"}, s.box_min_W...);
    visit(StatisticsField{"box_max", "m, W"}, s.box_max_W...);
    visit(StatisticsField{"centroid", "m, W"}, s.centroid_W...);
    visit(StatisticsField{"mean_normal", "unit vector, W"}, s.mean_normal_W...);
    visit(StatisticsField{"mean_color", "red, green, blue, 0 to 255"}, s.mean_color...);
    visit(StatisticsField{"area", "m^2"}, s.area_m2...);
    visit(StatisticsField{"first_slice", ""}, s.first_slice...);
    visit(StatisticsField{"last_slice", ""}, s.last_slice...);
    visit(StatisticsField{"points_in_volume", ""}, s.points_in_volume...);
  }
};
static_assert(sizeof(SegmentStatistics) == 76, "another layout: raise kSegmentRecordsVersion");

/// Bytes of the listed fields of SegmentStatistics.
consteval std::size_t listed_statistics_bytes() {
  const SegmentStatistics statistics;
  std::size_t bytes = 0;
  SegmentStatistics::visit_fields(
      [&bytes](const StatisticsField&, const auto& field) { bytes += sizeof(field); }, statistics);
  return bytes;
}
static_assert(listed_statistics_bytes() + sizeof(SegmentStatistics::reserved) ==
                  sizeof(SegmentStatistics),
              "a field is missing in visit_fields()");

/// What changed in the segment map when one slice was added, or replaced by a higher revision.
struct SegmentUpdate {
  std::int64_t utime = 0;        ///< device time of the slice, microseconds
  std::int64_t session = 0;      ///< of the segmenter; > 0
  std::int64_t sequence = 0;     ///< ascending in the session; set by the receiver, not the sender
  std::int64_t map_session = 0;  ///< of the mapper whose slice this is
  std::string map_name;
  std::int32_t slice_id = 0;
  std::int32_t slice_revision = 0;
  /// The final slice and all earlier ones are in the map.
  bool is_final = false;
  std::int32_t num_slices = 0;        ///< in the map after this update
  std::int64_t num_points = 0;        ///< in the map after this update
  std::int64_t num_segments = 0;      ///< in the map after this update
  std::vector<std::uint32_t> labels;  ///< segment id of each point of the slice, in its order
  std::vector<LabelRun> runs;         ///< points of earlier slices whose label changed
  std::vector<SegmentEvent> events;
  std::vector<SegmentStatistics> statistics;  ///< of every segment that changed
};

/// Where a query looks for segments.
enum class QueryPlace : std::int8_t {
  kAnywhere = 0,
  kPoint = 1,  ///< the segment of the map point nearest to point_W
  kRay = 2,    ///< the segment that a camera at point_W sees along direction_W
  kBox = 3,    ///< the segments with a point in the box or on its faces
  kIds = 4,    ///< the segments with these ids; ids that do not exist are ignored
  /// The segment of what the camera measures at pixel_px in the newest CameraView of the map: never
  /// a surface behind it.
  kPixel = 5,
  /// No segments, but what the camera of the map saw.
  kViews = 6,
};

/// Asks a segmenter for the segments at a place that pass every filter, ordered by their number of
/// points, largest first; of equal ones the smaller id first. Fields that the place does not use
/// are ignored.
struct SegmentQuery {
  std::int64_t utime = 0;        ///< wall clock, microseconds
  std::int64_t client = 0;       ///< random number of the client; > 0
  std::int64_t number = 0;       ///< counts the client's queries, >= 0; the same when asked again
  std::int64_t map_session = 0;  ///< of the mapper whose map is asked; 0: the newest of map_name
  std::string map_name;          ///< of the mapper whose map is asked; empty: any
  QueryPlace place = QueryPlace::kAnywhere;
  double point_W[3] = {};      ///< kPoint: the point; kRay: where the ray starts; metres
  double direction_W[3] = {};  ///< kRay: unit
  double box_min_W[3] = {};    ///< kBox: metres
  double box_max_W[3] = {};    ///< kBox: metres, at least box_min_W
  double pixel_px[2] = {};     ///< kPixel: u, v in the camera's depth image
  /// kPoint, kRay, kPixel: largest distance of the map point; 0: two voxels
  double radius_m = 0.0;
  std::vector<std::uint32_t> segment_ids;  ///< kIds
  bool only_planar = false;                ///< only segments that are planar
  /// Only segments that changed after this device time, views that were taken then or later; 0: all
  std::int64_t changed_since = 0;
  std::int32_t max_segments = 0;  ///< only so many, the largest; 0: all

  bool operator==(const SegmentQuery&) const = default;
};

/// A segment in the answer to a query.
struct DescribedSegment {
  SegmentStatistics statistics;
  std::uint32_t is_planar = 0;           ///< 0 or 1; here, so that there is no padding
  std::int64_t last_change_utime = 0;    ///< device time of the slice that changed it last
  float oriented_box_center_W[3] = {};   ///< metres
  float oriented_box_axes_W[3][3] = {};  ///< three unit vectors
  float oriented_box_size_m[3] = {};     ///< along each axis, >= 0
  float plane_normal_W[3] = {};          ///< unit, or zero: no plane fits
  float plane_offset_m = 0.0F;           ///< points p on the plane have plane_normal_W * p = this
  float plane_rms_m = 0.0F;              ///< of the distances of its points from the plane
  float plane_share = 0.0F;              ///< of its points within one voxel of the plane, 0 to 1
  float distance_m = 0.0F;               ///< kPoint: from the point; kRay, kPixel: along the ray

  bool operator==(const DescribedSegment&) const = default;
};
static_assert(sizeof(DescribedSegment) == sizeof(SegmentStatistics) + 100,
              "another layout: raise kSegmentRecordsVersion");

/// Two segments that touch.
struct SegmentContact {
  std::uint32_t segment_id = 0;    ///< one that the answer describes
  std::uint32_t neighbour_id = 0;  ///< any other
  std::uint32_t num_pairs = 0;     ///< pairs of neighbouring points, one in each; > 0

  bool operator==(const SegmentContact&) const = default;
};
static_assert(sizeof(SegmentContact) == 12, "another layout: raise kSegmentRecordsVersion");

/// What a segmenter answers to a SegmentQuery.
struct SegmentAnswer {
  std::int64_t utime = 0;        ///< wall clock, microseconds
  std::int64_t session = 0;      ///< of the segmenter; > 0
  std::int64_t client = 0;       ///< of the query
  std::int64_t number = 0;       ///< of the query
  std::int64_t map_session = 0;  ///< of the mapper whose map was asked; 0: there is no such map
  std::string map_name;          ///< of that mapper
  std::string problem;           ///< why the query cannot be answered; empty: it is answered
  std::int32_t map_slices = 0;   ///< in the map that was asked
  std::int64_t map_points = 0;
  std::int64_t map_segments = 0;
  std::int64_t num_matching = 0;  ///< segments that match; `segments` has at most max_segments
  bool has_hit = false;           ///< kPoint, kRay, kPixel: a map point was found
  float hit_W[3] = {};            ///< that point, metres
  std::int64_t view_utime = 0;    ///< kPixel: device time of the CameraView that was used; 0: none
  /// kPixel: distance from the camera to what it measures at the pixel; 0: it measures nothing.
  /// With a distance and without a hit, that surface is not in the segment map yet.
  float surface_distance_m = 0.0F;
  std::vector<DescribedSegment> segments;  ///< the largest first
  std::vector<SegmentContact> contacts;    ///< of each of `segments`, by ascending ids
  /// kViews: the oldest of the views that were asked for, as many as one answer may hold, in the
  /// format of segmenter/io/views_file.hpp, which is not empty without views either, with their
  /// poses as the map is corrected now. Else empty.
  std::vector<std::uint8_t> views;

  bool operator==(const SegmentAnswer&) const = default;
};

}  // namespace kintsugi
