#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

#include "mapper/openni2_driver/plugin/oni_driver_api.hpp"

namespace kintsugi::mapper {

/// The camera settings of an imitated colour stream. Exposure and white balance vary with time
/// while they are automatic, and keep their values when that is switched off.
class CameraControls {
 public:
  static bool has(int property);

  OniStatus get(int property, void* data, int* size) const;
  OniStatus set(int property, const void* data, int size);

  /// Applies the settings at this time of the recording to the image.
  cv::Mat expose(const cv::Mat& image, std::int64_t utime);

 private:
  OniBool auto_exposure_ = TRUE;
  OniBool auto_white_balance_ = TRUE;
  int exposure_ = 100;  ///< 100: as recorded
  int gain_ = 100;
  double red_ = 1.0;
};

}  // namespace kintsugi::mapper
