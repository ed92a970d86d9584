#pragma once
// An example of each message, in which every field differs from its default.

#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <type_traits>
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
  slice.in_volume = true;
  slice.ends_batch = true;
  slice.revision_sum = 12;
  slice.part = 2;
  slice.keyframe = 13;
  slice.resolution_m = 0.01F;
  slice.X_WC = example_pose();
  slice.correction = 3;
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

inline CloudSlice example_patch(int num_points, std::int32_t id = 7) {
  CloudSlice patch = example_slice(num_points, id);
  patch.kind = SliceKind::kPatch;
  patch.X_WP = example_pose();
  return patch;
}

/// Moves the patches 3, 8, 13, ...
inline CloudSlice example_correction(int num_motions, std::int32_t id = 7) {
  CloudSlice correction = example_slice(0, id);
  correction.kind = SliceKind::kCorrection;
  correction.revision = 0;
  correction.X_WP = example_pose();
  for (int i = 0; i < num_motions; ++i) {
    Pose X_WP = example_pose();
    X_WP.translation().x() += i;
    correction.motions.push_back({3 + 5 * i, X_WP});
  }
  if (num_motions > 0) {
    correction.loops = {{90, 4, {1, 2, 3}, {1.5, 2, 3}}, {91, 4, {4, 5, 6}, {4, 5, 7}}};
  }
  return correction;
}

/// Gives each field of the statistics a valid value of its own, other than its default.
inline SegmentStatistics example_statistics(std::uint32_t segment_id) {
  struct Filler {
    int number = 0;  // of the value

    void fill(float& value) { value = 0.25F * static_cast<float>(++number); }
    void fill(std::int32_t& value) { value = ++number; }
    void fill(std::uint32_t& value) { value = static_cast<std::uint32_t>(++number); }
    void fill(std::uint8_t& value) { value = static_cast<std::uint8_t>(++number); }
  };
  SegmentStatistics statistics;
  Filler filler;
  SegmentStatistics::visit_fields(
      [&filler](const StatisticsField& /*field*/, auto& value) {
        if constexpr (std::is_array_v<std::remove_reference_t<decltype(value)>>) {
          for (auto& element : value) filler.fill(element);
        } else {
          filler.fill(value);
        }
      },
      statistics);
  statistics.segment_id = segment_id;
  return statistics;
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
      update.statistics.push_back(example_statistics(id));
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

inline CameraView example_view(int color_bytes) {
  CameraView view;
  view.utime = 5'500'000;
  view.session = 42;
  view.map_name = "office";
  view.frame_index = 165;
  view.state = TrackingState::kTracking;
  view.X_WC = example_pose();
  view.part = 2;
  view.intrinsics = {52.5, 52.6, 31.9, 23.9, 66, 50, {}};
  view.depth_step = 8;
  for (int i = 0; i < view.depth_width() * view.depth_height(); ++i) {
    view.depth_mm.push_back(static_cast<std::uint16_t>(1000 + 7 * i));
  }
  view.color_jpeg = example_bytes(color_bytes);
  return view;
}

inline KeyframeMessage example_keyframe(int num_features) {
  KeyframeMessage keyframe;
  keyframe.utime = 5'700'000;
  keyframe.session = 42;
  keyframe.map_name = "robot 2";
  keyframe.join = "office";
  keyframe.number = 7;
  keyframe.previous = 5;
  keyframe.tracked_from = 4;
  keyframe.part = 1;
  keyframe.way_m = 12.5;
  keyframe.unseen_m = 3.0;
  keyframe.resolution_m = 0.008F;
  keyframe.X_UK = example_pose();
  for (int i = 0; i < 36; ++i) {
    const int row = std::max(i / 6, i % 6);
    const int column = std::min(i / 6, i % 6);
    keyframe.information_K(i / 6, i % 6) = row == column ? 1e6 + row : 10.0 * row + column;
  }
  keyframe.noise_base_m = 0.001;
  keyframe.noise_share = 0.002;
  keyframe.noise_growth_per_m = 0.003;
  keyframe.intrinsics = {10.5, 10.6, 3.9, 2.9, 8, 6, {}};
  keyframe.in_volume = {2, 4, 5};
  for (int i = 0; i < num_features; ++i) {
    KeyframeFeature& feature = keyframe.features.emplace_back();
    feature = {0.01F * static_cast<float>(i), -0.2F, i % 3 == 0 ? 0.0F : 1.5F, {}};
    feature.descriptor[i % 32] = static_cast<std::uint8_t>(i);
  }
  for (int i = 0; i < 48; ++i) {
    keyframe.depth.push_back(static_cast<std::uint16_t>(4000 + 5 * i));
    keyframe.intensity.push_back(static_cast<std::uint8_t>(3 * i));
  }
  return keyframe;
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
  query.pixel_px[0] = 320.5;
  query.pixel_px[1] = 240.0;
  query.radius_m = 0.25;
  query.segment_ids = {7, 0xFFFFFFFFU, 12};
  query.only_planar = true;
  query.changed_since = 9'000'000;
  query.max_segments = 20;
  return query;
}

inline DescribedSegment example_described_segment(std::uint32_t id) {
  DescribedSegment segment;
  segment.statistics = example_statistics(id);
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
  answer.view_utime = 8'050'000;
  answer.surface_distance_m = 1.625F;
  for (int i = 0; i < num_segments; ++i) {
    const auto id = static_cast<std::uint32_t>(i + 1);
    answer.segments.push_back(example_described_segment(id));
    if (i % 3 == 0) answer.contacts.push_back({id, id + 5, 40});
    answer.views.push_back(static_cast<std::uint8_t>(i));
  }
  return answer;
}

inline CameraPose example_camera_pose() {
  return {7'000'000, 42, 210, TrackingState::kTracking, example_pose(), 2};
}

inline ObjectDetection example_detection() {
  ObjectDetection detection;
  detection.utime = 9'500'000;
  detection.session = 47;
  detection.map_session = 42;
  detection.map_name = "office";
  detection.detection = 3;
  detection.num_detections = 5;
  detection.event_number = 12;
  detection.event = DetectionEvent::kMoved;
  detection.name = "mug-2_blue";
  detection.X_WO = example_pose();
  detection.score = 0.75F;
  for (int axis = 0; axis < 3; ++axis) {
    detection.box_min_O[axis] = -0.05F - static_cast<float>(axis);
    detection.box_max_O[axis] = 0.0625F * static_cast<float>(axis);
  }
  detection.points = 812;
  detection.segment_ids = {7, 12, 0xFFFFFFFFU};
  return detection;
}

inline ChangeReport example_change() {
  ChangeReport change;
  change.utime = 9'600'000;
  change.session = 48;
  change.map_session = 42;
  change.map_name = "office";
  change.before = "office yesterday";
  change.change = 2;
  change.num_changes = 4;
  change.event_number = 9;
  change.kind = ChangeKind::kMoved;
  change.score = 0.5F;
  change.motion_W = example_pose();
  for (int axis = 0; axis < 3; ++axis) {
    change.box_min_W[axis] = -0.5F - static_cast<float>(axis);
    change.box_max_W[axis] = 0.25F * static_cast<float>(axis);
  }
  change.points = 1'234;
  change.segment_ids = {3, 0xFFFFFFFEU};
  return change;
}

/// Gives each field of a status a valid value of its own, other than its default.
struct StatusFiller {
  int number = 0;  ///< of the field

  void fill(bool& value) const { value = true; }
  void fill(TrackingState& value) const { value = TrackingState::kLost; }
  void fill(std::int32_t& value) const { value = 1 + number % 6; }
  void fill(std::int64_t& value) const { value = 100 + number; }
  void fill(double& value) const { value = number + 0.5; }
  void fill(std::string& value) const { value = "text " + std::to_string(number); }
};

template <class Status>
Status example_status() {
  Status status;
  StatusFiller filler;
  Status::visit_fields(
      [&filler](const StatusField& /*field*/, auto& value) {
        ++filler.number;
        filler.fill(value);
      },
      status);
  return status;
}

inline MapperStatus example_mapper_status() { return example_status<MapperStatus>(); }
inline SegmenterStatus example_segmenter_status() { return example_status<SegmenterStatus>(); }
inline ViewerStatus example_viewer_status() { return example_status<ViewerStatus>(); }
inline DetectorStatus example_detector_status() { return example_status<DetectorStatus>(); }

inline Heartbeat example_heartbeat() { return {1, 42, "CLOUD_SLICE", 3, 17, 5, "office"}; }

inline ResendRequest example_resend_request() {
  return {1, 42, "CLOUD_SLICE", 99, {{0, 0}, {5, 9}, {12, 1'000'000}}};
}

inline ChunksReplaced example_chunks_replaced() {
  return {1, 42, "CLOUD_SLICE", "office", {{0, 0}, {5, 9}, {12, 1'000'000}}};
}

}  // namespace kintsugi::testing
