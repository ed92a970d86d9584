#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include <opencv2/core.hpp>

#include "mapper/source/frames/frame_converter.hpp"

namespace kintsugi::mapper {

/// Pairs each depth image with the colour image nearest in time, if that is within 0.6 periods of
/// the depth stream (half a period, and some jitter of both times).
///
/// Images of each kind must be added in the order of their times; the two kinds may interleave in
/// any way. A depth image is decided when a colour image of its time or later has been added, or
/// two more depth images. Each colour image is used at most once. Of colour images without a depth
/// image the newest few are kept.
class FramePairer {
 public:
  /// @param expect_color false: depth images are decided at once
  FramePairer(bool expect_color, std::int64_t depth_period_us)
      : expect_color_(expect_color), max_difference_us_(depth_period_us * 3 / 5) {}

  void add_depth(std::int64_t utime, std::int64_t frame_index, cv::Mat_<std::uint16_t> depth_raw);
  void add_color(std::int64_t utime, cv::Mat_<cv::Vec3b> color_rgb);

  /// No more images will be added: decides the remaining ones.
  void finish() { finished_ = true; }

  /// After finish(): images are added again.
  void resume(bool expect_color);

  /// The oldest decided frame; its colour is empty when there is none for it.
  std::optional<RawFrame> take();

  [[nodiscard]] std::int64_t depth_unpaired() const { return depth_unpaired_; }
  [[nodiscard]] std::int64_t color_unpaired() const { return color_unpaired_; }

 private:
  struct Color {
    std::int64_t utime = 0;
    cv::Mat_<cv::Vec3b> rgb;
  };

  [[nodiscard]] bool is_decided(const RawFrame& depth) const;
  cv::Mat_<cv::Vec3b> take_color_for(std::int64_t utime);
  void drop_colors();

  bool expect_color_;
  std::int64_t max_difference_us_;
  bool finished_ = false;
  std::deque<RawFrame> depths_;
  std::deque<Color> colors_;
  std::int64_t depth_unpaired_ = 0;
  std::int64_t color_unpaired_ = 0;
};

}  // namespace kintsugi::mapper
