#pragma once

#include "mapper/core/kernels/surface_planes.hpp"

namespace kintsugi::mapper {

// Always inlined, as the operations of a pack are: a call passes six registers through memory.

/// Sixteen vectors; `Float` is that of a pack.
template <typename Float>
struct VectorLanes {
  Float x, y, z;
};

template <typename Float>
[[gnu::always_inline]] inline Float dot(const VectorLanes<Float>& a, const VectorLanes<Float>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <typename Float>
[[gnu::always_inline]] inline VectorLanes<Float> cross(const VectorLanes<Float>& a,
                                                       const VectorLanes<Float>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// R a
template <typename Float>
[[gnu::always_inline]] inline VectorLanes<Float> rotated(const RigidMotion& X_BA,
                                                         const VectorLanes<Float>& a) {
  const auto& R = X_BA.R;
  return {Float(R[0][0]) * a.x + Float(R[0][1]) * a.y + Float(R[0][2]) * a.z,
          Float(R[1][0]) * a.x + Float(R[1][1]) * a.y + Float(R[1][2]) * a.z,
          Float(R[2][0]) * a.x + Float(R[2][1]) * a.y + Float(R[2][2]) * a.z};
}

/// R' b
template <typename Float>
[[gnu::always_inline]] inline VectorLanes<Float> rotated_back(const RigidMotion& X_BA,
                                                              const VectorLanes<Float>& b) {
  const auto& R = X_BA.R;
  return {Float(R[0][0]) * b.x + Float(R[1][0]) * b.y + Float(R[2][0]) * b.z,
          Float(R[0][1]) * b.x + Float(R[1][1]) * b.y + Float(R[2][1]) * b.z,
          Float(R[0][2]) * b.x + Float(R[1][2]) * b.y + Float(R[2][2]) * b.z};
}

/// R a + t
template <typename Float>
[[gnu::always_inline]] inline VectorLanes<Float> moved(const RigidMotion& X_BA,
                                                       const VectorLanes<Float>& a) {
  const VectorLanes<Float> turned = rotated(X_BA, a);
  return {turned.x + Float(X_BA.t[0]), turned.y + Float(X_BA.t[1]), turned.z + Float(X_BA.t[2])};
}

}  // namespace kintsugi::mapper
