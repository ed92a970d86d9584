#pragma once
// Equality of the messages that have none of their own: with a pose, or with fields that only the
// receiver sets. The structured bindings do not compile when a struct has a further field.

#include <algorithm>

#include "lcmtypes/messages.hpp"

namespace kintsugi {

// Bit for bit: the codec copies the numbers.
inline bool equal(const Pose& a, const Pose& b) { return a.matrix() == b.matrix(); }

inline bool operator==(const CloudSlice& a, const CloudSlice& b) {
  const auto& [utime, session, map_name, sequence, num_chunks, id, revision, kind, in_volume,
               ends_batch, superseded, revision_sum, part, resolution_m, X_WC, X_WP, correction,
               keyframe, points_W, motions, loops] = a;
  return utime == b.utime && session == b.session && map_name == b.map_name && id == b.id &&
         revision == b.revision && kind == b.kind && in_volume == b.in_volume &&
         ends_batch == b.ends_batch && superseded == b.superseded &&
         revision_sum == b.revision_sum && part == b.part && resolution_m == b.resolution_m &&
         equal(X_WC, b.X_WC) && X_WP == b.X_WP && correction == b.correction &&
         keyframe == b.keyframe && points_W == b.points_W && motions == b.motions &&
         loops == b.loops;
}

inline bool operator==(const SegmentUpdate& a, const SegmentUpdate& b) {
  const auto& [utime, session, sequence, map_session, map_name, slice_id, slice_revision, is_final,
               num_slices, num_points, num_segments, labels, runs, events, statistics] = a;
  return utime == b.utime && session == b.session && map_session == b.map_session &&
         map_name == b.map_name && slice_id == b.slice_id && slice_revision == b.slice_revision &&
         is_final == b.is_final && num_slices == b.num_slices && num_points == b.num_points &&
         num_segments == b.num_segments && labels == b.labels && runs == b.runs &&
         events == b.events && statistics == b.statistics;
}

inline bool operator==(const CameraView& a, const CameraView& b) {
  const auto& [utime, session, map_name, frame_index, state, X_WC, part, intrinsics, depth_step,
               depth_mm, color_jpeg] = a;
  return utime == b.utime && session == b.session && map_name == b.map_name &&
         frame_index == b.frame_index && state == b.state && equal(X_WC, b.X_WC) &&
         part == b.part && intrinsics == b.intrinsics && depth_step == b.depth_step &&
         depth_mm == b.depth_mm && color_jpeg == b.color_jpeg;
}

inline bool operator==(const KeyframeMessage& a, const KeyframeMessage& b) {
  const auto& [utime, session, map_name, join, number, previous, tracked_from, part, way_m,
               unseen_m, resolution_m, X_UK, information_K, noise_base_m, noise_share,
               noise_growth_per_m, intrinsics, in_volume, features, depth, intensity] = a;
  return utime == b.utime && session == b.session && map_name == b.map_name && join == b.join &&
         number == b.number && previous == b.previous && tracked_from == b.tracked_from &&
         part == b.part && way_m == b.way_m && unseen_m == b.unseen_m &&
         resolution_m == b.resolution_m && equal(X_UK, b.X_UK) &&
         information_K == b.information_K && noise_base_m == b.noise_base_m &&
         noise_share == b.noise_share && noise_growth_per_m == b.noise_growth_per_m &&
         intrinsics == b.intrinsics && in_volume == b.in_volume && features == b.features &&
         depth == b.depth && intensity == b.intensity;
}

inline bool operator==(const ObjectDetection& a, const ObjectDetection& b) {
  const auto& [utime, session, map_session, map_name, detection, num_detections, event_number,
               event, name, X_WO, score, box_min_O, box_max_O, points, segment_ids] = a;
  return utime == b.utime && session == b.session && map_session == b.map_session &&
         map_name == b.map_name && detection == b.detection && num_detections == b.num_detections &&
         event_number == b.event_number && event == b.event && name == b.name &&
         equal(X_WO, b.X_WO) && score == b.score && std::ranges::equal(box_min_O, b.box_min_O) &&
         std::ranges::equal(box_max_O, b.box_max_O) && points == b.points &&
         segment_ids == b.segment_ids;
}

inline bool operator==(const ChangeReport& a, const ChangeReport& b) {
  const auto& [utime, session, map_session, map_name, before, change, num_changes, event_number,
               kind, score, motion_W, box_min_W, box_max_W, points, segment_ids] = a;
  return utime == b.utime && session == b.session && map_session == b.map_session &&
         map_name == b.map_name && before == b.before && change == b.change &&
         num_changes == b.num_changes && event_number == b.event_number && kind == b.kind &&
         score == b.score && equal(motion_W, b.motion_W) &&
         std::ranges::equal(box_min_W, b.box_min_W) && std::ranges::equal(box_max_W, b.box_max_W) &&
         points == b.points && segment_ids == b.segment_ids;
}

inline bool operator==(const CameraPose& a, const CameraPose& b) {
  const auto& [utime, session, frame_index, state, X_WC, part] = a;
  return utime == b.utime && session == b.session && frame_index == b.frame_index &&
         state == b.state && equal(X_WC, b.X_WC) && part == b.part;
}

}  // namespace kintsugi
