#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "lcmtypes/messages.hpp"
#include "lcmtypes/scene/tile.hpp"
#include "viewer/core/map/update_log.hpp"
#include "viewer/web/scene/versioned_map.hpp"

namespace kintsugi::viewer {

/// What browsers are shown of a map. Thread-safe: one thread publishes, any number of others ask.
/// Tiles are immutable and shared, so a lock is held only while pointers are copied.
///
/// Everything has a version, a number that grows. An epoch is one map session: a client that knows
/// another epoch gets everything.
class LiveScene {
 public:
  /// What has changed since the last call of publish().
  struct Changes {
    std::vector<scene::Tile> tiles;
    std::vector<std::uint32_t> removed_tiles;
    std::vector<std::pair<std::uint32_t, nlohmann::ordered_json>> segments;
    std::vector<std::uint32_t> removed_segments;
    nlohmann::json header;  ///< of the state: an object
  };
  /// Points [first, first + count) of a tile.
  struct Want {
    std::uint32_t tile = 0;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };

  // The thread that publishes:
  void begin(std::int64_t epoch);  ///< forgets everything
  void publish(Changes changes);
  void set_image(std::vector<std::uint8_t> jpeg);
  /// The camera's path in a part of the map: x y z x y z ..., metres, W.
  void set_path(std::int32_t part, std::vector<float> positions_W);
  void add(const SegmentUpdate& update);
  /// Somebody has asked within the last 10 s.
  bool is_watched() const;

  // Any thread. Texts are JSON.
  /// The header, and the tiles that have changed since `since` of `epoch`.
  std::string state(std::int64_t epoch, std::uint64_t since);
  std::string segments(std::int64_t epoch, std::uint64_t since) const;
  /// Neighbours and timeline of a segment; nothing: no segment of this id has been heard of.
  std::optional<std::string> segment(std::uint32_t segment_id);
  /// Blocks (scene::append_block) of those tiles that exist.
  std::string blocks(const std::vector<Want>& wants, bool with_points) const;
  std::vector<float> path(std::int32_t part) const;  ///< empty: there is none
  std::vector<std::uint8_t> image() const;           ///< JPEG; empty: there is none

 private:
  using Clock = std::chrono::steady_clock;

  nlohmann::json timeline(std::uint32_t segment_id) const;

  mutable std::mutex mutex_;  // of everything but what follows its own below
  std::int64_t epoch_ = 0;
  std::uint64_t version_ = 0;
  std::uint64_t segments_version_ = 0;
  std::uint64_t image_version_ = 0;
  std::uint64_t path_version_ = 0;
  nlohmann::json header_ = nlohmann::json::object();
  VersionedMap<std::uint32_t, scene::Tile> tiles_;
  VersionedMap<std::uint32_t, nlohmann::ordered_json> segments_;
  std::map<std::int32_t, std::vector<float>> paths_;
  std::vector<std::uint8_t> image_;

  mutable std::mutex log_mutex_;
  UpdateLog log_;

  std::mutex heavy_mutex_;  // one search for neighbours at a time
  std::atomic<Clock::rep> last_question_ = Clock::time_point::min().time_since_epoch().count();
};

}  // namespace kintsugi::viewer
