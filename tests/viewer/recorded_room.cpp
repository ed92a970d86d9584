#include "tests/viewer/recorded_room.hpp"

#include <mutex>
#include <stdexcept>

#include <lcm/lcm-cpp.hpp>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/stream_publisher.hpp"

namespace kintsugi::viewer {
namespace {

StreamPublisher::Config unpaced() {
  StreamPublisher::Config config;
  config.rate_bytes_per_s = 1e12;
  return config;
}

/// Sends each pose, then what the mapper and the segmenter said at its time.
template <class SendPose>
void play(const SyntheticMap& map, const Recorded& recorded, StreamPublisher& slices,
          StreamPublisher& updates, SendPose&& send_pose) {
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
  play(map, recorded, slices, updates,
       [&](const CameraPose& pose) { write(channels::kCameraPose, encode(pose)); });
}

void publish(Bus& bus, const SyntheticMap& map) {
  StreamPublisher slices(bus, channels::kCloudSlice, map.slices.front().session, {});
  StreamPublisher updates(bus, channels::kSegmentUpdate, map.updates.front().session, {});
  play(map, {}, slices, updates,
       [&](const CameraPose& pose) { bus.publish(channels::kCameraPose, pose); });
}

}  // namespace kintsugi::viewer
