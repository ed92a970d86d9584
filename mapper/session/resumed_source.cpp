#include "mapper/session/resumed_source.hpp"

#include <stdexcept>
#include <utility>

namespace kintsugi::mapper {

ResumedSource::ResumedSource(std::unique_ptr<FrameSource> recording,
                             std::vector<std::int64_t> mapped_utimes, bool ends_there)
    : recording_(std::move(recording)),
      mapped_utimes_(std::move(mapped_utimes)),
      ends_there_(ends_there) {}

std::optional<RgbdFrame> ResumedSource::next() {
  if (ends_there_ && all_given()) return std::nullopt;
  while (auto frame = recording_->next()) {
    if (all_given()) return frame;
    const std::int64_t expected = mapped_utimes_[num_given_];
    if (frame->utime > expected) {
      throw std::runtime_error("the session to resume has mapped a frame at " +
                               std::to_string(expected) +
                               " us that the device does not give: resume with the same device");
    }
    if (frame->utime == expected) {
      ++num_given_;
      return frame;
    }
    ++num_skipped_;
  }
  return std::nullopt;
}

SourceStatus ResumedSource::status() const {
  SourceStatus status = recording_->status();
  status.counts.frames_delivered -= num_skipped_;
  status.counts.frames_dropped += num_skipped_;
  if (ends_there_ && all_given()) {
    status.end_reason = "the session was ended here";
    status.ended_well = true;
  }
  return status;
}

}  // namespace kintsugi::mapper
