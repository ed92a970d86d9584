#include "mapper/core/tracking/photometric_view.hpp"

namespace kintsugi::mapper {

PhotometricImage PhotometricView::level(int index) {
  if (intensity_.empty()) {
    intensity_ = intensity_pyramid(color_rgb_, surface_.front().depth_m.size(),
                                   static_cast<int>(surface_.size()));
  }
  return {surface_[index], intensity_[index]};
}

}  // namespace kintsugi::mapper
