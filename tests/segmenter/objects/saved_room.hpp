#pragma once
// A toy room as a segmenter saves it, and as a mapper publishes it.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/core/parameters/presets.hpp"
#include "segmenter/io/saved_map.hpp"
#include "segmenter/io/views_file.hpp"
#include "segmenter/map/segment_map.hpp"
#include "segmenter/views/packed_depth.hpp"
#include "tests/segmenter/objects/toy_room.hpp"

namespace kintsugi::segmenter::testing {

inline constexpr double kSavedVoxel_m = 0.03;

/// All of the map in one final slice, which is later than its views.
inline CloudSlice slice_of(const ObservedMap& map, std::int64_t session) {
  CloudSlice slice;
  slice.utime = 1'000'000;
  slice.session = session;
  slice.map_name = "map";
  slice.resolution_m = map.resolution_m;
  slice.points_W = map.points_W;
  return slice;
}

inline CameraView message_of(const MapView& view, std::int64_t session) {
  CameraView message;
  message.utime = view.utime;
  message.session = session;
  message.map_name = "map";
  message.state = TrackingState::kTracking;
  message.X_WC = view.X_WC;
  message.intrinsics = view.intrinsics;
  message.depth_mm = view.depth_mm;
  return message;
}

/// A saved map of the room, and its views.
inline void save(const ToyRoom& room, const std::vector<Pose>& path_S,
                 const std::filesystem::path& file) {
  const ObservedMap map = observe(room, path_S, kSavedVoxel_m);
  const CloudSlice slice = slice_of(map, 5);
  SegmentMapConfig config;
  config.engine = preset("objects");
  SegmentMap segments(config, 1, slice);
  (void)segments.add({&slice, 1});
  write_map_state(segments.state(), file);
  ViewSet views;
  views.map_session = 5;
  views.map_name = "map";
  for (const MapView& view : map.views) {
    KeptView& kept = views.views.emplace_back();
    kept.utime = view.utime;
    kept.X_WC = kept.X_PC = view.X_WC;
    kept.intrinsics = view.intrinsics;
    kept.packed_depth = std::make_shared<const std::vector<std::uint8_t>>(
        pack_depth(view.depth_mm, static_cast<std::size_t>(view.intrinsics.width)));
  }
  write_views(views, views_file_of(file));
}

}  // namespace kintsugi::segmenter::testing
