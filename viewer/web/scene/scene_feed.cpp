#include "viewer/web/scene/scene_feed.hpp"

#include <algorithm>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "viewer/core/figure/camera_panel.hpp"
#include "viewer/output/picture_file.hpp"

namespace kintsugi::viewer {
namespace {

using Json = nlohmann::json;

template <class Vector>
Json vector_json(const Vector& v) {
  return {v.x(), v.y(), v.z()};
}

/// Translation and quaternion.
Json pose_json(const Pose& X_WA) {
  const Eigen::Quaterniond q(X_WA.linear());
  return {{"t", vector_json(X_WA.translation())}, {"q", {q.x(), q.y(), q.z(), q.w()}}};
}

/// Where the camera is and what it sees; null: it is not known.
Json frustum_json(const CameraTrack& track, const CameraView* view) {
  if (!track.X_WC) return nullptr;
  double half_width = 0.6;  // at 1 m, without a view
  double half_height = 0.45;
  if (view != nullptr && view->intrinsics.fx > 0.0 && view->intrinsics.fy > 0.0) {
    half_width = 0.5 * view->intrinsics.width / view->intrinsics.fx;
    half_height = 0.5 * view->intrinsics.height / view->intrinsics.fy;
  }
  Json json = pose_json(*track.X_WC);
  json["x"] = half_width;
  json["y"] = half_height;
  return json;
}

Json objects_json(const std::vector<DrawnObject>& objects) {
  Json json = Json::array();
  for (const DrawnObject& object : objects) {
    Json entry = pose_json(object.X_WO);
    entry["name"] = object.name;
    entry["confirmed"] = object.is_confirmed;
    entry["box_min_O"] = vector_json(object.box_min_O);
    entry["box_max_O"] = vector_json(object.box_max_O);
    json.push_back(std::move(entry));
  }
  return json;
}

Json loops_json(const std::vector<LoopLink>& loops) {
  Json json = Json::array();
  for (const LoopLink& loop : loops) {
    for (const float x : loop.later_W) json.push_back(x);
    for (const float x : loop.earlier_W) json.push_back(x);
  }
  return json;
}

Eigen::Vector3d mean_normal_W(const SegmentStatistics& s) {
  return {s.mean_normal_W[0], s.mean_normal_W[1], s.mean_normal_W[2]};
}

}  // namespace

void SceneFeed::use(const SegmentUpdate& update) {
  if (update.map_session != map_session_ && update.map_session > map_session_) {
    begin(update.map_session);
  }
  if (update.map_session != map_session_) return;
  table_.apply(update);
  scene_.add(update);
}

void SceneFeed::begin(std::int64_t map_session) {
  map_session_ = map_session;
  tiles_.clear();
  planes_ = SegmentPlanes();
  table_ = SegmentTable();
  segments_.clear();
  view_utime_ = -1;
  scene_.begin(map_session);
}

void SceneFeed::refresh(const MapSession* session, const ViewerStatus& status) {
  constexpr auto kPeriod = std::chrono::milliseconds(500);
  if (session == nullptr || Clock::now() < next_ || !scene_.is_watched()) return;
  const ReceivedMap& map = session->map();
  if (map.map_session() != map_session_) {
    // An older session than that of the newest update is shown no more.
    if (map.map_session() < map_session_) return;
    begin(map.map_session());
  }
  LiveScene::Changes changes;
  collect_tiles(map, changes);
  collect_segments(changes);
  changes.header = header(*session, status);
  for (const std::int32_t part : map.parts()) {
    std::vector<float> path_W;
    for (const Eigen::Vector3f& p_W : map.received_track(part).path_W) {
      path_W.insert(path_W.end(), p_W.data(), p_W.data() + 3);
    }
    scene_.set_path(part, std::move(path_W));
  }
  publish_image(*session);
  scene_.publish(std::move(changes));
  next_ = Clock::now() + kPeriod;
}

void SceneFeed::collect_tiles(const ReceivedMap& map, LiveScene::Changes& changes) {
  map.for_each_shown([&](const MapSlice& slice) {
    const auto found = tiles_.find(slice.id());
    const bool is_new = found == tiles_.end();
    if (slice.points_W().empty()) {
      if (is_new) return;
      changes.removed_tiles.push_back(found->second.tile.id);
      planes_.remove(found->second.tile.id);
      tiles_.erase(found);
      return;
    }
    Published& published = is_new ? tiles_[slice.id()] : found->second;
    if (!update(published, slice, is_new)) return;
    planes_.set(published.tile);
    changes.tiles.push_back(published.tile);
    resolution_m_ = slice.resolution_m();
  });
}

/// True when something of the slice has changed. What has not changed is shared with the tile
/// before.
bool SceneFeed::update(Published& published, const MapSlice& slice, bool is_new) {
  scene::Tile& tile = published.tile;
  const bool new_points = is_new || published.revision != slice.revision();
  const bool new_labels = new_points || published.label_changes != slice.label_changes();
  const bool moved = published.part != slice.part() || !(tile.X_WP == slice.X_WP());
  if (!new_labels && !moved) return false;
  tile.id = static_cast<std::uint32_t>(slice.id());
  tile.part = published.part = slice.part();
  tile.resolution_m = slice.resolution_m();
  tile.X_WP = slice.X_WP();
  if (new_points) {
    published.revision = slice.revision();
    tile.points = std::make_shared<const scene::TilePoints>(
        scene::make_points(slice.points_P(), static_cast<std::uint32_t>(slice.revision())));
  }
  if (new_labels) {
    published.label_changes = slice.label_changes();
    tile.labels = std::make_shared<const scene::TileLabels>(
        scene::make_labels(slice.labels(), ++label_revision_));
  }
  return true;
}

void SceneFeed::collect_segments(LiveScene::Changes& changes) {
  std::set<std::uint32_t> changed = planes_.take_changed();
  for (auto known = segments_.begin(); known != segments_.end();) {
    if (table_.find(known->first) == nullptr) {
      changes.removed_segments.push_back(known->first);
      known = segments_.erase(known);
    } else {
      ++known;
    }
  }
  for (const auto& [id, segment] : table_.segments()) {
    const auto [known, is_new] = segments_.try_emplace(id, segment.sequence);
    if (!is_new && known->second == segment.sequence && !changed.contains(id)) continue;
    known->second = segment.sequence;
    const SegmentStatistics& statistics = segment.statistics;
    changes.segments.emplace_back(
        id, scene::segment_json(statistics,
                                planes_.plane(id, mean_normal_W(statistics), resolution_m_)));
  }
}

void SceneFeed::publish_image(const MapSession& session) {
  constexpr int kJpegQuality = 80;
  const CameraView* const view = session.view();
  if (view == nullptr || view->utime == view_utime_) return;
  view_utime_ = view->utime;
  const cv::Size size = camera_panel_size(*view, {640, 480});
  const auto chunks = session.map().chunks(view->part);
  const cv::Mat3b image =
      draw_camera_panel(chunks, *view, size, {}, session.objects(), {false, splat_});
  scene_.set_image(encode_jpeg(image, kJpegQuality));
}

Json SceneFeed::header(const MapSession& session, const ViewerStatus& status) {
  const ReceivedMap& map = session.map();
  const std::int32_t camera_part = map.camera_part();
  Json parts = Json::array();
  Json loops = Json::array();
  for (const std::int32_t part : map.parts()) {
    parts.push_back({{"part", part},
                     {"points", map.points(part).shown},
                     {"up", vector_json(map.up(part).up_W())}});
    for (Json& x : loops_json(map.received_track(part).loops)) loops.push_back(std::move(x));
  }
  return {{"map", status.map_name},
          {"time_s", 1e-6 * static_cast<double>(map.utime() - map.first_utime())},
          {"points", map.counts().points},
          {"segments", map.counts().segments},
          {"slices", map.counts().slices},
          {"lag", map.lag_slices()},
          {"final", session.is_complete()},
          {"problem", status.problem},
          {"parts", parts},
          {"camera_part", camera_part},
          {"loops", loops},
          {"objects", objects_json(session.objects())},
          {"frustum", frustum_json(map.received_track(camera_part), session.view())}};
}

}  // namespace kintsugi::viewer
