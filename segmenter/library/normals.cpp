#include "lcmtypes/base/argument_check.hpp"
#include "segmenter/library/segmentation.hpp"
#include "segmenter/preprocess/cloud_preparation.hpp"

namespace kintsugi {

void estimate_normals(std::span<CloudPoint> points_W, double resolution_m,
                      const std::optional<Eigen::Vector3d>& viewpoint_W) {
  // Points within the bounds of a map are all neighbours at a larger one, which takes for ever.
  require(resolution_m > 0.0 && resolution_m <= kMaxPosition_m, "resolution_m", resolution_m,
          "> 0 and at most 1e6 m");
  segmenter::NormalsConfig config;
  config.viewpoint_W = viewpoint_W;
  config.validate();
  segmenter::compute_normals(points_W, config, [](double /*share*/) {});
  segmenter::average_normals(points_W,
                             segmenter::kAveragingRadius_vox * static_cast<float>(resolution_m));
}

void normalize_normals(std::span<CloudPoint> points_W) { segmenter::normalize_normals(points_W); }

}  // namespace kintsugi
