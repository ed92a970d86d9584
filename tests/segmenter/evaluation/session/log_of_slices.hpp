#pragma once
// An LCM log of a mapper session, for tests.

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/codec/codec.hpp"
#include "lcmtypes/stream/stream_publisher.hpp"

namespace kintsugi::segmenter::testing {

using LogMessages = std::vector<std::pair<std::string, Bytes>>;

/// Chunks of the slices, as a mapper sends them: several for each slice.
inline void append_slices(const std::vector<CloudSlice>& slices, LogMessages& messages) {
  StreamPublisher::Config config;
  config.rate_bytes_per_s = 1e12;  // nobody to overrun
  config.max_chunk_bytes = 2000;
  StreamPublisher publisher(
      [&](const std::string& channel, ByteView message) {
        messages.emplace_back(channel, Bytes(message.begin(), message.end()));
      },
      channels::kCloudSlice, slices.front().session, config);
  for (const CloudSlice& slice : slices) publisher.publish(slice);
  publisher.flush();
}

/// A tracked pose at (x_m, 0, 0).
inline CameraPose pose_at(double x_m, std::int64_t utime, std::int64_t session = 5) {
  CameraPose pose;
  pose.utime = utime;
  pose.session = session;
  pose.state = TrackingState::kTracking;
  pose.X_WC.translation().x() = x_m;
  return pose;
}

inline void append_pose(const CameraPose& pose, LogMessages& messages) {
  messages.emplace_back(channels::kCameraPose, encode(pose));
}

inline void write_log(const std::filesystem::path& path, const LogMessages& messages) {
  lcm::LogFile log(path.string(), "w");
  std::int64_t utime = 0;
  for (const auto& [channel, message] : messages) {
    lcm::LogEvent event;
    event.timestamp = ++utime;
    event.channel = channel;
    event.datalen = static_cast<std::int32_t>(message.size());
    event.data = const_cast<std::uint8_t*>(message.data());  // NOLINT: LCM does not write to it
    log.writeEvent(&event);
  }
}

}  // namespace kintsugi::segmenter::testing
