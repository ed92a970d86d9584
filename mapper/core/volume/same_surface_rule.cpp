#include "mapper/core/volume/same_surface_rule.hpp"

#include "lcmtypes/base/argument_check.hpp"

namespace kintsugi::mapper {

void SameSurface::validate() const {
  check_range("max_distance_vox", max_distance_vox, 0.0, 100.0);
  check_range("max_angle_deg", max_angle_deg, 0.0, 180.0);
  check_range("weight_threshold", weight_threshold, 0, 65534);
}

}  // namespace kintsugi::mapper
