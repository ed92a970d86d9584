#include "mapper/process/guest_receiver.hpp"

#include <utility>

#include "lcmtypes/base/logger.hpp"
#include "lcmtypes/channels.hpp"

namespace kintsugi::mapper {
namespace {

void log_bad(const DecodeError& reason) {
  spdlog::debug("a message of a guest was dropped: {}", reason.what());
}

}  // namespace

GuestReceiver::GuestReceiver(const std::string& lcm_url, std::string map_name, std::int64_t session)
    : map_name_(std::move(map_name)),
      session_(session),
      bus_(lcm_url),
      keyframes_(
          channels::kKeyframe, [this](KeyframeMessage keyframe) { receive(std::move(keyframe)); },
          log_bad,
          [&] {
            StreamSubscriberConfig<KeyframeMessage> config;
            config.receiver = session;
            config.wanted_map_name = map_name_;  // its heartbeats name the map that is joined
            config.wanted = [this](const KeyframeMessage& header) {
              return header.join == map_name_ && header.session != session_;
            };
            return config;
          }()) {
  keyframes_.subscribe(bus_);
  thread_ = std::make_unique<BusThread>(bus_, [this] { ask(); });
}

GuestReceiver::News GuestReceiver::take() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(news_, {});
}

void GuestReceiver::receive(KeyframeMessage keyframe) {
  found_[keyframe.session] = keyframe.map_name;
  const std::scoped_lock lock(mutex_);
  news_.keyframes.push_back(std::move(keyframe));
}

void GuestReceiver::subscribe_to_slices(std::int64_t guest, const std::string& map_name) {
  if (slices_.empty()) {
    bus_.subscribe(channels::kCloudSlice, [this](ByteView message) { receive_slice(message); });
    bus_.subscribe(channels::kHeartbeat, [this](ByteView message) { hear(message); });
  }
  StreamSubscriberConfig<CloudSlice> config;
  config.receiver = session_;
  config.wanted_map_name = map_name;
  config.wanted = [guest](const CloudSlice& header) { return header.session == guest; };
  slices_[guest] = std::make_unique<StreamSubscriber<CloudSlice>>(
      channels::kCloudSlice,
      [this](CloudSlice slice) {
        const std::scoped_lock lock(mutex_);
        news_.slices.push_back(std::move(slice));
      },
      log_bad, config);
}

void GuestReceiver::receive_slice(ByteView message) {
  for (auto& [guest, slices] : slices_) slices->handle(channels::kCloudSlice, message);
}

void GuestReceiver::hear(ByteView heartbeat) {
  for (auto& [guest, slices] : slices_) slices->handle(channels::kHeartbeat, heartbeat);
}

void GuestReceiver::ask() {
  for (const auto& [guest, map_name] : std::exchange(found_, {})) {
    if (!slices_.contains(guest)) subscribe_to_slices(guest, map_name);
  }
  const double now_s = clock_.now_s();
  keyframes_.ask(bus_, now_s);
  for (auto& [guest, slices] : slices_) slices->ask(bus_, now_s);
}

}  // namespace kintsugi::mapper
