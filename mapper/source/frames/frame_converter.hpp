#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

#include "mapper/core/frame/rgbd_frame.hpp"
#include "mapper/source/frames/undistorter.hpp"

namespace kintsugi::mapper {

/// Depth and colour of one moment, as a device gave them.
struct RawFrame {
  std::int64_t utime = 0;        ///< of the depth image, microseconds
  std::int64_t frame_index = 0;  ///< of the depth image
  cv::Mat_<std::uint16_t> depth_raw;
  cv::Mat_<cv::Vec3b> color_rgb;  ///< or empty
};

/// Raw depth to metres along C's z; raw 0, raw 65535 and values beyond `max_range_m` become NaN.
cv::Mat_<float> depth_to_metres(const cv::Mat_<std::uint16_t>& depth_raw, double units_per_m,
                                double max_range_m);

/// The camera of the same images with their rows in reverse order: row v becomes height - 1 - v.
/// The distortion is about points in C, which stay where they are.
Intrinsics with_rows_reversed(const Intrinsics& intrinsics);

/// Converts raw images to the frames that the mapper uses: depth in metres, lens distortion
/// removed, y pointing down in the image.
///
/// fy < 0 (ICL-NUIM) says that y points up: v = fy y / z + cy falls with y. With the rows in
/// reverse order the same pixels see the same points (x, y, z), and the camera is like any other,
/// so that nothing else needs to know of it. Points and poses stay in the coordinates of the
/// calibration.
class FrameConverter {
 public:
  /// @throws std::invalid_argument when the intrinsics (but for the sign of fy), the unit or the
  ///   range are not positive.
  FrameConverter(const Intrinsics& intrinsics, double depth_units_per_m, double max_range_m);

  /// Images must have the size of the calibration, else std::invalid_argument.
  [[nodiscard]] RgbdFrame convert(const RawFrame& raw) const;

 private:
  bool reverses_rows_;
  Undistorter undistorter_;
  double depth_units_per_m_;
  double max_range_m_;
};

}  // namespace kintsugi::mapper
