#pragma once
// What the reader of a format makes of a recording.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "lcmtypes/geometry.hpp"
#include "mapper/openni2_driver/formats/calibration.hpp"

namespace kintsugi::mapper {

/// Reads single images of a recording, repeatedly and in any order, with the same result. To be
/// used by one thread at a time.
class ImageStore {
 public:
  virtual ~ImageStore() = default;

  /// Along C's z, of the size of the depth camera: CV_16UC1, raw values, 0 and 65535 invalid; or
  /// CV_32FC1, metres, invalid where it is not a finite number greater than 0.
  /// @throws std::runtime_error naming the file, and the image if it is one of several in it
  [[nodiscard]] virtual cv::Mat depth(int index) = 0;

  /// Red first, of the size of the colour camera.
  /// @throws std::runtime_error as depth()
  [[nodiscard]] virtual cv::Mat_<cv::Vec3b> color(int index) = 0;

  /// Whether the image is not there at all: known without decoding it.
  [[nodiscard]] virtual bool depth_is_missing(int /*index*/) const { return false; }
  [[nodiscard]] virtual bool color_is_missing(int /*index*/) const { return false; }
};

/// A colour camera R whose pixels are not those of the depth camera C.
struct ColorCamera {
  Intrinsics intrinsics;
  Pose X_RC = Pose::Identity();  ///< pose of C in R, metres
};

struct RecordingContents {
  std::string format;                ///< for people, as "TUM RGB-D folder"
  std::string name;                  ///< for people
  std::vector<std::string> remarks;  ///< how it is read, where that is not certain: sentences
  /// Of the depth camera. fy < 0: C's y axis points up in the images. The unit is that of CV_16UC1.
  Calibration calibration;
  std::optional<ColorCamera> color_camera;  ///< absent: colour has the pixels of the depth images
  std::vector<std::int64_t> depth_utimes;   ///< microseconds, ascending strictly, not empty
  std::vector<std::int64_t> color_utimes;   ///< the same of the colour images; empty: no colour
  /// Camera at each depth image as the recording has it; empty: it has no poses.
  std::vector<std::optional<Pose>> depth_X_WC;
  std::unique_ptr<ImageStore> images;
};

}  // namespace kintsugi::mapper
