#include "segmenter/process/update_publisher.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <stdexcept>
#include <thread>
#include <utility>

#include "lcmtypes/base/logger.hpp"
#include "lcmtypes/channels.hpp"

namespace kintsugi::segmenter {

void UpdatePublisher::Config::validate() const {
  StreamPublisher::Config stream;
  stream.rate_bytes_per_s = rate_bytes_per_s;
  stream.validate();
  if (!(min_state_period_s >= 0.0)) {
    throw std::invalid_argument("min_state_period_s is " + std::to_string(min_state_period_s) +
                                ", must be >= 0");
  }
}

UpdatePublisher::UpdatePublisher(Bus* bus, std::int64_t session, const Config& config)
    : config_((config.validate(), config)), store_(config.min_store_bytes) {
  if (bus == nullptr) {
    return;
  }
  StreamPublisher::Config stream;
  stream.rate_bytes_per_s = config.rate_bytes_per_s;
  stream.max_chunk_bytes = bus->max_message_bytes();
  stream.map_name = config.map_name;
  stream.on_state_wanted = [this] { is_state_wanted_ = true; };
  stream_ =
      std::make_unique<StreamPublisher>(*bus, channels::kSegmentUpdate, session, stream, &store_);
}

void UpdatePublisher::subscribe(Bus& bus) {
  if (stream_) {
    stream_->subscribe(bus);
  }
}

void UpdatePublisher::publish(SegmentUpdate update) {
  if (stream_) {
    wait_for_room();
    try_to([&] { stream_->publish(std::move(update)); });
  }
}

bool UpdatePublisher::take_state_request(double now_s) {
  return is_state_wanted_.exchange(false) && now_s >= next_state_s_;
}

void UpdatePublisher::publish_state(std::vector<SegmentUpdate> updates, double now_s) {
  if (!stream_ || updates.empty()) {
    return;
  }
  std::int64_t bytes = 0;
  for (const SegmentUpdate& update : updates) {
    bytes += payload_bytes(update);
  }
  const double sending_s = static_cast<double>(bytes) / config_.rate_bytes_per_s;
  next_state_s_ = now_s + std::max(config_.min_state_period_s, 2.0 * sending_s);
  store_.set_max_bytes(std::max(config_.min_store_bytes, 2 * static_cast<std::size_t>(bytes)));
  try_to([&] { stream_->publish_state(std::move(updates)); });
  ++num_states_;
  state_bytes_ = bytes;
}

void UpdatePublisher::flush() {
  if (stream_) {
    try_to([&] { stream_->flush(); });
  }
}

UpdatePublisher::Counts UpdatePublisher::counts() const {
  return {stream_ ? stream_->counts() : StreamPublisherCounts{}, num_states_, state_bytes_};
}

double UpdatePublisher::time_since_request_s() const {
  return stream_ ? stream_->time_since_request_s() : 0.0;
}

void UpdatePublisher::wait_for_room() const {
  while (queued_bytes() > config_.max_queued_bytes && problem().empty()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

template <class Action>
void UpdatePublisher::try_to(const Action& action) {
  try {
    action();
  } catch (const std::exception& error) {
    const std::lock_guard lock(mutex_);
    if (problem_.empty()) {  // those after it fail for the same reason
      problem_ = std::string("an update was not published: ") + error.what();
      spdlog::error("{}", problem_);
    }
  }
}

std::string UpdatePublisher::problem() const {
  const std::lock_guard lock(mutex_);
  return problem_;
}

}  // namespace kintsugi::segmenter
