#include "segmenter/objects/maps/observed_map_file.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/log/whole_log_reader.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"
#include "segmenter/core/parameters/presets.hpp"
#include "segmenter/evaluation/session/session_log.hpp"
#include "segmenter/io/saved_map.hpp"
#include "segmenter/io/views_file.hpp"
#include "segmenter/map/segment_map.hpp"
#include "segmenter/views/view_record.hpp"

namespace kintsugi::segmenter {
namespace {

bool is_saved_map(const std::filesystem::path& path) {
  constexpr std::string_view kBeginning = "KSEGMAP";
  std::array<char, kBeginning.size()> bytes{};
  std::ifstream(path, std::ios::binary).read(bytes.data(), std::ssize(bytes));
  return std::string_view(bytes.data(), bytes.size()) == kBeginning;
}

using PlacesOfPatches = std::map<std::int32_t, PatchPlace>;

/// Where the slices of a map, and patches that corrections have named, are.
PlacesOfPatches places_in(const SegmentMapState& state) {
  PlacesOfPatches places = state.motions.places();
  for (const SliceRecord& slice : state.slices) places[slice.slice_id] = slice.place;
  return places;
}

/// The part of the map with most points, of equal ones the first.
std::int32_t largest_part(const SegmentMapState& state) {
  std::map<std::int32_t, std::size_t> points;
  for (const SliceRecord& slice : state.slices) points[slice.place.part] += slice.count;
  const auto largest =
      std::ranges::max_element(points, {}, [](const auto& part) { return part.second; });
  return largest == points.end() ? 0 : largest->first;
}

void take_points(const SegmentMapState& state, std::int32_t part, ObservedMap& map) {
  map.points_W.reserve(state.points_W.size());
  map.segment_ids.reserve(state.points_W.size());
  // By id, as who follows the map on the bus has them: both find the same to the last digit.
  std::vector<SliceRecord> slices = state.slices;
  std::ranges::sort(slices, {}, &SliceRecord::slice_id);
  for (const SliceRecord& slice : slices) {
    if (slice.place.part != part) continue;
    for (std::size_t i = slice.first; i < std::size_t{slice.first} + slice.count; ++i) {
      map.points_W.push_back(state.points_W[i]);
      map.segment_ids.push_back(state.segment_ids[i]);
    }
  }
}

void take_views(const ViewSet& views, const PlacesOfPatches& places, std::int32_t part,
                ObservedMap& map) {
  const PlaceOfPatch place_of = [&](std::int32_t patch) -> std::optional<PatchPlace> {
    const auto found = places.find(patch);
    return found == places.end() ? std::nullopt : std::optional(found->second);
  };
  for (const KeptView& view : views.views) {
    const auto place = place_of(view.patch);
    if ((place ? place->part : view.part) == part) map.views.push_back(unpacked(view, place_of));
  }
}

ObservedMap map_of(const SegmentMapState& state, const ViewSet& views,
                   const std::filesystem::path& path) {
  if (state.points_W.empty()) throw std::runtime_error("'" + path.string() + "' has no points");
  ObservedMap map;
  map.source = path.string();
  map.map_name = state.map_name;
  map.map_session = state.map_session;
  map.resolution_m = static_cast<float>(state.config.engine.resolution_m);
  map.config = state.config;
  const std::int32_t part = largest_part(state);
  take_points(state, part, map);
  take_views(views, places_in(state), part, map);
  return map;
}

ObservedMap read_saved(const std::filesystem::path& path) {
  const SegmentMapState state = read_map_state(path);
  const std::filesystem::path views_path = views_file_of(path);
  ViewSet views;
  if (std::filesystem::exists(views_path)) {
    views = read_views_of(views_path, state.map_session, state.map_name);
  }
  return map_of(state, views, path);
}

/// The views of one session, moved by all its corrections.
ViewSet views_in_log(const std::filesystem::path& path, std::int64_t map_session,
                     const std::string& map_name) {
  ViewRecord record(map_session, map_name);
  const auto read_all = [&]<class Message>(const char* channel, std::type_identity<Message>) {
    StreamSubscriber<Message> stream(channel, [&](const Message& message) {
      if (message.session == map_session) record.add(message);
    });
    WholeLogReader log(path);
    while (const auto event = log.next()) {
      if (event->channel == channel) stream.handle(event->channel, event->data);
    }
  };
  // First all views: each waits for the slice that is later than it is.
  read_all(channels::kCameraView, std::type_identity<CameraView>());
  read_all(channels::kCloudSlice, std::type_identity<CloudSlice>());
  return record.views();
}

ObservedMap read_log(const std::filesystem::path& path, const SegmentMapConfig& config) {
  const RecordedSession session = read_session_log(path);
  std::vector<CloudSlice> slices;  // where the corrections, which are left out, have put them
  for (const CloudSlice* slice : session.newest_slices()) {
    if (slice->kind != SliceKind::kCorrection) slices.push_back(*slice);
  }
  SegmentMap map(config, 1, slices.front());
  (void)map.add(slices);
  const SegmentMapState state = map.state();
  ViewSet views = views_in_log(path, map.map_session(), map.map_name());
  // The patches are in W here, so the views are put where they are.
  for (KeptView& view : views.views) view.patch = KeptView::kNoPatch;
  return map_of(state, views, path);
}

}  // namespace

SegmentMapConfig default_map_config() {
  SegmentMapConfig config;
  config.engine = preset("objects");
  return config;
}

ObservedMap read_observed_map(const std::filesystem::path& path, const SegmentMapConfig& config) {
  return is_saved_map(path) ? read_saved(path) : read_log(path, config);
}

}  // namespace kintsugi::segmenter
