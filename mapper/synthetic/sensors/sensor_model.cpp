#include "mapper/synthetic/sensors/sensor_model.hpp"

#include <cmath>

#include <tbb/parallel_for.h>

#include "lcmtypes/base/argument_check.hpp"

namespace kintsugi::synthetic {

cv::Mat_<std::uint16_t> SensorModel::apply(const RenderedFrame& frame,
                                           std::int64_t frame_index) const {
  const cv::Mat_<double> measured_m = measure(frame, frame_index);
  const Range limits = range();
  cv::Mat_<std::uint16_t> depth_mm(measured_m.size());
  tbb::parallel_for(0, depth_mm.rows, [&](int v) {
    for (int u = 0; u < depth_mm.cols; ++u) {
      const double z = measured_m(v, u);
      const bool seen = z >= limits.min_m && z <= limits.max_m;
      depth_mm(v, u) = seen ? static_cast<std::uint16_t>(std::lround(1000.0 * z)) : 0;
    }
  });
  return depth_mm;
}

void validate(const SensorModel::Range& range) {
  require(range.min_m > 0, "min_depth_m", range.min_m, "a value above 0");
  require(range.max_m > range.min_m && range.max_m <= 65, "max_depth_m", range.max_m,
          "a value above min_depth_m and at most 65");
}

}  // namespace kintsugi::synthetic
