#pragma once
// Solids in their own frame O, centred at the origin, with exact distances and ray intersections.

#include <Eigen/Core>
#include <cstdint>

namespace kintsugi::synthetic {

enum class ShapeKind : std::uint8_t {
  kBox,
  kRoundedBox,
  kSphere,
  kCylinder,
  kCone,
  kCapsule,
  kTorus
};

/// "box", "rounded box", "sphere", ...
const char* shape_name(ShapeKind kind);

/// A solid in its own frame O. Build one with the functions below, which check their arguments;
/// the meaning of the two radii depends on the kind. Round shapes have their axis along O's z.
template <typename Real>
struct BasicShape {
  using Vector = Eigen::Matrix<Real, 3, 1>;

  ShapeKind kind = ShapeKind::kBox;
  Vector half_extents = Vector::Ones();  ///< of the bounding box in O, metres
  Real radius = 0;         ///< rounding; sphere; outer; bottom; capsule; of the torus' ring, metres
  Real second_radius = 0;  ///< bore of a cylinder; top of a cone; of the torus' tube, metres

  template <typename Other>
  BasicShape<Other> cast() const {
    return {kind, half_extents.template cast<Other>(), static_cast<Other>(radius),
            static_cast<Other>(second_radius)};
  }
};
using Shape = BasicShape<double>;

// Lengths in metres.
// @throws std::invalid_argument for a length that is not finite, not positive (bore radius and the
//   radii of a cone: negative), or too large for the solid
Shape box(double size_x, double size_y, double size_z);
Shape rounded_box(double size_x, double size_y, double size_z, double rounding);
Shape sphere(double radius);
Shape cylinder(double radius, double height, double bore_radius = 0.0);
Shape cone(double bottom_radius, double top_radius, double height);
Shape capsule(double radius, double height);  ///< total height, at least 2 * radius
Shape torus(double ring_radius, double tube_radius);

/// Euclidean distance from p_O to the surface, metres: positive outside, negative inside, exact.
double signed_distance(const Shape& shape, const Eigen::Vector3d& p_O);

/// Unit outward normal at the surface point nearest to p_O, which must be on or near the surface.
/// On an edge it is the normal of one of the faces.
template <typename Real>
Eigen::Matrix<Real, 3, 1> outward_normal(const BasicShape<Real>& shape,
                                         const Eigen::Matrix<Real, 3, 1>& p_O);

/// The smallest t >= 0 at which origin_O + t direction_O enters the solid from outside, or
/// infinity. The direction must not be zero and need not be a unit vector. A solid that contains
/// the origin is not hit.
template <typename Real>
Real intersect(const BasicShape<Real>& shape, const Eigen::Matrix<Real, 3, 1>& origin_O,
               const Eigen::Matrix<Real, 3, 1>& direction_O);

extern template Eigen::Vector3f outward_normal(const BasicShape<float>&, const Eigen::Vector3f&);
extern template Eigen::Vector3d outward_normal(const BasicShape<double>&, const Eigen::Vector3d&);
extern template float intersect(const BasicShape<float>&, const Eigen::Vector3f&,
                                const Eigen::Vector3f&);
extern template double intersect(const BasicShape<double>&, const Eigen::Vector3d&,
                                 const Eigen::Vector3d&);

}  // namespace kintsugi::synthetic
