#pragma once

#include "mapper/openni2_driver/recording/recording.hpp"
#include "mapper/synthetic/render/sequence.hpp"

namespace kintsugi::mapper {

/// A walk through a synthetic scene, rendered frame by frame. Depth and colour have the same times;
/// the true poses are known.
class SyntheticRecording : public Recording {
 public:
  /// Writes the ground truth if `config` names a folder for it.
  /// @throws std::invalid_argument as synthetic::Sequence, std::system_error when the ground truth
  ///   cannot be written
  explicit SyntheticRecording(const synthetic::Sequence::Config& config);

  [[nodiscard]] std::string name() const override;
  [[nodiscard]] const Intrinsics& intrinsics() const override { return sequence_.intrinsics(); }
  [[nodiscard]] int frame_rate_hz() const override { return sequence_.config().rate_hz; }
  [[nodiscard]] DepthUnit finest_depth_unit() const override { return DepthUnit::k1mm; }
  [[nodiscard]] int num_depth_frames() const override { return sequence_.num_frames(); }
  [[nodiscard]] int num_color_frames() const override { return sequence_.num_frames(); }
  [[nodiscard]] std::int64_t depth_utime(int index) const override {
    return sequence_.utime(index);
  }
  [[nodiscard]] std::int64_t color_utime(int index) const override {
    return sequence_.utime(index);
  }
  [[nodiscard]] cv::Mat_<std::uint16_t> depth(int index, DepthUnit unit) override;
  [[nodiscard]] cv::Mat_<cv::Vec3b> color(int index) override;
  [[nodiscard]] std::optional<Pose> depth_X_WC(int index) const override {
    return sequence_.X_WC(index);
  }

 private:
  synthetic::Sequence sequence_;
};

}  // namespace kintsugi::mapper
