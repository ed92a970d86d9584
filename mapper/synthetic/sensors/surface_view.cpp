#include "mapper/synthetic/sensors/surface_view.hpp"

#include <array>
#include <cmath>

namespace kintsugi::synthetic {

namespace {

struct Step {
  int v;
  int u;
};
constexpr std::array<Step, 4> kNeighbours = {{{0, -1}, {0, 1}, {-1, 0}, {1, 0}}};

bool inside(const cv::Mat& image, int v, int u) {
  return v >= 0 && u >= 0 && v < image.rows && u < image.cols;
}

}  // namespace

IncidenceAngles::IncidenceAngles(const RenderedFrame& frame)
    : frame_(frame), R_CW_(frame.X_WC.linear().transpose()) {}

double IncidenceAngles::cosine(int v, int u) const {
  const Intrinsics& camera = frame_.intrinsics;
  const cv::Vec3f n = frame_.normals_W(v, u);
  const Eigen::Vector3d ray_C((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1.0);
  return -(R_CW_ * Eigen::Vector3d(n[0], n[1], n[2])).dot(ray_C) / ray_C.norm();
}

bool at_depth_edge(const cv::Mat_<float>& depth_m, int v, int u, double ratio) {
  const float z = depth_m(v, u);
  for (const Step step : kNeighbours) {
    const int nv = v + step.v;
    const int nu = u + step.u;
    if (inside(depth_m, nv, nu) && !(std::abs(depth_m(nv, nu) - z) <= ratio * z)) return true;
  }
  return false;
}

std::optional<float> depth_across_edge(const cv::Mat_<float>& depth_m, int v, int u, double ratio) {
  const float z = depth_m(v, u);
  double largest_m = ratio * z;
  std::optional<float> other_m;
  for (const Step step : kNeighbours) {
    const int nv = v + step.v;
    const int nu = u + step.u;
    if (!inside(depth_m, nv, nu) || !(std::abs(depth_m(nv, nu) - z) > largest_m)) continue;
    other_m = depth_m(nv, nu);
    largest_m = std::abs(*other_m - z);
  }
  return other_m;
}

}  // namespace kintsugi::synthetic
