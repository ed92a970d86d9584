#include "mapper/source/frames/frame_pairer.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace kintsugi::mapper {

void FramePairer::add_depth(std::int64_t utime, std::int64_t frame_index,
                            cv::Mat_<std::uint16_t> depth_raw) {
  depths_.push_back({.utime = utime,
                     .frame_index = frame_index,
                     .depth_raw = std::move(depth_raw),
                     .color_rgb = {}});
}

void FramePairer::add_color(std::int64_t utime, cv::Mat_<cv::Vec3b> color_rgb) {
  constexpr std::size_t kMaxKept = 8;
  // The clocks of a device can turn out to differ: then what waits has other times than what comes.
  if (!colors_.empty() && utime <= colors_.back().utime) drop_colors();
  colors_.push_back({.utime = utime, .rgb = std::move(color_rgb)});
  if (colors_.size() <= kMaxKept) return;
  colors_.pop_front();
  ++color_unpaired_;
}

void FramePairer::resume(bool expect_color) {
  drop_colors();
  expect_color_ = expect_color;
  finished_ = false;
}

void FramePairer::drop_colors() {
  color_unpaired_ += static_cast<std::int64_t>(colors_.size());
  colors_.clear();
}

std::optional<RawFrame> FramePairer::take() {
  if (depths_.empty()) {
    if (finished_) drop_colors();
    return std::nullopt;
  }
  if (!is_decided(depths_.front())) return std::nullopt;
  RawFrame frame = std::move(depths_.front());
  depths_.pop_front();
  frame.color_rgb = take_color_for(frame.utime);
  if (frame.color_rgb.empty()) ++depth_unpaired_;
  return frame;
}

bool FramePairer::is_decided(const RawFrame& depth) const {
  constexpr std::size_t kMaxWaiting = 2;
  if (finished_ || !expect_color_ || depths_.size() > kMaxWaiting) return true;
  return !colors_.empty() && colors_.back().utime >= depth.utime;
}

/// Empty when there is none. Colours that no later depth image can want are let go.
cv::Mat_<cv::Vec3b> FramePairer::take_color_for(std::int64_t utime) {
  const auto distance = [&](const Color& color) { return std::abs(color.utime - utime); };
  const auto nearest = std::ranges::min_element(colors_, {}, distance);
  const bool found = nearest != colors_.end() && distance(*nearest) <= max_difference_us_;
  const auto first_wanted =
      found ? nearest : std::ranges::find_if(colors_, [&](const Color& color) {
        return color.utime + max_difference_us_ >= utime;
      });
  color_unpaired_ += first_wanted - colors_.begin();
  cv::Mat_<cv::Vec3b> rgb;
  if (found) rgb = std::move(nearest->rgb);
  colors_.erase(colors_.begin(), found ? first_wanted + 1 : first_wanted);
  return rgb;
}

}  // namespace kintsugi::mapper
