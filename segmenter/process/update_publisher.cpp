#include "segmenter/process/update_publisher.hpp"

#include <exception>
#include <utility>

#include <spdlog/spdlog.h>

#include "lcmtypes/channels.hpp"

namespace kintsugi::segmenter {

UpdatePublisher::UpdatePublisher(Bus* bus, std::int64_t session,
                                 const StreamPublisher::Config& config) {
  config.validate();
  if (bus != nullptr) {
    stream_ = std::make_unique<StreamPublisher>(*bus, channels::kSegmentUpdate, session, config);
  }
}

void UpdatePublisher::publish(SegmentUpdate update) {
  if (stream_) {
    try_to([&] { stream_->publish(std::move(update)); });
  }
}

void UpdatePublisher::flush() {
  if (stream_) {
    try_to([&] { stream_->flush(); });
  }
}

bool UpdatePublisher::is_idle() const { return !stream_ || stream_->queued_bytes() == 0; }

template <class Action>
void UpdatePublisher::try_to(const Action& action) {
  try {
    action();
  } catch (const std::exception& error) {
    const std::lock_guard lock(mutex_);
    if (problem_.empty()) {  // all that comes after it fails likewise
      problem_ = std::string("an update is not published: ") + error.what();
      spdlog::error("{}", problem_);
    }
  }
}

std::string UpdatePublisher::problem() const {
  const std::lock_guard lock(mutex_);
  return problem_;
}

}  // namespace kintsugi::segmenter
