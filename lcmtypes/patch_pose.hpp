#pragma once
// Where a patch is in the corrected map, in the numbers that go over the bus.

#include <cstdint>

#include "lcmtypes/geometry.hpp"

namespace kintsugi {

/// X_WP, the pose of the frame P of a patch in W, in the numbers that go over the bus: whoever
/// computes with it, before or behind the bus, has the same bits.
struct PatchPose {
  float t_WP[3] = {};                        ///< metres
  float q_WP[4] = {0.0F, 0.0F, 0.0F, 1.0F};  ///< x y z w; of unit length within 1e-5

  PatchPose() = default;
  /// Rounds. Implicit, so that a pose can be assigned.
  PatchPose(const Pose& X_WP);  // NOLINT(google-explicit-constructor)

  /// In double precision, the quaternion normalised there.
  [[nodiscard]] Pose pose() const;
  /// Exactly: then P is W, and points keep their bits.
  [[nodiscard]] bool is_identity() const;

  /// Of the quaternion.
  [[nodiscard]] double length() const;
  /// Within the bounds of the contract.
  [[nodiscard]] bool is_valid() const;

  bool operator==(const PatchPose&) const = default;

  /// Of the length: rounding to float changes it by 1e-7 at most.
  static constexpr double kUnitTolerance = 1e-5;
};

/// The pose that a correction of the map gives a patch; also its layout on the bus (32 bytes,
/// little-endian, no padding).
struct PatchMotion {
  std::int32_t id = 0;  ///< of the patch: CloudSlice::id, >= 0
  PatchPose X_WP;

  bool operator==(const PatchMotion&) const = default;
};
static_assert(sizeof(PatchMotion) == 32, "another layout: raise kCloudPointVersion");

/// A loop: two keyframes that show the same place, and where the camera was at each of them; also
/// its layout on the bus (32 bytes, little-endian, no padding).
struct LoopLink {
  std::int32_t later = 0;    ///< number of a keyframe, >= 0
  std::int32_t earlier = 0;  ///< of another one
  float later_W[3] = {};     ///< metres
  float earlier_W[3] = {};

  bool operator==(const LoopLink&) const = default;
};
static_assert(sizeof(LoopLink) == 32, "another layout: raise kCloudPointVersion");

}  // namespace kintsugi
