#pragma once
// A recording in memory, to be played many times and in any order.

#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/trajectory.hpp"
#include "mapper/core/frame/rgbd_frame.hpp"

namespace kintsugi::mapper::bench {

/// All frames of a device, 1.5 MB each (depth in units of 0.1 mm, up to 6.5 m).
class Recording {
 public:
  /// Reads up to `max_frames` (0: all) from `folder://PATH` or `synthetic://NAME?...`.
  /// @throws as open_frame_source(); std::runtime_error when there are fewer than two frames
  explicit Recording(const std::string& device, int max_frames = 0);

  int num_frames() const { return static_cast<int>(frames_.size()); }
  std::int64_t period_us() const;  ///< between frames, on average

  /// The frame; its time is relative to the first frame.
  RgbdFrame frame(int index) const;

  /// Whether the true path is exact (synthetic) and not the estimate of another system.
  bool truth_is_exact() const { return truth_is_exact_; }
  /// True pose of each frame relative to the first frame that has one; without drift a mapper that
  /// starts at that frame estimates these X_WC. Empty for frames without a true pose.
  const std::vector<std::optional<Pose>>& true_path() const { return X_WC_true_; }

 private:
  struct StoredFrame {
    std::int64_t utime = 0;
    cv::Mat_<std::uint16_t> depth;
    cv::Mat_<cv::Vec3b> color_rgb;
  };

  void read_frames(const std::string& device, int max_frames);
  void read_truth(const std::string& device);

  Intrinsics intrinsics_;
  std::vector<StoredFrame> frames_;
  std::vector<std::optional<Pose>> X_WC_true_;
  bool truth_is_exact_ = false;
};

}  // namespace kintsugi::mapper::bench
