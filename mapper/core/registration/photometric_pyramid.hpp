#pragma once

#include <opencv2/core.hpp>

#include "lcmtypes/geometry.hpp"
#include "mapper/core/frame/intensity.hpp"
#include "mapper/core/frame/surface_pyramid.hpp"
#include "mapper/core/registration/photometric.hpp"

namespace kintsugi::mapper {

/// Surface and intensity of a frame at several sizes. Intensities are computed at the first call of
/// level(), so that a frame whose colour is never needed costs nothing. Images are shared with
/// whoever passed them.
class PhotometricPyramid {
 public:
  PhotometricPyramid(const SurfacePyramid& surface, const cv::Mat_<cv::Vec3b>& color_rgb)
      : surface_(surface), color_rgb_(color_rgb) {}

  bool has_color() const { return !color_rgb_.empty(); }

  /// Level 0 is the finest. Only where has_color().
  /// @throws std::invalid_argument if the colour image is not 1, 2, 4.. times the finest surface
  PhotometricImage level(int index);

 private:
  SurfacePyramid surface_;
  cv::Mat_<cv::Vec3b> color_rgb_;
  IntensityPyramid intensity_;  ///< empty until it is needed
};

/// An earlier frame with known pose, with which the intensities of new frames are compared. K is
/// its camera.
struct PhotometricReference {
  PhotometricPyramid frame_K;
  Pose X_WK = Pose::Identity();
};

/// A frame and what its intensities are compared with. Where one is null, depth alone decides.
struct PhotometricPair {
  PhotometricPyramid* frame_C = nullptr;
  PhotometricReference* reference = nullptr;
};

}  // namespace kintsugi::mapper
