#include "tests/viewer/support/recorded_room.hpp"

#include <algorithm>
#include <mutex>
#include <stdexcept>

#include <lcm/lcm-cpp.hpp>

#include "lcmtypes/bus/message_subscriber.hpp"
#include "lcmtypes/channels.hpp"

namespace kintsugi::viewer {
namespace {

StreamPublisher::Config unpaced() {
  StreamPublisher::Config config;
  config.rate_bytes_per_s = 1e12;
  return config;
}

/// Sends each pose, then the messages of mapper and segmenter at its time.
template <class SendPose>
void play(const SyntheticMap& map, const Recorded& recorded, StreamPublisher& slices,
          StreamPublisher& updates, StreamPublisher& views, SendPose&& send_pose) {
  std::size_t next_view = 0;
  std::size_t next = 0;
  const auto send_slices_until = [&](std::int64_t utime) {
    for (; next < map.slices.size() && map.slices[next].utime <= utime; ++next) {
      CloudSlice slice = map.slices[next];
      slice.session += recorded.session_offset;
      slices.publish(std::move(slice));
      slices.flush();
      if (!recorded.updates) continue;
      SegmentUpdate update = map.updates[next];
      update.session += recorded.session_offset;
      update.map_session += recorded.session_offset;
      updates.publish(std::move(update));
      updates.flush();
    }
  };
  for (CameraPose pose : map.poses) {
    pose.session += recorded.session_offset;
    send_pose(pose);
    for (; next_view < map.views.size() && map.views[next_view].utime <= pose.utime; ++next_view) {
      CameraView view = map.views[next_view];
      view.session += recorded.session_offset;
      views.publish(std::move(view));
      views.flush();
    }
    send_slices_until(pose.utime);
  }
  send_slices_until(INT64_MAX);
}

}  // namespace

void write_log(const std::filesystem::path& path, const SyntheticMap& map, const Recorded& recorded,
               bool append) {
  lcm::LogFile log(path.string(), append ? "a" : "w");
  if (!log.good()) throw std::runtime_error("cannot write " + path.string());
  std::mutex mutex;
  std::int64_t events = 0;
  const auto write = [&](const std::string& channel, ByteView data) {
    const std::lock_guard lock(mutex);
    std::vector<std::uint8_t> bytes(data.begin(), data.end());
    lcm::LogEvent event{};
    event.eventnum = events++;
    event.timestamp = event.eventnum;
    event.channel = channel;
    event.datalen = static_cast<std::int32_t>(bytes.size());
    event.data = bytes.data();
    log.writeEvent(&event);
  };
  const std::int64_t map_session = map.slices.front().session + recorded.session_offset;
  const std::int64_t segmenter_session = map.updates.front().session + recorded.session_offset;
  StreamPublisher slices(write, channels::kCloudSlice, map_session, unpaced());
  StreamPublisher updates(write, channels::kSegmentUpdate, segmenter_session, unpaced());
  StreamPublisher views(write, channels::kCameraView, map_session, unpaced());
  play(map, recorded, slices, updates, views,
       [&](const CameraPose& pose) { write(channels::kCameraPose, encode(pose)); });
}

RoomOnBus::RoomOnBus(Bus& bus, const SyntheticMap& map)
    : bus_(bus),
      map_(map),
      slices_(bus, channels::kCloudSlice, map.slices.front().session,
              {.map_name = map.slices.front().map_name, .on_state_wanted = {}}, &sent_slices_) {
  slices_.subscribe(bus);
  subscribe<ResendRequest>(bus, channels::kResendRequest,
                           [this](const ResendRequest& request) { updates_->request(request); });
  begin_segmenter(map.updates.front().session);
}

void RoomOnBus::begin_segmenter(std::int64_t session) {
  constexpr std::size_t kStoreBytes =
      1;  // too few to resend updates: late joiners need the full state
  updates_.reset();
  sent_updates_ = std::make_unique<RecentChunks>(kStoreBytes);
  segmenter_session_ = session;
  StreamPublisher::Config config;
  config.on_state_wanted = [this] { is_state_wanted_ = true; };
  updates_ = std::make_unique<StreamPublisher>(bus_, channels::kSegmentUpdate, session, config,
                                               sent_updates_.get());
}

void RoomOnBus::publish(std::size_t count) {
  for (const std::size_t end = num_published_ + count; num_published_ < end; ++num_published_) {
    const CloudSlice& slice = map_.slices[num_published_];
    for (; num_poses_ < map_.poses.size() && map_.poses[num_poses_].utime <= slice.utime;
         ++num_poses_) {
      bus_.publish(channels::kCameraPose, map_.poses[num_poses_]);
    }
    slices_.publish(slice);
    SegmentUpdate update = map_.updates[num_published_];
    update.session = segmenter_session_;
    if (!labels_.empty()) {
      std::vector<std::uint32_t>& before = labels_.back();
      const auto half = static_cast<std::int32_t>(before.size() / 2);
      const auto id = static_cast<std::uint32_t>(1'000 + labels_.size());
      std::fill_n(before.begin(), half, id);
      if (half > 0) update.runs.push_back({slice.id - 1, 0, half, id, 0});
    }
    labels_.push_back(update.labels);
    updates_->publish(std::move(update));
  }
  slices_.flush();
  updates_->flush();
}

std::vector<SegmentUpdate> RoomOnBus::describe() const {
  std::vector<SegmentUpdate> description;
  for (std::size_t i = 0; i < labels_.size(); ++i) {
    SegmentUpdate& update = description.emplace_back(map_.updates[i]);
    update.session = segmenter_session_;
    update.utime = 0;
    update.labels = labels_[i];
    update.num_segments = map_.updates[labels_.size() - 1].num_segments;
  }
  return description;
}

void RoomOnBus::restart_segmenter() {
  begin_segmenter(segmenter_session_ + 1);
  updates_->publish_state(describe());
  updates_->flush();
}

void RoomOnBus::serve() {
  if (labels_.empty() || !is_state_wanted_.exchange(false)) return;
  ++states_sent_;
  updates_->publish_state(describe());
}

void publish(Bus& bus, const SyntheticMap& map) { RoomOnBus(bus, map).publish(map.slices.size()); }

}  // namespace kintsugi::viewer
