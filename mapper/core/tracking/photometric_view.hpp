#pragma once

#include <opencv2/core.hpp>

#include "lcmtypes/geometry.hpp"
#include "mapper/core/frame/intensity.hpp"
#include "mapper/core/frame/surface_pyramid.hpp"
#include "mapper/core/tracking/photometric.hpp"

namespace kintsugi::mapper {

/// A frame that may be compared by brightness, which is computed when first asked for: to keep one
/// costs nothing. Images are shared with whom they came from.
class PhotometricView {
 public:
  PhotometricView(const SurfacePyramid& surface, const cv::Mat_<cv::Vec3b>& color_rgb)
      : surface_(surface), color_rgb_(color_rgb) {}

  bool has_color() const { return !color_rgb_.empty(); }

  /// 0 is the finest level. Only with colour.
  /// @throws std::invalid_argument if the colour image is not 1, 2, 4.. times the finest surface
  PhotometricImage level(int index);

 private:
  SurfacePyramid surface_;
  cv::Mat_<cv::Vec3b> color_rgb_;
  IntensityPyramid intensity_;  ///< empty until it is needed
};

/// A view whose pose is known: what later views are compared with.
struct Keyframe {
  PhotometricView view;
  Pose X_WK = Pose::Identity();
};

}  // namespace kintsugi::mapper
