#pragma once

#include <chrono>
#include <cstdint>
#include <map>

#include "lcmtypes/client/segment_table.hpp"
#include "lcmtypes/statuses.hpp"
#include "viewer/core/rendering/splat.hpp"
#include "viewer/session/map_session.hpp"
#include "viewer/web/scene/live_scene.hpp"
#include "viewer/web/scene/segment_planes.hpp"

namespace kintsugi::viewer {

/// Brings a map session into a LiveScene: what has changed since it did so last. It works for the
/// thread that draws, which alone may read the session. Costs time for what has changed, and
/// nothing while nobody looks.
class SceneFeed {
 public:
  SceneFeed(LiveScene& scene, const SplatConfig& splat) : scene_(scene), splat_(splat) {}

  /// Every update of the segmenter, before or after the map has used it.
  void use(const SegmentUpdate& update);

  /// Call often: it does something at most twice a second. `session`: nullptr when there is none.
  void refresh(const MapSession* session, const ViewerStatus& status);

 private:
  using Clock = std::chrono::steady_clock;

  /// What the scene has of a slice.
  struct Published {
    std::int32_t revision = 0;
    std::uint64_t label_changes = 0;
    std::int32_t part = 0;
    scene::Tile tile;
  };

  void begin(std::int64_t map_session);
  void collect_tiles(const ReceivedMap& map, LiveScene::Changes& changes);
  bool update(Published& published, const MapSlice& slice, bool is_new);
  void collect_segments(LiveScene::Changes& changes);
  void publish_image(const MapSession& session);
  static nlohmann::json header(const MapSession& session, const ViewerStatus& status);

  LiveScene& scene_;
  SplatConfig splat_;
  std::int64_t map_session_ = 0;
  Clock::time_point next_ = Clock::time_point::min();
  std::uint32_t label_revision_ = 0;
  std::map<std::int32_t, Published> tiles_;  // by slice id
  float resolution_m_ = 0.0F;
  SegmentPlanes planes_;
  SegmentTable table_;
  std::map<std::uint32_t, std::int64_t> segments_;  // published: the sequence of their update
  std::int64_t view_utime_ = -1;                    // of the image that the scene has
};

}  // namespace kintsugi::viewer
