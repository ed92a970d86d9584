#include "viewer/web/scene/live_scene.hpp"

#include "lcmtypes/base/json_text.hpp"
#include "lcmtypes/scene/scene_json.hpp"
#include "viewer/core/charts/segment_timeline.hpp"
#include "viewer/web/scene/neighbours.hpp"

namespace kintsugi::viewer {
namespace {

using Json = nlohmann::json;

const char* name_of(SegmentTimeline::EventType type) {
  using Type = SegmentTimeline::EventType;
  switch (type) {
    case Type::kCreated:
      return "created";
    case Type::kSplitOff:
      return "split off";
    case Type::kAbsorbed:
      return "absorbed";
    case Type::kSplit:
      return "lost a part:";
    case Type::kMergedInto:
      return "merged into";
    case Type::kRetired:
      return "retired";
  }
  return "";
}

}  // namespace

void LiveScene::begin(std::int64_t epoch) {
  const std::scoped_lock lock(mutex_, log_mutex_);
  epoch_ = epoch;
  ++version_;
  segments_version_ = image_version_ = path_version_ = 0;
  header_ = Json::object();
  tiles_.clear();
  segments_.clear();
  paths_.clear();
  image_.clear();
  log_ = UpdateLog();
}

void LiveScene::publish(Changes changes) {
  const std::scoped_lock lock(mutex_);
  ++version_;
  header_ = std::move(changes.header);
  for (scene::Tile& tile : changes.tiles) {
    const std::uint32_t id = tile.id;
    tiles_.set(id, std::move(tile), version_);
  }
  for (const std::uint32_t id : changes.removed_tiles) tiles_.remove(id, version_);
  for (auto& [id, json] : changes.segments) segments_.set(id, std::move(json), version_);
  for (const std::uint32_t id : changes.removed_segments) segments_.remove(id, version_);
  if (!changes.segments.empty() || !changes.removed_segments.empty()) segments_version_ = version_;
}

void LiveScene::set_image(std::vector<std::uint8_t> jpeg) {
  const std::scoped_lock lock(mutex_);
  image_ = std::move(jpeg);
  image_version_ = ++version_;
}

void LiveScene::set_path(std::int32_t part, std::vector<float> positions_W) {
  const std::scoped_lock lock(mutex_);
  std::vector<float>& path = paths_[part];
  if (path == positions_W) return;
  path = std::move(positions_W);
  path_version_ = ++version_;
}

void LiveScene::add(const SegmentUpdate& update) {
  const std::scoped_lock lock(log_mutex_);
  log_.add(update);
}

bool LiveScene::is_watched() const {
  constexpr auto kPatience = std::chrono::seconds(10);
  const Clock::time_point last{Clock::duration(last_question_.load())};
  return last != Clock::time_point::min() && Clock::now() - last < kPatience;
}

std::string LiveScene::state(std::int64_t epoch, std::uint64_t since) {
  last_question_ = Clock::now().time_since_epoch().count();
  Json json;
  Json tiles = Json::array();
  Json removed = Json::array();
  {
    const std::scoped_lock lock(mutex_);
    if (epoch != epoch_ || since > version_) since = 0;
    json = header_;
    json["epoch"] = epoch_;
    json["version"] = version_;
    json["segments_version"] = segments_version_;
    json["image_version"] = image_version_;
    json["path_version"] = path_version_;
    tiles_.for_each_since(since, [&](std::uint32_t id, const scene::Tile* tile) {
      if (tile != nullptr) tiles.push_back(scene::tile_json(*tile));
      if (tile == nullptr && since > 0) removed.push_back(id);
    });
  }
  json["tiles"] = std::move(tiles);
  json["removed"] = std::move(removed);
  return json_text(json);
}

std::string LiveScene::segments(std::int64_t epoch, std::uint64_t since) const {
  nlohmann::ordered_json segments = Json::array();
  Json removed = Json::array();
  {
    const std::scoped_lock lock(mutex_);
    if (epoch != epoch_ || since > version_) since = 0;
    segments_.for_each_since(since, [&](std::uint32_t id, const nlohmann::ordered_json* json) {
      if (json != nullptr) segments.push_back(*json);
      if (json == nullptr && since > 0) removed.push_back(id);
    });
  }
  nlohmann::ordered_json json;
  json["segments"] = std::move(segments);
  json["removed"] = removed;
  return json_text(json);
}

std::optional<std::string> LiveScene::segment(std::uint32_t segment_id) {
  const std::scoped_lock one_at_a_time(heavy_mutex_);
  std::vector<scene::Tile> tiles;
  bool is_here = false;
  {
    const std::scoped_lock lock(mutex_);
    is_here = segments_.find(segment_id) != nullptr;
    if (is_here) {
      tiles_.for_each_since(0, [&](std::uint32_t, const scene::Tile* tile) {
        if (tile != nullptr) tiles.push_back(*tile);
      });
    }
  }
  Json history = timeline(segment_id);
  if (!is_here && history.is_null()) return std::nullopt;
  constexpr std::size_t kMostNeighbours = 100;
  Json neighbours = Json::array();
  for (const Neighbour& neighbour : neighbours_of(tiles, segment_id)) {
    if (neighbours.size() == kMostNeighbours) break;
    neighbours.push_back({neighbour.segment_id, neighbour.contacts});
  }
  return Json{{"neighbours", neighbours}, {"timeline", history}}.dump();
}

Json LiveScene::timeline(std::uint32_t segment_id) const {
  const std::scoped_lock lock(log_mutex_);
  const SegmentTimeline timeline = timeline_of(segment_id, log_);
  if (!timeline.is_known()) return nullptr;
  Json sizes = Json::array();
  for (const auto& size : timeline.sizes) sizes.push_back({size.num_slices, size.num_points});
  Json events = Json::array();
  for (const auto& event : timeline.events) {
    events.push_back({event.num_slices, name_of(event.type), event.other_id});
  }
  return {{"slices", timeline.num_slices}, {"sizes", sizes}, {"events", events}};
}

std::string LiveScene::blocks(const std::vector<Want>& wants, bool with_points) const {
  std::vector<std::pair<scene::Tile, Want>> found;
  {
    const std::scoped_lock lock(mutex_);
    for (const Want& want : wants) {
      const scene::Tile* const tile = tiles_.find(want.tile);
      if (tile != nullptr) found.emplace_back(*tile, want);
    }
  }
  std::string bytes;
  for (const auto& [tile, want] : found) {
    scene::append_block(tile, want.first, want.count, with_points, bytes);
  }
  return bytes;
}

std::vector<float> LiveScene::path(std::int32_t part) const {
  const std::scoped_lock lock(mutex_);
  const auto found = paths_.find(part);
  return found == paths_.end() ? std::vector<float>() : found->second;
}

std::vector<std::uint8_t> LiveScene::image() const {
  const std::scoped_lock lock(mutex_);
  return image_;
}

}  // namespace kintsugi::viewer
