#include "mapper/synthetic/scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "mapper/synthetic/scene/bvh.hpp"

namespace kintsugi::synthetic {
namespace {

Eigen::AlignedBox3d bounding_box_W(const Primitive& primitive) {
  // A rotated box reaches |R| h along each axis. The margin covers rays that run along a face.
  constexpr double kMargin = 1e-6;
  const Eigen::Vector3d reach =
      (primitive.X_WO.linear().cwiseAbs() * primitive.shape.half_extents).array() + kMargin;
  const Eigen::Vector3d centre = primitive.X_WO.translation();
  return {centre - reach, centre + reach};
}

}  // namespace

Scene::Scene(std::vector<Primitive> primitives, std::vector<Instance> instances, const Color& light)
    : primitives_(std::move(primitives)), instances_(std::move(instances)), light_(light) {
  for (const Primitive& primitive : primitives_) {
    if (primitive.instance < 1 || primitive.instance > static_cast<int>(instances_.size())) {
      throw std::invalid_argument("Scene: a primitive has instance " +
                                  std::to_string(primitive.instance) + ", expected 1 to " +
                                  std::to_string(instances_.size()));
    }
  }
  std::vector<Eigen::AlignedBox3d> boxes_W;
  boxes_W.reserve(primitives_.size());
  for (const Primitive& primitive : primitives_) boxes_W.push_back(bounding_box_W(primitive));
  bvh_ = std::make_unique<Bvh>(boxes_W);
}

Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

std::optional<RayHit> Scene::intersect(const Eigen::Vector3d& origin_W,
                                       const Eigen::Vector3d& direction_W) const {
  RayHit hit;
  hit.t = bvh_->nearest_along_ray(origin_W, direction_W, [&](int index, double best) {
    const Primitive& primitive = primitives_[index];
    const Eigen::Matrix3d R_OW = primitive.X_WO.linear().transpose();
    const double t = synthetic::intersect<double>(
        primitive.shape, R_OW * (origin_W - primitive.X_WO.translation()), R_OW * direction_W);
    // Of surfaces that coincide the first in the list is seen, as in render().
    if (t < best || (t == best && std::isfinite(t) && index < hit.primitive)) {
      hit.primitive = index;
      return t;
    }
    return best;
  });
  if (hit.primitive < 0) return std::nullopt;
  const Primitive& primitive = primitives_[hit.primitive];
  hit.p_W = origin_W + hit.t * direction_W;
  hit.normal_W = primitive.X_WO.linear() *
                 outward_normal<double>(primitive.shape, primitive.X_WO.inverse() * hit.p_W);
  hit.instance = primitive.instance;
  return hit;
}

double Scene::signed_distance(const Eigen::Vector3d& p_W) const {
  return nearest_surface(p_W).signed_m;
}

SurfaceDistance Scene::nearest_surface(const Eigen::Vector3d& p_W) const {
  int nearest = -1;
  const double signed_m = bvh_->nearest_to_point(p_W, [&](int index, double best) {
    const Primitive& primitive = primitives_[index];
    const double d = synthetic::signed_distance(primitive.shape, primitive.X_WO.inverse() * p_W);
    if (d < best || (d == best && index < nearest)) nearest = index;
    return std::min(d, best);
  });
  return {signed_m, nearest < 0 ? kNoInstance : primitives_[nearest].instance};
}

}  // namespace kintsugi::synthetic
