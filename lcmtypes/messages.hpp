#pragma once
// What the processes say to each other, as plain structs. codec.hpp turns each into LCM messages
// and back, with every bound checked.

#include <cstdint>
#include <string>
#include <vector>

#include "lcmtypes/geometry.hpp"

namespace kintsugi {

/// One surface point of the map in frame W; this is also its layout on the bus and in files
/// (32 bytes, little-endian, no padding).
struct CloudPoint {
  float x = 0.0F;  ///< metres, W
  float y = 0.0F;
  float z = 0.0F;
  float nx = 0.0F;  ///< unit normal, W, towards free space
  float ny = 0.0F;
  float nz = 0.0F;
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
  std::uint8_t reserved = 0;  ///< zero
  float weight = 0.0F;        ///< number of observations fused, >= 0

  bool operator==(const CloudPoint&) const = default;
};
static_assert(sizeof(CloudPoint) == 32);

/// Why a slice left the volume: the direction in which the volume moved, or the end of the run.
enum class SliceKind : std::int8_t {
  kFinal = 0,  ///< what was still in the volume at the end; the last slice of a session
  kShiftPlusX = 1,
  kShiftMinusX = 2,
  kShiftPlusY = 3,
  kShiftMinusY = 4,
  kShiftPlusZ = 5,
  kShiftMinusZ = 6,
};

/// A piece of the map: the surface that left the moving volume at one moment.
///
/// Slices of a session are numbered from 0 without gaps; kFinal is the last. A slice that comes
/// again with a higher revision replaces the earlier one. A slice may hold no points.
struct CloudSlice {
  std::int64_t utime = 0;    ///< device time of the frame at which it left, microseconds
  std::int64_t session = 0;  ///< one run of one mapper; > 0
  std::string map_name;      ///< tells mappers on one bus apart
  /// Place in the stream: number of its first chunk, and how many it has. Known to receivers, not
  /// to be set; num_chunks 0: it came by no stream.
  std::int64_t sequence = 0;
  std::int32_t num_chunks = 0;
  std::int32_t id = 0;  ///< >= 0
  std::int32_t revision = 0;
  SliceKind kind = SliceKind::kFinal;
  float resolution_m = 0.0F;  ///< voxel size, > 0
  Pose X_WC = Pose::Identity();
  std::vector<CloudPoint> points_W;
};

enum class TrackingState : std::int8_t {
  kStarting = 0,  ///< no frame fused yet
  kTracking = 1,
  kLost = 2,   ///< X_WC is the last good pose; nothing is fused
  kGiven = 3,  ///< X_WC comes from a trajectory file
};

struct CameraPose {
  std::int64_t utime = 0;  ///< device time of the frame, microseconds
  std::int64_t session = 0;
  std::int64_t frame_index = 0;
  TrackingState state = TrackingState::kStarting;
  Pose X_WC = Pose::Identity();
};

/// A raw frame for the bus; images are compressed.
struct RgbdFrameMessage {
  std::int64_t utime = 0;        ///< of the depth image, device time, microseconds
  std::int64_t color_utime = 0;  ///< of the colour image; equals utime when there is none
  std::int64_t session = 0;
  std::int64_t frame_index = 0;
  Intrinsics intrinsics;                 ///< of the depth image
  double depth_units_per_m = 1000;       ///< raw depth value / this = metres; raw 0 is invalid
  std::vector<std::uint8_t> depth_png;   ///< 16-bit single-channel PNG
  std::vector<std::uint8_t> color_jpeg;  ///< 8-bit three-channel JPEG or PNG, empty: no colour
};

/// A run of consecutive points of one slice that now carry `segment_id`; 20 bytes on the bus.
struct LabelRun {
  std::int32_t slice_id = 0;
  std::int32_t first = 0;  ///< index of the first point in its slice
  std::int32_t count = 0;  ///< > 0
  std::uint32_t segment_id = 0;
  std::int32_t slice_revision = 0;  ///< a point is named by slice, revision and index

  bool operator==(const LabelRun&) const = default;
};

enum class SegmentEventType : std::uint32_t {
  kCreated = 0,
  kGrown = 1,    ///< other_id is 0
  kMerged = 2,   ///< segment_id absorbed other_id, one event for each id absorbed
  kSplit = 3,    ///< other_id was split off segment_id, one event for each new id
  kRetired = 4,  ///< segment_id is gone
};

struct SegmentEvent {  ///< 12 bytes on the bus
  SegmentEventType type = SegmentEventType::kCreated;
  std::uint32_t segment_id = 0;
  std::uint32_t other_id = 0;

  bool operator==(const SegmentEvent&) const = default;
};

struct SegmentStatistics {  ///< 72 bytes on the bus
  std::uint32_t segment_id = 0;
  std::uint32_t num_points = 0;
  float box_min_W[3] = {};          ///< axis-aligned bounding box, metres
  float box_max_W[3] = {};          ///< metres
  float centroid_W[3] = {};         ///< metres
  float mean_normal_W[3] = {};      ///< unit, or zero when the normals cancel out
  std::uint8_t mean_color[3] = {};  ///< red, green, blue
  std::uint8_t reserved = 0;
  float area_m2 = 0.0F;  ///< num_points * resolution^2
  std::int32_t first_slice = 0;
  std::int32_t last_slice = 0;

  bool operator==(const SegmentStatistics&) const = default;
};

/// Segment id of a point that belongs to no segment (rejected at the door). Ids start at 1.
inline constexpr std::uint32_t kNoSegment = 0;

/// What changed in the segment map when one slice was added, or replaced by a higher revision.
struct SegmentUpdate {
  std::int64_t utime = 0;        ///< device time of the slice, microseconds
  std::int64_t session = 0;      ///< of the segmenter; > 0
  std::int64_t sequence = 0;     ///< ascending in the session; known to receivers, not to be set
  std::int64_t map_session = 0;  ///< of the mapper whose slice this is
  std::string map_name;
  std::int32_t slice_id = 0;
  std::int32_t slice_revision = 0;
  bool is_final = false;              ///< after the final slice, with every earlier one present
  std::int32_t num_slices = 0;        ///< in the map after this update
  std::int64_t num_points = 0;        ///< in the map after this update
  std::int64_t num_segments = 0;      ///< in the map after this update
  std::vector<std::uint32_t> labels;  ///< segment id of each point of the slice, in its order
  std::vector<LabelRun> runs;         ///< older points whose label changed
  std::vector<SegmentEvent> events;
  std::vector<SegmentStatistics> statistics;  ///< of every segment that changed
};

/// Where a query looks.
enum class QueryPlace : std::int8_t {
  kAnywhere = 0,
  kPoint = 1,  ///< the segment of the map point nearest to point_W
  kRay = 2,    ///< the segment that a camera at point_W sees along direction_W
  kBox = 3,    ///< the segments with a point in the box, its faces included
  kIds = 4,    ///< the segments of these ids, as far as they exist
};

/// Asks a segmenter for segments: those at a place that pass every filter, the largest first (of
/// equal ones the smaller id). Fields that the place does not use are ignored.
struct SegmentQuery {
  std::int64_t utime = 0;        ///< wall clock, microseconds
  std::int64_t client = 0;       ///< who asks; > 0
  std::int64_t number = 0;       ///< of those of the client, >= 0; the same when asked again
  std::int64_t map_session = 0;  ///< of the mapper whose map is asked; 0: the newest of map_name
  std::string map_name;          ///< of the mapper whose map is asked; empty: any
  QueryPlace place = QueryPlace::kAnywhere;
  double point_W[3] = {};      ///< kPoint: where; kRay: where it starts; metres
  double direction_W[3] = {};  ///< kRay: unit
  double box_min_W[3] = {};    ///< kBox: metres
  double box_max_W[3] = {};    ///< kBox: metres, none below box_min_W
  double radius_m = 0.0;       ///< kPoint, kRay: how far off a map point may be; 0: two voxels
  std::vector<std::uint32_t> segment_ids;  ///< kIds
  bool only_planar = false;
  std::int64_t changed_since = 0;  ///< only what changed after this device time; 0: all
  std::int32_t max_segments = 0;   ///< the largest so many; 0: all

  bool operator==(const SegmentQuery&) const = default;
};

/// Everything that is told of one segment; 176 bytes on the bus.
struct DescribedSegment {
  SegmentStatistics statistics;
  std::int64_t last_change_utime = 0;    ///< device time of the slice that changed it last
  float oriented_box_center_W[3] = {};   ///< metres
  float oriented_box_axes_W[3][3] = {};  ///< three unit vectors
  float oriented_box_size_m[3] = {};     ///< along each axis, >= 0
  float plane_normal_W[3] = {};          ///< unit, or zero: no plane fits
  float plane_offset_m = 0.0F;           ///< points p on the plane have plane_normal_W * p = this
  float plane_rms_m = 0.0F;              ///< of the distances of its points from the plane
  float plane_share = 0.0F;              ///< of its points within one voxel of the plane, 0 to 1
  float distance_m = 0.0F;               ///< kPoint: from it; kRay: along it; else 0
  std::uint32_t is_planar = 0;           ///< 1: yes

  bool operator==(const DescribedSegment&) const = default;
};

/// Two segments that touch; 12 bytes on the bus.
struct SegmentContact {
  std::uint32_t segment_id = 0;    ///< one that is described
  std::uint32_t neighbour_id = 0;  ///< any other
  std::uint32_t num_pairs = 0;     ///< pairs of neighbouring points, one in each; > 0

  bool operator==(const SegmentContact&) const = default;
};

/// What a segmenter answers to a SegmentQuery.
struct SegmentAnswer {
  std::int64_t utime = 0;        ///< wall clock, microseconds
  std::int64_t session = 0;      ///< of the segmenter; > 0
  std::int64_t client = 0;       ///< who asked
  std::int64_t number = 0;       ///< of the query
  std::int64_t map_session = 0;  ///< of the mapper whose map answers; 0: none does
  std::string map_name;          ///< of that mapper
  std::string problem;           ///< why there is no answer; empty: there is
  std::int32_t map_slices = 0;   ///< in the map that was asked
  std::int64_t map_points = 0;
  std::int64_t map_segments = 0;
  std::int64_t num_matching = 0;  ///< segments; not all are described when fewer were wanted
  bool has_hit = false;           ///< kPoint, kRay: a map point was found
  float hit_W[3] = {};            ///< that point, metres
  std::vector<DescribedSegment> segments;  ///< the largest first
  std::vector<SegmentContact> contacts;    ///< of each of segments, by ascending ids
};

struct Snapshot {
  std::int64_t utime = 0;
  std::int64_t session = 0;
  std::string caption;
  std::int32_t width = 0;
  std::int32_t height = 0;
  std::vector<std::uint8_t> image_jpeg;
};

struct MapperStatus {
  std::int64_t utime = 0;  ///< wall clock, microseconds
  std::int64_t session = 0;
  std::string map_name;
  std::string device;
  TrackingState state = TrackingState::kStarting;
  std::string loss_reason;  ///< why the last frame was not believed; empty when it was
  bool finished = false;    ///< every slice of the session has been published
  bool lingering = false;   ///< nothing is left to publish; stays to send again what is missed
  std::int64_t frames_read = 0;
  std::int64_t frames_total = -1;  ///< -1: not known (a live camera)
  std::int64_t frames_tracked = 0;
  std::int64_t frames_lost = 0;
  std::int64_t frames_relocalised = 0;  ///< of those tracked, the ones that ended a loss
  std::int64_t frames_dropped = 0;
  std::int64_t frames_resumed = 0;  ///< of those read, the ones read again to resume a session
  std::int64_t keyframes = 0;
  std::int32_t undetermined = 0;  ///< directions of motion that the last frame left open, 0 to 6
  std::int64_t slices_published = 0;
  std::int64_t points_published = 0;
  std::int64_t chunks_published = 0;
  std::int64_t chunks_resent = 0;
  std::int64_t requests_received = 0;    ///< for chunks to be sent again
  std::int64_t store_bytes = 0;          ///< disk use of its log, from which it resends
  std::int64_t store_waiting_bytes = 0;  ///< published and not on disk yet
  std::int64_t store_lost_chunks = 0;    ///< published, and cannot be sent again any more
  std::string store_problem;             ///< why the log cannot be written; empty when it can
  std::int64_t blocks = 0;               ///< voxel blocks in use
  std::int64_t memory_bytes = 0;         ///< resident, of the whole process
  std::int64_t volume_bytes = 0;         ///< of it, the volume
  std::int64_t queue_bytes = 0;          ///< of it, what waits to be sent
  double frame_rate_hz = 0.0;
  /// Wall time from a frame taken to its messages sent, of the frames since the last status.
  double frame_p50_ms = 0.0;
  double frame_p99_ms = 0.0;
  /// Means per frame since the last status: CPU of all threads, then the stages.
  double cpu_ms = 0.0;
  double read_ms = 0.0;  ///< waiting for the device included
  double convert_ms = 0.0;
  double prepare_ms = 0.0;
  double track_ms = 0.0;
  double shift_ms = 0.0;
  double integrate_ms = 0.0;
  double raycast_ms = 0.0;
  double extract_ms = 0.0;
  double publish_ms = 0.0;

  bool operator==(const MapperStatus&) const = default;
};

struct SegmenterStatus {
  std::int64_t utime = 0;
  std::int64_t session = 0;
  std::int64_t map_session = 0;
  std::string map_name;
  std::string mode;
  bool finished = false;   ///< the final slice and every earlier one are segmented and published
  bool lingering = false;  ///< nothing is left to publish; stays to send again what is missed
  std::int64_t maps = 0;   ///< being kept now
  std::int64_t slices_received = 0;
  std::int64_t slices_segmented = 0;
  std::int64_t slices_corrected = 0;  ///< higher revisions that replaced what was segmented
  std::int64_t slices_missing = 0;    ///< known to exist, and given up until they come after all
  std::int64_t lag_slices = 0;        ///< received, or known to exist, and not yet segmented
  std::int64_t queue_bytes = 0;       ///< received and not yet segmented
  std::int64_t points = 0;
  std::int64_t points_rejected = 0;
  std::int64_t segments = 0;
  std::int64_t chunks_received = 0;
  std::int64_t chunks_duplicate = 0;
  std::int64_t chunks_missing = 0;
  std::int64_t chunks_refused = 0;   ///< there was no room: asked for again later
  std::int64_t chunks_given_up = 0;  ///< missing, and nobody answers
  std::int64_t requests_sent = 0;    ///< for missing chunks
  std::int64_t chunks_resent = 0;
  std::int64_t requests_received = 0;
  std::int64_t states_sent = 0;  ///< full states, for receivers that came late
  std::int64_t state_bytes = 0;  ///< of the last of them
  std::int64_t messages_bad = 0;
  std::int64_t memory_bytes = 0;
  std::string problem;    ///< what a person must see to, e.g. a file that cannot be written
  double slice_ms = 0.0;  ///< of the last slice
  double slice_mean_ms = 0.0;
  double slice_max_ms = 0.0;

  bool operator==(const SegmenterStatus&) const = default;
};

struct ViewerStatus {
  std::int64_t utime = 0;
  std::int64_t session = 0;
  std::int64_t map_session = 0;  ///< of the mapper whose map it draws, 0: none yet
  std::string map_name;          ///< of that mapper
  bool finished = false;         ///< the final update has been drawn and written
  std::int64_t slices_received = 0;
  std::int64_t updates_applied = 0;
  std::int64_t lag_slices = 0;   ///< received slices without an applied update
  std::int64_t queue_bytes = 0;  ///< received and not yet drawn
  std::int64_t points = 0;
  std::int64_t segments = 0;
  std::int64_t snapshots_written = 0;
  std::int64_t chunks_missing = 0;
  std::int64_t chunks_refused = 0;   ///< there was no room: asked for again later
  std::int64_t chunks_given_up = 0;  ///< missing, and nobody answers
  std::int64_t requests_sent = 0;    ///< for missing chunks
  std::int64_t messages_bad = 0;
  std::int64_t memory_bytes = 0;
  double render_ms = 0.0;  ///< of the last picture
  std::string problem;     ///< what a person must see to, e.g. a file that cannot be written

  bool operator==(const ViewerStatus&) const = default;
};

/// The sender of a reliable stream says what exists.
struct Heartbeat {
  std::int64_t utime = 0;
  std::int64_t session = 0;
  std::string channel;
  std::int64_t first_sequence = 0;  ///< the oldest that can still be resent
  std::int64_t next_sequence = 0;   ///< one past the newest
  /// Who has everything from here on lacks nothing: what went before is superseded by the full
  /// state sent from here. 0: nothing is superseded.
  std::int64_t state_sequence = 0;
  std::string map_name;  ///< of the map the stream carries; empty: several

  bool operator==(const Heartbeat&) const = default;
};

struct SequenceRange {
  std::int64_t first = 0;
  std::int64_t last = 0;  ///< inclusive

  bool operator==(const SequenceRange&) const = default;
};

/// A receiver of a reliable stream says what it misses.
struct ResendRequest {
  std::int64_t utime = 0;
  std::int64_t session = 0;  ///< of the sender
  std::string channel;
  std::int64_t receiver = 0;
  std::vector<SequenceRange> ranges;
};

}  // namespace kintsugi
