#include "mapper/synthetic/scene/shape.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "lcmtypes/base/argument_check.hpp"

namespace kintsugi::synthetic {

namespace {

void require_length(const char* shape, const char* name, double value) {
  require(std::isfinite(value) && value > 0.0, std::string(shape) + ": " + name, value,
          "finite and positive");
}

/// Distance in the plane to a box around the origin.
double distance_to_rectangle(double qx, double qy) {
  return std::hypot(std::max(qx, 0.0), std::max(qy, 0.0)) + std::min(std::max(qx, qy), 0.0);
}

double distance_to_cylinder(const Shape& s, const Eigen::Vector3d& p) {
  const double rho = std::hypot(p.x(), p.y());
  const double radial =
      std::max(rho - s.radius, s.second_radius > 0.0 ? s.second_radius - rho : rho - s.radius);
  return distance_to_rectangle(radial, std::abs(p.z()) - s.half_extents.z());
}

/// In the half plane (rho, z) the solid is a trapezium: distance to the nearer of its caps and its
/// slanted side, negative where both are behind.
double distance_to_cone(const Shape& s, const Eigen::Vector3d& p) {
  const double h = s.half_extents.z();
  const double rho = std::hypot(p.x(), p.y());
  const double cap_radius = p.z() < 0.0 ? s.radius : s.second_radius;
  const Eigen::Vector2d to_cap(std::max(rho - cap_radius, 0.0), std::abs(p.z()) - h);
  const Eigen::Vector2d bottom(s.radius, -h);
  const Eigen::Vector2d side(s.second_radius - s.radius, 2.0 * h);
  const Eigen::Vector2d from_bottom = Eigen::Vector2d(rho, p.z()) - bottom;
  const double along = std::clamp(from_bottom.dot(side) / side.squaredNorm(), 0.0, 1.0);
  const Eigen::Vector2d to_side = from_bottom - along * side;
  const bool inside = to_side.x() < 0.0 && to_cap.y() < 0.0;
  return (inside ? -1.0 : 1.0) * std::sqrt(std::min(to_cap.squaredNorm(), to_side.squaredNorm()));
}

}  // namespace

const char* shape_name(ShapeKind kind) {
  switch (kind) {
    case ShapeKind::kBox:
      return "box";
    case ShapeKind::kRoundedBox:
      return "rounded box";
    case ShapeKind::kSphere:
      return "sphere";
    case ShapeKind::kCylinder:
      return "cylinder";
    case ShapeKind::kCone:
      return "cone";
    case ShapeKind::kCapsule:
      return "capsule";
    case ShapeKind::kTorus:
      return "torus";
  }
  return "";
}

Shape box(double size_x, double size_y, double size_z) {
  for (double size : {size_x, size_y, size_z}) require_length("box", "size", size);
  return {ShapeKind::kBox, 0.5 * Eigen::Vector3d(size_x, size_y, size_z), 0.0, 0.0};
}

Shape rounded_box(double size_x, double size_y, double size_z, double rounding) {
  Shape shape = box(size_x, size_y, size_z);
  require_length("rounded box", "rounding", rounding);
  require(rounding <= shape.half_extents.minCoeff(), "rounded box: rounding", rounding,
          "at most half the smallest size");
  shape.kind = ShapeKind::kRoundedBox;
  shape.radius = rounding;
  return shape;
}

Shape sphere(double radius) {
  require_length("sphere", "radius", radius);
  return {ShapeKind::kSphere, Eigen::Vector3d::Constant(radius), radius, 0.0};
}

Shape cylinder(double radius, double height, double bore_radius) {
  require_length("cylinder", "radius", radius);
  require_length("cylinder", "height", height);
  require(bore_radius >= 0.0 && bore_radius < radius, "cylinder: bore radius", bore_radius,
          "in [0, radius)");
  return {ShapeKind::kCylinder, {radius, radius, 0.5 * height}, radius, bore_radius};
}

Shape cone(double bottom_radius, double top_radius, double height) {
  require_length("cone", "height", height);
  require(bottom_radius >= 0.0, "cone: bottom radius", bottom_radius, "at least 0");
  require(top_radius >= 0.0, "cone: top radius", top_radius, "at least 0");
  const double radius = std::max(bottom_radius, top_radius);
  require_length("cone", "larger radius", radius);
  return {ShapeKind::kCone, {radius, radius, 0.5 * height}, bottom_radius, top_radius};
}

Shape capsule(double radius, double height) {
  require_length("capsule", "radius", radius);
  require(std::isfinite(height) && height >= 2.0 * radius, "capsule: height", height,
          "at least twice the radius");
  return {ShapeKind::kCapsule, {radius, radius, 0.5 * height}, radius, 0.0};
}

Shape torus(double ring_radius, double tube_radius) {
  require_length("torus", "ring radius", ring_radius);
  require_length("torus", "tube radius", tube_radius);
  require(tube_radius < ring_radius, "torus: tube radius", tube_radius, "below the ring radius");
  const double outer = ring_radius + tube_radius;
  return {ShapeKind::kTorus, {outer, outer, tube_radius}, ring_radius, tube_radius};
}

double signed_distance(const Shape& shape, const Eigen::Vector3d& p_O) {
  switch (shape.kind) {
    case ShapeKind::kBox:
    case ShapeKind::kRoundedBox: {
      const Eigen::Vector3d q =
          p_O.cwiseAbs() - (shape.half_extents.array() - shape.radius).matrix();
      return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0) - shape.radius;
    }
    case ShapeKind::kSphere:
      return p_O.norm() - shape.radius;
    case ShapeKind::kCylinder:
      return distance_to_cylinder(shape, p_O);
    case ShapeKind::kCone:
      return distance_to_cone(shape, p_O);
    case ShapeKind::kCapsule: {
      const double half_length = shape.half_extents.z() - shape.radius;
      const double z = p_O.z() - std::clamp(p_O.z(), -half_length, half_length);
      return Eigen::Vector3d(p_O.x(), p_O.y(), z).norm() - shape.radius;
    }
    case ShapeKind::kTorus:
      return std::hypot(std::hypot(p_O.x(), p_O.y()) - shape.radius, p_O.z()) - shape.second_radius;
  }
  return 0.0;
}

}  // namespace kintsugi::synthetic
