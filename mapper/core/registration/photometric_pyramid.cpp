#include "mapper/core/registration/photometric_pyramid.hpp"

namespace kintsugi::mapper {

PhotometricImage PhotometricPyramid::level(int index) {
  if (intensity_.empty()) {
    intensity_ = intensity_pyramid(color_rgb_, surface_.front().depth_m.size(),
                                   static_cast<int>(surface_.size()));
  }
  return {surface_[index], intensity_[index]};
}

}  // namespace kintsugi::mapper
