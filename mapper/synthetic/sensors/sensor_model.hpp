#pragma once
// What a depth camera delivers of what is there.

#include <cstdint>

#include <opencv2/core.hpp>

#include "mapper/synthetic/scene/rendered_frame.hpp"

namespace kintsugi::synthetic {

/// Simulates one kind of depth camera. The random numbers of a pixel are a hash of (seed, frame,
/// pixel), so a frame depends neither on the order of frames nor on the number of threads.
/// Immutable; every method may be called from several threads.
class SensorModel {
 public:
  /// Depth outside is invalid; 0 < min_m < max_m <= 65 (16 bits, millimetres).
  struct Range {
    double min_m;
    double max_m;
  };

  virtual ~SensorModel() = default;

  /// Size and geometry of its images. Frames of another size and geometry can be applied, too:
  /// what is given in pixels below is then in pixels of that frame.
  virtual Intrinsics intrinsics() const = 0;
  virtual Range range() const = 0;

  /// Depth as the device delivers it: millimetres, 0 where it is lost or out of range.
  cv::Mat_<std::uint16_t> apply(const RenderedFrame& frame, std::int64_t frame_index) const;

 private:
  /// Measured depth before the range is applied, metres; NaN: lost.
  virtual cv::Mat_<double> measure(const RenderedFrame& frame, std::int64_t frame_index) const = 0;
};

/// @throws std::invalid_argument naming the bound that `range` violates
void validate(const SensorModel::Range& range);

}  // namespace kintsugi::synthetic
