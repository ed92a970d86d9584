// Rays against solids, and their normals. Everything is a template over the scalar: the renderer
// works in float, Scene::intersect in double.
#include <algorithm>
#include <cmath>
#include <limits>

#include "mapper/synthetic/scene/shape.hpp"

namespace kintsugi::synthetic {

namespace {

template <typename Real>
using Vector = Eigen::Matrix<Real, 3, 1>;

template <typename Real>
constexpr Real kMiss = std::numeric_limits<Real>::infinity();

/// A surface found by iteration is at most this far from the true one, metres.
template <typename Real>
constexpr Real kTolerance = std::is_same_v<Real, float> ? Real(2e-6) : Real(1e-10);

template <typename Real>
struct Interval {
  Real enter;
  Real leave;
};

/// Where the ray is inside the bounding box; empty (enter > leave) when it never is. A zero
/// component of the direction divides to infinity, which compares as it should.
template <typename Real>
inline Interval<Real> slabs(const Vector<Real>& half, const Vector<Real>& o,
                            const Vector<Real>& d) {
  Real enter = -kMiss<Real>;
  Real leave = kMiss<Real>;
  for (int axis = 0; axis < 3; ++axis) {
    const Real inverse = Real(1) / d[axis];
    const Real low = (-half[axis] - o[axis]) * inverse;
    const Real high = (half[axis] - o[axis]) * inverse;
    enter = std::max(enter, std::min(low, high));
    leave = std::min(leave, std::max(low, high));
  }
  return {enter, leave};
}

/// Real roots of a t^2 + 2 b t + c = 0 in ascending order, without cancellation; false if none.
/// a may vanish: then one root is infinite.
template <typename Real>
bool solve_quadratic(Real a, Real b, Real c, Real& low, Real& high) {
  const Real discriminant = b * b - a * c;
  if (!(discriminant >= 0)) return false;
  const Real q = -(b + std::copysign(std::sqrt(discriminant), b));
  if (q == 0) {
    low = high = Real(0);
    return a != 0;
  }
  low = q / a;
  high = c / q;
  if (low > high) std::swap(low, high);
  return true;
}

template <typename Real>
Real intersect_ball(const Vector<Real>& o, const Vector<Real>& d, Real radius) {
  Real low;
  Real high;
  if (!solve_quadratic(d.squaredNorm(), o.dot(d), o.squaredNorm() - radius * radius, low, high)) {
    return kMiss<Real>;
  }
  return low;
}

/// Slanted side of a cone, rho = middle + slope z; with slope zero a cylinder. `outward` is +1 for
/// a solid inside the side, -1 for a bore, whose wall is entered from within.
template <typename Real>
Real intersect_side(const Vector<Real>& o, const Vector<Real>& d, Real middle, Real slope,
                    Real half_height, Real outward) {
  const Real radius_at_origin = middle + slope * o.z();
  const Real a = d.x() * d.x() + d.y() * d.y() - slope * slope * d.z() * d.z();
  const Real b = o.x() * d.x() + o.y() * d.y() - slope * radius_at_origin * d.z();
  const Real c = o.x() * o.x() + o.y() * o.y() - radius_at_origin * radius_at_origin;
  Real roots[2];
  if (!solve_quadratic(a, b, c, roots[0], roots[1])) return kMiss<Real>;
  for (const Real t : roots) {
    if (!(t >= 0) || !std::isfinite(t)) continue;
    const Vector<Real> p = o + t * d;
    const Real radius = middle + slope * p.z();
    const Real facing = p.x() * d.x() + p.y() * d.y() - slope * radius * d.z();
    if (std::abs(p.z()) <= half_height && radius >= 0 && outward * facing <= 0) return t;
  }
  return kMiss<Real>;
}

/// The cap (of two, at z = +- half_height) that the ray can enter, if it does so between the radii.
template <typename Real>
Real intersect_cap(const Vector<Real>& o, const Vector<Real>& d, Real half_height, Real inner,
                   Real outer) {
  if (d.z() == 0) return kMiss<Real>;
  const Real t = (std::copysign(half_height, -d.z()) - o.z()) / d.z();
  if (!(t >= 0)) return kMiss<Real>;
  const Real x = o.x() + t * d.x();
  const Real y = o.y() + t * d.y();
  const Real rho_squared = x * x + y * y;
  return rho_squared <= outer * outer && rho_squared >= inner * inner ? t : kMiss<Real>;
}

template <typename Real>
Real intersect_cylinder(const BasicShape<Real>& s, const Vector<Real>& o, const Vector<Real>& d) {
  const Real h = s.half_extents.z();
  Real t = std::min(intersect_side(o, d, s.radius, Real(0), h, Real(1)),
                    intersect_cap(o, d, h, s.second_radius, s.radius));
  if (s.second_radius > 0) {
    t = std::min(t, intersect_side(o, d, s.second_radius, Real(0), h, Real(-1)));
  }
  return t;
}

template <typename Real>
Real intersect_cone(const BasicShape<Real>& s, const Vector<Real>& o, const Vector<Real>& d) {
  const Real h = s.half_extents.z();
  const Real middle = (s.radius + s.second_radius) / 2;
  const Real slope = (s.second_radius - s.radius) / (2 * h);
  const Real cap_radius = d.z() < 0 ? s.second_radius : s.radius;
  return std::min(intersect_side(o, d, middle, slope, h, Real(1)),
                  intersect_cap(o, d, h, Real(0), cap_radius));
}

template <typename Real>
Real intersect_capsule(const BasicShape<Real>& s, const Vector<Real>& o, const Vector<Real>& d) {
  const Real half_length = s.half_extents.z() - s.radius;
  Real t = intersect_side(o, d, s.radius, Real(0), half_length, Real(1));
  for (const Real z : {-half_length, half_length}) {
    const Vector<Real> centre(0, 0, z);
    const Real entry = intersect_ball<Real>(o - centre, d, s.radius);
    const bool on_surface = std::abs(o.z() + entry * d.z()) >= half_length;
    if (entry >= 0 && on_surface) t = std::min(t, entry);
  }
  return t;
}

/// From the nearest point of the box that rounding grows from.
template <typename Real>
inline Vector<Real> from_core(const BasicShape<Real>& s, const Vector<Real>& p) {
  const Vector<Real> core = (s.half_extents.array() - s.radius).matrix();
  return p - p.cwiseMax(-core).cwiseMin(core);
}

/// Newton's iteration on the distance along the ray: for a convex solid that function is convex, so
/// that from outside each step falls short of the surface, and one that rises has missed.
template <typename Real>
Real intersect_rounded_box(const BasicShape<Real>& s, const Vector<Real>& o, const Vector<Real>& d,
                           Real leave) {
  Real t = 0;
  for (int step = 0; step < 64 && t <= leave; ++step) {
    const Vector<Real> offset = from_core<Real>(s, o + t * d);
    const Real length = offset.norm();
    const Real distance = length - s.radius;
    if (distance <= kTolerance<Real>) return step > 0 ? t : kMiss<Real>;  // 0: o is inside
    const Real slope = offset.dot(d) / length;
    if (slope >= 0) return kMiss<Real>;
    t -= distance / slope;
  }
  return kMiss<Real>;
}

/// Sphere tracing: the torus is not convex, but its distance is exact. Only rays that all but touch
/// it take more than a hundred steps.
template <typename Real>
Real intersect_torus(const BasicShape<Real>& s, const Vector<Real>& o, const Vector<Real>& d,
                     Real leave) {
  const Real step_scale = Real(1) / d.norm();
  Real t = 0;
  for (int step = 0; step < 4096 && t <= leave; ++step) {
    const Vector<Real> p = o + t * d;
    const Real to_ring = std::sqrt(p.x() * p.x() + p.y() * p.y()) - s.radius;
    const Real distance = std::sqrt(to_ring * to_ring + p.z() * p.z()) - s.second_radius;
    if (distance <= kTolerance<Real>) return step > 0 ? t : kMiss<Real>;  // 0: o is inside
    t += distance * step_scale;
  }
  return kMiss<Real>;
}

template <typename Real>
inline Vector<Real> largest_axis(const Vector<Real>& excess, const Vector<Real>& p) {
  int axis = 0;
  excess.maxCoeff(&axis);
  Vector<Real> normal = Vector<Real>::Zero();
  normal[axis] = p[axis] < 0 ? Real(-1) : Real(1);
  return normal;
}

template <typename Real>
Vector<Real> cylinder_normal(const BasicShape<Real>& s, const Vector<Real>& p) {
  const Real rho = std::sqrt(p.x() * p.x() + p.y() * p.y());
  const Real outer = std::abs(rho - s.radius);
  const Real bore = s.second_radius > 0 ? std::abs(rho - s.second_radius) : kMiss<Real>;
  if (std::abs(std::abs(p.z()) - s.half_extents.z()) < std::min(outer, bore)) {
    return {0, 0, p.z() < 0 ? Real(-1) : Real(1)};
  }
  const Real sign = bore < outer ? Real(-1) : Real(1);
  return {sign * p.x() / rho, sign * p.y() / rho, 0};
}

template <typename Real>
Vector<Real> cone_normal(const BasicShape<Real>& s, const Vector<Real>& p) {
  const Real h = s.half_extents.z();
  const Real slope = (s.second_radius - s.radius) / (2 * h);
  const Real cosine = Real(1) / std::sqrt(1 + slope * slope);
  const Real rho = std::sqrt(p.x() * p.x() + p.y() * p.y());
  const Real to_side = std::abs(rho - (s.radius + slope * (p.z() + h))) * cosine;
  if (std::abs(std::abs(p.z()) - h) < to_side || rho == 0) {
    return {0, 0, p.z() < 0 ? Real(-1) : Real(1)};
  }
  return {cosine * p.x() / rho, cosine * p.y() / rho, -slope * cosine};
}

}  // namespace

template <typename Real>
Vector<Real> outward_normal(const BasicShape<Real>& s, const Vector<Real>& p) {
  switch (s.kind) {
    case ShapeKind::kBox:
      return largest_axis<Real>(p.cwiseAbs() - s.half_extents, p);
    case ShapeKind::kRoundedBox: {
      const Vector<Real> offset = from_core(s, p);
      if (offset.squaredNorm() > 0) return offset.normalized();
      return largest_axis<Real>(p.cwiseAbs() - s.half_extents, p);
    }
    case ShapeKind::kSphere:
      return p.normalized();
    case ShapeKind::kCylinder:
      return cylinder_normal(s, p);
    case ShapeKind::kCone:
      return cone_normal(s, p);
    case ShapeKind::kCapsule: {
      const Real half_length = s.half_extents.z() - s.radius;
      const Real z = p.z() - std::clamp(p.z(), -half_length, half_length);
      return Vector<Real>(p.x(), p.y(), z).normalized();
    }
    case ShapeKind::kTorus: {
      const Real rho = std::sqrt(p.x() * p.x() + p.y() * p.y());
      const Real share = (rho - s.radius) / rho;
      return Vector<Real>(p.x() * share, p.y() * share, p.z()).normalized();
    }
  }
  return Vector<Real>::Zero();
}

template <typename Real>
Real intersect(const BasicShape<Real>& s, const Vector<Real>& o, const Vector<Real>& d) {
  const Interval<Real> bounds = slabs<Real>(s.half_extents, o, d);
  if (!(bounds.enter <= bounds.leave) || !(bounds.leave >= 0)) return kMiss<Real>;
  if (s.kind == ShapeKind::kBox) return bounds.enter >= 0 ? bounds.enter : kMiss<Real>;

  // Start just before the ray enters the bounding box: small numbers, no cancellation.
  const Real start = std::max(bounds.enter - Real(1e-3), Real(0));
  const Vector<Real> p = o + start * d;
  const Real leave = bounds.leave - start;
  switch (s.kind) {
    case ShapeKind::kBox:
      break;
    case ShapeKind::kRoundedBox:
      return start + intersect_rounded_box<Real>(s, p, d, leave);
    case ShapeKind::kSphere: {
      const Real t = intersect_ball<Real>(p, d, s.radius);
      return t >= 0 ? start + t : kMiss<Real>;
    }
    case ShapeKind::kCylinder:
      return start + intersect_cylinder<Real>(s, p, d);
    case ShapeKind::kCone:
      return start + intersect_cone<Real>(s, p, d);
    case ShapeKind::kCapsule:
      return start + intersect_capsule<Real>(s, p, d);
    case ShapeKind::kTorus:
      return start + intersect_torus<Real>(s, p, d, leave);
  }
  return kMiss<Real>;
}

template Eigen::Vector3f outward_normal(const BasicShape<float>&, const Eigen::Vector3f&);
template Eigen::Vector3d outward_normal(const BasicShape<double>&, const Eigen::Vector3d&);
template float intersect(const BasicShape<float>&, const Eigen::Vector3f&, const Eigen::Vector3f&);
template double intersect(const BasicShape<double>&, const Eigen::Vector3d&,
                          const Eigen::Vector3d&);

}  // namespace kintsugi::synthetic
