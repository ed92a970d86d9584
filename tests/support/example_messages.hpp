#pragma once
// One filled example of each message of the contract; every field differs from its default.

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::testing {

inline Pose example_pose() {
  Pose X_WC = Pose::Identity();
  X_WC.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  X_WC.translation() << 1.25, -2.5, 0.125;
  return X_WC;
}

inline CloudSlice example_slice(int num_points, std::int32_t id = 7) {
  std::mt19937 random(static_cast<unsigned>(num_points + id));
  std::uniform_real_distribution<float> coordinate(-5.0F, 5.0F);
  CloudSlice slice;
  slice.utime = 1'700'000'000'123'456;
  slice.session = 42;
  slice.map_name = "office";
  slice.id = id;
  slice.revision = 1;
  slice.kind = SliceKind::kShiftMinusZ;
  slice.resolution_m = 0.01F;
  slice.X_WC = example_pose();
  for (int i = 0; i < num_points; ++i) {
    CloudPoint point;
    point.x = coordinate(random);
    point.y = coordinate(random);
    point.z = coordinate(random);
    point.ny = 1.0F;
    point.red = static_cast<std::uint8_t>(i);
    point.blue = static_cast<std::uint8_t>(i >> 8);
    point.weight = static_cast<float>(i);
    slice.points_W.push_back(point);
  }
  return slice;
}

inline SegmentUpdate example_update(int num_labels, std::int32_t slice_id = 7) {
  SegmentUpdate update;
  update.utime = 1'700'000'000'123'456;
  update.session = 43;
  update.map_session = 42;
  update.map_name = "office";
  update.slice_id = slice_id;
  update.slice_revision = 1;
  update.is_final = true;
  update.num_slices = slice_id + 1;
  update.num_points = 1'000'000;
  update.num_segments = 321;
  for (int i = 0; i < num_labels; ++i) {
    const auto id = static_cast<std::uint32_t>(i % 97 + 1);
    update.labels.push_back(id);
    if (i % 5 == 0) update.runs.push_back({slice_id, i, 5, id, 1});
    if (i % 7 == 0) update.events.push_back({SegmentEventType::kMerged, id, id + 1});
    if (i % 11 == 0) {
      SegmentStatistics statistics;
      statistics.segment_id = id;
      statistics.num_points = 500;
      statistics.box_max_W[1] = 0.5F;
      statistics.centroid_W[2] = 0.25F;
      statistics.mean_normal_W[0] = 1.0F;
      statistics.mean_color[2] = 200;
      statistics.area_m2 = 0.05F;
      statistics.first_slice = 1;
      statistics.last_slice = slice_id;
      update.statistics.push_back(statistics);
    }
  }
  return update;
}

inline std::vector<std::uint8_t> example_bytes(int size) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  for (int i = 0; i < size; ++i) {
    bytes[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(i * 7 + i / 256);
  }
  return bytes;
}

inline RgbdFrameMessage example_frame(int depth_bytes, int color_bytes) {
  RgbdFrameMessage frame;
  frame.utime = 5'000'000;
  frame.color_utime = 5'001'000;
  frame.session = 44;
  frame.frame_index = 150;
  frame.intrinsics = {525.0, 526.0, 319.5, 239.5, 640, 480, {0.1, -0.2, 0.001, 0.002, 0.05}};
  frame.depth_units_per_m = 5000;
  frame.depth_png = example_bytes(depth_bytes);
  frame.color_jpeg = example_bytes(color_bytes);
  return frame;
}

inline Snapshot example_snapshot(int image_bytes) {
  return {6'000'000, 45, "12.5 s, 100 000 points", 1280, 720, example_bytes(image_bytes)};
}

inline SegmentQuery example_query() {
  SegmentQuery query;
  query.utime = 8'000'000;
  query.client = 46;
  query.number = 3;
  query.map_session = 42;
  query.map_name = "office";
  query.place = QueryPlace::kRay;
  for (int axis = 0; axis < 3; ++axis) {
    query.point_W[axis] = 0.5 + axis;
    query.box_min_W[axis] = -1.0 - axis;
    query.box_max_W[axis] = 2.0 + axis;
  }
  query.direction_W[1] = 1.0;
  query.radius_m = 0.25;
  query.segment_ids = {7, 0xFFFFFFFFU, 12};
  query.only_planar = true;
  query.changed_since = 9'000'000;
  query.max_segments = 20;
  return query;
}

inline DescribedSegment example_described_segment(std::uint32_t id) {
  DescribedSegment segment;
  segment.statistics.segment_id = id;
  segment.statistics.num_points = 500;
  segment.statistics.area_m2 = 0.05F;
  segment.last_change_utime = 9'500'000 + id;
  segment.oriented_box_center_W[1] = 0.25F;
  for (int axis = 0; axis < 3; ++axis) {
    segment.oriented_box_axes_W[axis][2 - axis] = -1.0F;
    segment.oriented_box_size_m[axis] = 0.5F * static_cast<float>(axis);
  }
  segment.plane_normal_W[2] = -1.0F;
  segment.plane_offset_m = -2.5F;
  segment.plane_rms_m = 0.004F;
  segment.plane_share = 0.875F;
  segment.distance_m = 1.75F;
  segment.is_planar = 1;
  return segment;
}

inline SegmentAnswer example_answer(int num_segments) {
  SegmentAnswer answer;
  answer.utime = 8'100'000;
  answer.session = 43;
  answer.client = 46;
  answer.number = 3;
  answer.map_session = 42;
  answer.map_name = "office";
  answer.problem = "no map is kept";
  answer.map_slices = 12;
  answer.map_points = 1'000'000;
  answer.map_segments = 321'000;
  answer.num_matching = num_segments + 1;
  answer.has_hit = true;
  answer.hit_W[0] = 1.5F;
  answer.hit_W[2] = -0.5F;
  for (int i = 0; i < num_segments; ++i) {
    const auto id = static_cast<std::uint32_t>(i + 1);
    answer.segments.push_back(example_described_segment(id));
    if (i % 3 == 0) answer.contacts.push_back({id, id + 5, 40});
  }
  return answer;
}

inline CameraPose example_camera_pose() {
  return {7'000'000, 42, 210, TrackingState::kTracking, example_pose()};
}

inline MapperStatus example_mapper_status() {
  MapperStatus status;
  status.utime = 1;
  status.session = 42;
  status.map_name = "office";
  status.device = "synthetic://office";
  status.state = TrackingState::kLost;
  status.finished = true;
  status.lingering = true;
  status.loss_reason = "too few inliers";
  status.frames_read = 2;
  status.frames_total = 3;
  status.frames_tracked = 4;
  status.frames_lost = 5;
  status.frames_relocalised = 6;
  status.frames_dropped = 7;
  status.frames_resumed = 40;
  status.keyframes = 8;
  status.undetermined = 3;
  status.slices_published = 10;
  status.points_published = 11;
  status.chunks_published = 12;
  status.chunks_resent = 41;
  status.requests_received = 42;
  status.store_bytes = 43;
  status.store_waiting_bytes = 44;
  status.store_lost_chunks = 45;
  status.store_problem = "no space left";
  status.blocks = 13;
  status.memory_bytes = 14;
  status.volume_bytes = 15;
  status.queue_bytes = 16;
  status.frame_rate_hz = 20.5;
  status.frame_p50_ms = 21.5;
  status.frame_p99_ms = 22.5;
  status.cpu_ms = 23.5;
  status.read_ms = 24.5;
  status.convert_ms = 25.5;
  status.prepare_ms = 26.5;
  status.track_ms = 27.5;
  status.shift_ms = 28.5;
  status.integrate_ms = 29.5;
  status.raycast_ms = 30.5;
  status.extract_ms = 31.5;
  status.publish_ms = 32.5;
  return status;
}

inline SegmenterStatus example_segmenter_status() {
  SegmenterStatus status;
  status.utime = 1;
  status.session = 43;
  status.map_session = 42;
  status.map_name = "office";
  status.mode = "voting";
  status.finished = true;
  status.slices_received = 2;
  status.slices_segmented = 3;
  status.slices_corrected = 21;
  status.lag_slices = 4;
  status.points = 5;
  status.points_rejected = 6;
  status.segments = 7;
  status.chunks_received = 8;
  status.chunks_duplicate = 9;
  status.chunks_missing = 10;
  status.messages_bad = 11;
  status.memory_bytes = 12;
  status.slice_ms = 13.5;
  status.slice_mean_ms = 14.5;
  status.slice_max_ms = 15.5;
  status.slices_missing = 16;
  status.lingering = true;
  status.maps = 22;
  status.queue_bytes = 23;
  status.chunks_refused = 24;
  status.chunks_given_up = 25;
  status.requests_sent = 26;
  status.chunks_resent = 27;
  status.requests_received = 28;
  status.states_sent = 29;
  status.state_bytes = 30;
  status.problem = "cannot write segments.ply";
  return status;
}

inline ViewerStatus example_viewer_status() {
  ViewerStatus status;
  status.utime = 1;
  status.session = 45;
  status.map_session = 42;
  status.map_name = "office";
  status.finished = true;
  status.slices_received = 2;
  status.updates_applied = 3;
  status.lag_slices = 4;
  status.queue_bytes = 5;
  status.points = 6;
  status.segments = 7;
  status.snapshots_written = 8;
  status.chunks_missing = 9;
  status.chunks_refused = 10;
  status.chunks_given_up = 11;
  status.requests_sent = 12;
  status.messages_bad = 13;
  status.memory_bytes = 14;
  status.render_ms = 15.5;
  status.problem = "cannot write final.png";
  return status;
}

inline Heartbeat example_heartbeat() { return {1, 42, "CLOUD_SLICE", 3, 17, 5, "office"}; }

inline ResendRequest example_resend_request() {
  return {1, 42, "CLOUD_SLICE", 99, {{0, 0}, {5, 9}, {12, 1'000'000}}};
}

}  // namespace kintsugi::testing
