#include "segmenter/library/map_follower.hpp"

#include <algorithm>
#include <utility>

#include "lcmtypes/bus/message_subscriber.hpp"
#include "lcmtypes/channels.hpp"

namespace kintsugi::segmenter {

MapFollower::MapFollower(const MapClientOptions& options)
    : options_(options),
      listener_(options.map_name, [this](const SegmentUpdate& update) { use(update); }),
      slices_(
          channels::kCloudSlice, [this](CloudSlice slice) { use(std::move(slice)); }, {},
          [&] {
            StreamSubscriberConfig<CloudSlice> config;
            config.receiver = new_session();
            config.wanted_map_name = options.map_name;
            config.wanted = [this](const CloudSlice& header) { return is_wanted(header); };
            return config;
          }()) {}

void MapFollower::subscribe(Bus& bus) {
  listener_.subscribe(bus);
  if (options_.with_points) slices_.subscribe(bus);
  kintsugi::subscribe<CameraPose>(bus, channels::kCameraPose,
                                  [this](const CameraPose& pose) { use(pose); });
  kintsugi::subscribe<ObjectDetection>(
      bus, channels::kObjectDetection,
      [this](const ObjectDetection& detection) { use(detection); });
  kintsugi::subscribe<DetectorStatus>(bus, channels::kDetectorStatus,
                                      [this](const DetectorStatus& status) { use(status); });
}

void MapFollower::ask(Bus& bus, double now_s) {
  now_s_ = now_s;
  listener_.ask(bus, now_s);
  if (options_.with_points) slices_.ask(bus, now_s);
}

void MapFollower::handle(const std::string& channel, ByteView message, double now_s) {
  now_s_ = now_s;
  listener_.handle(channel, message);
  if (options_.with_points) slices_.handle(channel, message);
  try {
    if (channel == channels::kCameraPose) use(decode<CameraPose>(message));
    if (channel == channels::kObjectDetection) use(decode<ObjectDetection>(message));
    if (channel == channels::kDetectorStatus) use(decode<DetectorStatus>(message));
  } catch (const DecodeError&) {  // as one that was lost
  }
}

/// 0: nothing was received.
std::int64_t MapFollower::current_session() const {
  if (const SegmentUpdate* const newest = listener_.table().newest()) return newest->map_session;
  return sessions_.empty() ? 0 : sessions_.rbegin()->first;
}

bool MapFollower::is_wanted(const CloudSlice& header) const {
  if (const SegmentUpdate* const newest = listener_.table().newest()) {
    return header.map_name == newest->map_name && header.session >= newest->map_session;
  }
  return options_.map_name.empty() || header.map_name == options_.map_name;
}

void MapFollower::use(CloudSlice slice) {
  const std::int64_t id = slice.session;
  Session& session = sessions_[id];
  session.map_name = slice.map_name;
  session.resolution_m = slice.resolution_m;
  std::set<std::int32_t> changed;
  session.pieces.add(std::move(slice), changed);
  follow_current();
  if (id == followed_session_) changed_pieces_.merge(changed);
}

void MapFollower::use(const SegmentUpdate& update) {
  changes_.updates.push_back(update);
  Session& session = sessions_[update.map_session];
  session.map_name = update.map_name;
  follow_current();
  if (options_.with_points) session.pieces.apply(update, changed_pieces_);
  if (sessions_.size() > 1) forget_others();
}

/// Of a session that is followed from now on, pieces and poses may have come before that was known.
void MapFollower::follow_current() {
  if (followed_session_ == current_session()) return;
  followed_session_ = current_session();
  const std::vector<std::int32_t> ids = pieces().ids();
  changed_pieces_ = {ids.begin(), ids.end()};
  camera_.reset();
  for (const CameraPose& pose : std::exchange(early_poses_, {})) use(pose);
}

void MapFollower::use(const CameraPose& pose) {
  if (pose.session > followed_session_) {
    if (early_poses_.size() == kMaxEarlyPoses) early_poses_.pop_front();
    early_poses_.push_back(pose);
  }
  if (pose.session != followed_session_) return;
  camera_ = pose;
  changes_.poses.push_back(pose);
}

/// What comes before the first update, which tells the map, is repeated.
void MapFollower::use(const ObjectDetection& detection) {
  const SegmentUpdate* const newest = listener_.table().newest();
  if (newest == nullptr || detection.map_name != newest->map_name) return;
  objects_.apply(detection, now_s_);
}

void MapFollower::use(const DetectorStatus& status) {
  const SegmentUpdate* const newest = listener_.table().newest();
  if (newest == nullptr || status.map_name != newest->map_name) return;
  objects_.hear_sender(status.map_session, status.session, now_s_);
}

std::vector<ObjectDetection> MapFollower::objects() const {
  return objects_.map_session() == current_session() ? objects_.present()
                                                     : std::vector<ObjectDetection>{};
}

/// Other maps, and earlier sessions of this one. A newer session has no segments yet.
void MapFollower::forget_others() {
  const SegmentUpdate& newest = *listener_.table().newest();
  std::erase_if(sessions_, [&](const auto& entry) {
    const auto& [id, session] = entry;
    const bool is_other = id < newest.map_session || session.map_name != newest.map_name;
    if (is_other) slices_.forget(id);
    return is_other;
  });
}

MapChanges MapFollower::take_changes() {
  changes_.pieces.assign(changed_pieces_.begin(), changed_pieces_.end());
  changed_pieces_.clear();
  return std::exchange(changes_, {});
}

bool MapFollower::has_changes() const {
  return !changes_.updates.empty() || !changes_.poses.empty() || !changed_pieces_.empty();
}

const FollowedPieces& MapFollower::pieces() const {
  static const FollowedPieces kNone;
  const auto found = sessions_.find(current_session());
  return found != sessions_.end() ? found->second.pieces : kNone;
}

float MapFollower::resolution_m() const {
  const auto found = sessions_.find(current_session());
  return found != sessions_.end() ? found->second.resolution_m : 0.0F;
}

bool MapFollower::lacks_slices() const {
  return options_.with_points &&
         std::ranges::any_of(slices_.gaps(), [session = current_session()](const StreamGap& gap) {
           return gap.session == session;
         });
}

bool MapFollower::has_slices() const {
  return !lacks_slices() || slices_.has_given_up(current_session());
}

std::string MapFollower::problem() const {
  if (const std::string problem = listener_.problem(); !problem.empty()) return problem;
  if (const std::ptrdiff_t count = pieces().num_without_points(); count > 0) {
    return "the points of " + std::to_string(count) + " pieces are missing";
  }
  if (!lacks_slices()) return "";
  return "slices are missing: points may be missing, or be where they were before a correction";
}

std::string MapFollower::dropped() const {
  const std::int64_t num_bad = slices_.counts().messages_bad;
  if (num_bad == 0) return listener_.dropped();
  const std::string bad = "slices dropped: " + std::to_string(num_bad);
  return listener_.dropped().empty() ? bad : bad + "; " + listener_.dropped();
}

}  // namespace kintsugi::segmenter
