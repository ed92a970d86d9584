#include "mapper/openni2_driver/recording/imitated_recording.hpp"

#include <algorithm>
#include <utility>

namespace kintsugi::mapper {
namespace {

/// The same share in [0, 1) for an index each time, spread evenly (multiples of the golden ratio).
double share_of(int index) {
  constexpr std::uint32_t kGolden = 2654435769U;
  constexpr double kScale = 1.0 / 4294967296.0;
  return kScale * static_cast<double>(kGolden * static_cast<std::uint32_t>(index + 1));
}

}  // namespace

ImitatedRecording::ImitatedRecording(std::unique_ptr<Recording> recording,
                                     const CameraImitation& imitation,
                                     std::optional<std::int64_t> resume_utime)
    : recording_(std::move(recording)), imitation_(imitation) {
  const int last = recording_->num_depth_frames() - 1;
  for (int i = 0; i <= last; ++i) {
    const bool passed = resume_utime && recording_->depth_utime(i) < *resume_utime;
    if (!passed || i == last) depths_.push_back(i);  // there is always one
  }
  for (int i = 0; i < recording_->num_color_frames(); ++i) {
    const bool passed = resume_utime && recording_->color_utime(i) < *resume_utime;
    if (!passed && color_comes(i)) colors_.push_back(i);
  }
  if (resume_utime && imitation_.restart_clock) clock_zero_ = depth_utime(0);
  if (!resume_utime && imitation_.clock_jump_at > 0 && imitation_.clock_jump_at <= last + 1) {
    clock_jump_utime_ = recording_->depth_utime(imitation_.clock_jump_at - 1);
  }
}

bool ImitatedRecording::color_comes(int index) const {
  const int number = index + 1;
  const bool in_gap = number >= imitation_.color_gap_first && number <= imitation_.color_gap_last;
  return imitation_.color && !in_gap && share_of(index) >= imitation_.color_drop;
}

std::int64_t ImitatedRecording::depth_utime(int index) const {
  return recording_->depth_utime(depths_.at(static_cast<std::size_t>(index)));
}

std::int64_t ImitatedRecording::color_utime(int index) const {
  return recording_->color_utime(colors_.at(static_cast<std::size_t>(index)));
}

std::int64_t ImitatedRecording::depth_stamp(int index) const { return clock(depth_utime(index)); }

std::int64_t ImitatedRecording::color_stamp(int index) const {
  return std::max<std::int64_t>(0, clock(color_utime(index)) + imitation_.color_clock_us);
}

/// What the camera's clock shows; it cannot show less than 0.
std::int64_t ImitatedRecording::clock(std::int64_t utime) const {
  const bool jumped = clock_jump_utime_ && utime >= *clock_jump_utime_;
  return std::max<std::int64_t>(0, utime - clock_zero_ + (jumped ? imitation_.clock_jump_us : 0));
}

cv::Mat_<std::uint16_t> ImitatedRecording::depth(int index, DepthUnit unit) {
  return recording_->depth(depths_.at(static_cast<std::size_t>(index)), unit);
}

cv::Mat_<cv::Vec3b> ImitatedRecording::color(int index) {
  return recording_->color(colors_.at(static_cast<std::size_t>(index)));
}

std::optional<Pose> ImitatedRecording::depth_X_WC(int index) const {
  return recording_->depth_X_WC(depths_.at(static_cast<std::size_t>(index)));
}

}  // namespace kintsugi::mapper
