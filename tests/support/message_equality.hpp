#pragma once
// Field by field, so that a field the codec forgets makes a test fail.

#include <algorithm>

#include "lcmtypes/messages.hpp"

namespace kintsugi {

// Bit for bit: the codec copies, it does not compute.
inline bool equal(const Pose& a, const Pose& b) { return a.matrix() == b.matrix(); }

inline bool operator==(const CloudSlice& a, const CloudSlice& b) {
  return a.utime == b.utime && a.session == b.session && a.map_name == b.map_name && a.id == b.id &&
         a.revision == b.revision && a.kind == b.kind && a.resolution_m == b.resolution_m &&
         equal(a.X_WC, b.X_WC) && a.points_W == b.points_W;
}

inline bool operator==(const SegmentUpdate& a, const SegmentUpdate& b) {
  return a.utime == b.utime && a.session == b.session && a.map_session == b.map_session &&
         a.map_name == b.map_name && a.slice_id == b.slice_id &&
         a.slice_revision == b.slice_revision && a.is_final == b.is_final &&
         a.num_slices == b.num_slices && a.num_points == b.num_points &&
         a.num_segments == b.num_segments && a.labels == b.labels && a.runs == b.runs &&
         a.events == b.events && a.statistics == b.statistics;
}

inline bool operator==(const SegmentAnswer& a, const SegmentAnswer& b) {
  return a.utime == b.utime && a.session == b.session && a.client == b.client &&
         a.number == b.number && a.map_session == b.map_session && a.map_name == b.map_name &&
         a.problem == b.problem && a.map_slices == b.map_slices && a.map_points == b.map_points &&
         a.map_segments == b.map_segments && a.num_matching == b.num_matching &&
         a.has_hit == b.has_hit && std::ranges::equal(a.hit_W, b.hit_W) &&
         a.segments == b.segments && a.contacts == b.contacts;
}

inline bool operator==(const RgbdFrameMessage& a, const RgbdFrameMessage& b) {
  return a.utime == b.utime && a.color_utime == b.color_utime && a.session == b.session &&
         a.frame_index == b.frame_index && a.intrinsics == b.intrinsics &&
         a.depth_units_per_m == b.depth_units_per_m && a.depth_png == b.depth_png &&
         a.color_jpeg == b.color_jpeg;
}

inline bool operator==(const Snapshot& a, const Snapshot& b) {
  return a.utime == b.utime && a.session == b.session && a.caption == b.caption &&
         a.width == b.width && a.height == b.height && a.image_jpeg == b.image_jpeg;
}

inline bool operator==(const CameraPose& a, const CameraPose& b) {
  return a.utime == b.utime && a.session == b.session && a.frame_index == b.frame_index &&
         a.state == b.state && equal(a.X_WC, b.X_WC);
}

inline bool operator==(const ResendRequest& a, const ResendRequest& b) {
  return a.utime == b.utime && a.session == b.session && a.channel == b.channel &&
         a.receiver == b.receiver && a.ranges == b.ranges;
}

}  // namespace kintsugi
