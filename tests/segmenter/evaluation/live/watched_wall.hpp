#pragma once
// What is on the bus while a still camera looks at a wall for ten seconds, in closed form.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "tests/segmenter/core/random_clouds.hpp"
#include "tests/segmenter/query/camera_view.hpp"

namespace kintsugi::segmenter::testing {

constexpr std::int64_t kWallSession = 5;
constexpr double kWall_m = 2.0;     // distance of the wall
constexpr double kBorder_m = -0.6;  // x where one slice ends and the other begins

struct BusEvent {
  double time_s = 0.0;
  std::variant<CloudSlice, SegmentUpdate, CameraView> message;
};

/// A part of a wall across the camera's view, with a point each centimetre.
inline CloudSlice wall_slice(std::int32_t id, std::int32_t revision, double from_x, double to_x,
                             double z) {
  CloudSlice slice;
  slice.session = kWallSession;
  slice.map_name = "map";
  slice.id = id;
  slice.revision = revision;
  slice.kind = SliceKind::kPatch;
  slice.in_volume = true;
  slice.ends_batch = true;
  slice.resolution_m = 0.01F;
  for (double x = from_x + 0.005; x < to_x; x += 0.01) {
    for (double y = -1.195; y < 1.2; y += 0.01) {
      slice.points_W.push_back(make_point(x, y, z, 0, 0, -1));
    }
  }
  return slice;
}

inline SegmentUpdate labels_of(const CloudSlice& slice, std::uint32_t segment_id) {
  SegmentUpdate update;
  update.session = 9;
  update.map_session = slice.session;
  update.map_name = slice.map_name;
  update.slice_id = slice.id;
  update.slice_revision = slice.revision;
  update.num_slices = 1;
  update.num_points = std::ssize(slice.points_W);
  update.num_segments = 1;
  update.labels.assign(slice.points_W.size(), segment_id);
  return update;
}

/// All points of the slice get another segment.
inline SegmentUpdate relabelled(const CloudSlice& slice, std::uint32_t segment_id) {
  SegmentUpdate update = labels_of(slice, segment_id);
  update.slice_id = 100;  // of a slice without points
  update.slice_revision = 0;
  update.labels.clear();
  update.runs.push_back(
      {slice.id, 0, static_cast<std::int32_t>(slice.points_W.size()), segment_id, slice.revision});
  return update;
}

/// Views ten times a second, of every third frame, from 0 to 10 s.
inline std::vector<BusEvent> watch_wall() {
  std::vector<BusEvent> events;
  for (int i = 0; i <= 100; ++i) {
    CameraView view = view_of_wall(kWallSession, Pose::Identity(), kWall_m);
    view.utime = 1 + std::int64_t{100'000} * i;
    view.frame_index = std::int64_t{3} * i;
    events.push_back({0.1 * i, view});
  }
  return events;
}

inline void in_order_of_time(std::vector<BusEvent>& events) {
  std::ranges::stable_sort(events, {}, &BusEvent::time_s);
}

}  // namespace kintsugi::segmenter::testing
