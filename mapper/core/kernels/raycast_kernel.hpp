#pragma once
// Sixteen rays at once, those of 4 x 4 neighbouring pixels: they read the same blocks and end after
// about as many steps. Over any pack.
//
// A ray marches from nearest voxel to nearest voxel, as far as the distance there allows, until it
// goes from free space into a surface. Between the last two voxels the crossing is then found in
// the interpolated distance.

#include "mapper/core/kernels/raycast.hpp"
#include "mapper/core/kernels/volume_lanes.hpp"

namespace kintsugi::mapper {

/// Rays by depth along the camera's z: the point at depth d is origin + direction * d.
template <typename Pack>
class RayLanes {
 public:
  using Float = typename Pack::Float;
  using Int = typename Pack::Int;
  using Mask = typename Pack::Mask;
  using Vec3 = Vec3Lanes<Pack>;
  using Volume = VolumeLanes<Pack>;

  /// Depths of the surface; undefined where none was found.
  struct Hits {
    Mask is_found;
    Float depth_m;
  };

  RayLanes(const VolumeLanes<Pack>& volume, float truncation_vox, const float origin_vox[3],
           const Vec3& direction_vox_per_m)
      : volume_(volume),
        truncation_vox_(truncation_vox),
        origin_{Float(origin_vox[0]), Float(origin_vox[1]), Float(origin_vox[2])},
        direction_(direction_vox_per_m),
        exit_x_(direction_.x),
        exit_y_(direction_.y),
        exit_z_(direction_.z),
        voxel_m_(Float(1.0F) / sqrt(direction_.x * direction_.x + direction_.y * direction_.y +
                                    direction_.z * direction_.z)) {}

  Vec3 at(const Float& depth_m) const {
    return {origin_.x + direction_.x * depth_m, origin_.y + direction_.y * depth_m,
            origin_.z + direction_.z * depth_m};
  }

  /// The first crossing from positive to negative distance between two depths; none where a ray is
  /// in a surface from the start.
  Hits find_surface(const Float& from_m, const Float& to_m, const Mask& mask) const {
    const Bracket bracket = march(from_m, to_m, mask);
    if (none(bracket.is_found)) return {bracket.is_found, from_m};
    return refine(bracket);
  }

 private:
  /// Two depths with a surface between them, and the distances there (voxels).
  struct Bracket {
    Mask is_found;
    Float before_m;
    Float after_m;
    Float distance_before;
    Float distance_after;
  };

  /// Of the distance a ray may advance at once: distances were measured along other rays.
  static constexpr float kStepShare = 0.8F;

  Bracket march(const Float& from_m, const Float& to_m, const Mask& mask) const {
    const Float zero(0.0F);
    const Float one(1.0F);
    Bracket bracket{Mask::first(0), from_m, from_m, zero, zero};
    Mask in_free_space = Mask::first(0);
    Mask steps_singly = Mask::first(0);
    Float depth_m = from_m;
    Mask is_marching = mask & (depth_m < to_m);
    while (any(is_marching)) {
      const Vec3 point = at(depth_m);
      const auto [has_block, voxel] = volume_.nearest(point, is_marching);
      const Mask is_seen = is_marching & Volume::is_observed(voxel);
      const Float distance = Volume::distance_of(voxel) * truncation_vox_;

      const Mask is_behind = is_seen & (distance <= zero);
      const Mask is_crossing = is_behind & in_free_space;
      bracket.is_found = bracket.is_found | is_crossing;
      bracket.after_m = select(is_crossing, depth_m, bracket.after_m);
      bracket.distance_after = select(is_crossing, distance, bracket.distance_after);
      is_marching = is_marching & ~is_behind;

      const Mask is_free = is_seen & is_marching;
      bracket.before_m = select(is_free, depth_m, bracket.before_m);
      bracket.distance_before = select(is_free, distance, bracket.distance_before);
      // Out of free space into what was never seen: perhaps a step through a surface seen at a
      // grazing angle, whose distances are too large. Take it again in single voxels.
      const Mask is_retried = is_marching & ~is_free & in_free_space & ~steps_singly;
      steps_singly = steps_singly | is_retried;
      in_free_space = is_free | is_retried;

      const Float allowed = select(steps_singly, one, truncation_vox_);
      const Float share = max(min(distance * Float(kStepShare), allowed), one);
      const Float step_vox = select(is_free, share, one);
      const Float advanced = select(is_retried, bracket.before_m, depth_m) + step_vox * voxel_m_;
      const Mask is_leaving = is_marching & ~has_block & ~is_retried;
      depth_m = any(is_leaving) ? select(is_leaving, depth_of_block_exit(point, depth_m), advanced)
                                : advanced;
      is_marching = is_marching & (depth_m < to_m);
    }
    return bracket;
  }

  /// The bracket's distances are those of the nearest voxels, so its first guess is up to a voxel
  /// off: one Newton step with its slope, then one secant step through the two interpolated values.
  Hits refine(const Bracket& bracket) const {
    const Float slope =
        (bracket.distance_after - bracket.distance_before) / (bracket.after_m - bracket.before_m);
    const Float first_m = bracket.before_m - bracket.distance_before / slope;
    const auto at_first = volume_.distance(at(first_m), bracket.is_found);
    const Float first = at_first.distance * truncation_vox_;

    const Float second_m = first_m + newton_step(first, slope);
    const auto at_second = volume_.distance(at(second_m), at_first.is_known);
    const Float second = at_second.distance * truncation_vox_;

    const Float secant = (second - first) / (second_m - first_m);
    const Mask is_usable = (secant < Float(0.0F)) & (secant > Float(kSteepest));
    return {at_second.is_known, second_m + newton_step(second, select(is_usable, secant, slope))};
  }

  /// Metres to where a line of this slope is zero, at most a voxel.
  Float newton_step(const Float& distance, const Float& slope) const {
    const Float zero(0.0F);
    return max(min((zero - distance) / slope, voxel_m_), zero - voxel_m_);
  }

  /// Voxels per metre that no distance falls by: below this two depths were the same.
  static constexpr float kSteepest = -1e30F;

  /// What a ray has to do with the faces of blocks across one axis.
  struct ExitLanes {
    explicit ExitLanes(const Float& direction)
        : far_face(select(direction < Float(0.0F), Float(0.0F), Float(kSide))),
          m_per_vox(select(direction == Float(0.0F), Float(kNever), Float(1.0F) / direction)) {}

    static constexpr float kSide = 8.0F;    // kBlockSide
    static constexpr float kNever = 1e30F;  // a ray that does not move along this axis

    /// From a coordinate to where the ray leaves its block across this axis.
    Float advance_m(const Float& coordinate) const {
      const Float lower = floor(coordinate * Float(1.0F / kSide)) * Float(kSide);
      return (lower + far_face - coordinate) * m_per_vox;
    }

    Float far_face;  ///< of the face through which the ray leaves, from the block's lower face
    Float m_per_vox;
  };

  Float depth_of_block_exit(const Vec3& point, const Float& depth_m) const {
    constexpr float kBeyond_vox = 0.01F;
    const Float advance_m = min(min(exit_x_.advance_m(point.x), exit_y_.advance_m(point.y)),
                                exit_z_.advance_m(point.z));
    return depth_m + max(advance_m, Float(0.0F)) + Float(kBeyond_vox) * voxel_m_;
  }

  const VolumeLanes<Pack>& volume_;
  Float truncation_vox_;
  Vec3 origin_;
  Vec3 direction_;
  ExitLanes exit_x_;
  ExitLanes exit_y_;
  ExitLanes exit_z_;
  Float voxel_m_;  ///< depth in which a ray advances by one voxel
};

template <typename Pack>
class TileRaycast {
 public:
  TileRaycast(const RaycastVolume& volume, const RaycastView& view)
      : volume_(volume),
        view_(view),
        camera_(view.camera),
        truncation_vox_(volume.truncation_vox) {}

  void cast(const RaycastTile& tile) const {
    for (int dv = 0; dv < RaycastTile::kSide_px; dv += kGroupSide) {
      for (int du = 0; du < RaycastTile::kSide_px; du += kGroupSide) {
        const int u = tile.u + du;
        const int v = tile.v + dv;
        if (u < camera_.width && v < camera_.height) cast_group(u, v, tile);
      }
    }
  }

 private:
  using Float = typename Pack::Float;
  using Int = typename Pack::Int;
  using Mask = typename Pack::Mask;
  using Vec3 = Vec3Lanes<Pack>;
  using Rays = RayLanes<Pack>;
  using Hits = typename Rays::Hits;

  static constexpr int kGroupBits = 2;
  static constexpr int kGroupSide = 1 << kGroupBits;  ///< pixels
  static_assert(kGroupSide * kGroupSide == Pack::kNumLanes);
  static_assert(RaycastTile::kSide_px % kGroupSide == 0);

  void cast_group(int u, int v, const RaycastTile& tile) const {
    const Int column = Int(u) + (Int::iota() & Int(kGroupSide - 1));
    const Int row = Int(v) + shift_right<kGroupBits>(Int::iota());
    const Mask is_in_image = (column < Int(camera_.width)) & (row < Int(camera_.height));
    const Float x = (to_float(column) - Float(camera_.cx)) * Float(camera_.inverse_fx);
    const Float y = (to_float(row) - Float(camera_.cy)) * Float(camera_.inverse_fy);
    const Vec3 direction{along_axis(0, x, y), along_axis(1, x, y), along_axis(2, x, y)};
    const Rays rays(volume_, truncation_vox_, view_.origin_vox, direction);
    const Hits hits = cast_rays(rays, guide(column, row, is_in_image), tile, is_in_image);
    store(select(hits.is_found, hits.depth_m, Float(kNan)), view_.depth_m, u, v);
  }

  Float along_axis(int axis, const Float& x, const Float& y) const {
    const float* vox_per_m = view_.vox_per_m[axis];
    return Float(vox_per_m[0]) * x + Float(vox_per_m[1]) * y + Float(vox_per_m[2]);
  }

  /// The guide's depths under pixels; zero or NaN where there is none.
  Float guide(const Int& column, const Int& row, const Mask& mask) const {
    if (view_.guide_m == nullptr) return Float(0.0F);
    const auto scaled = [](const Int& index, int from, int to) {
      const float scale = static_cast<float>(to) / static_cast<float>(from);
      const Int nearest = to_int((to_float(index) + Float(0.5F)) * Float(scale));
      return min(nearest, Int(to - 1));
    };
    const Int guide_column = scaled(column, camera_.width, view_.guide_columns);
    const Int guide_row = scaled(row, camera_.height, view_.guide_rows);
    return gather(view_.guide_m, guide_row * Int(view_.guide_columns) + guide_column, mask);
  }

  /// Searches from just before the guide first; where that finds nothing, the whole ray.
  Hits cast_rays(const Rays& rays, const Float& guide_m, const RaycastTile& tile,
                 const Mask& mask) const {
    const Float near_m(tile.near_m);
    const Float far_m(tile.far_m);
    const Float start_m = guide_m - Float(view_.guide_margin_m);
    const Mask is_guided = mask & (start_m > near_m) & (start_m < far_m);
    const Hits hits = rays.find_surface(select(is_guided, start_m, near_m), far_m, mask);
    const Mask is_missed = is_guided & ~hits.is_found;
    if (none(is_missed)) return hits;
    const Hits others = rays.find_surface(near_m, far_m, is_missed);
    return {hits.is_found | others.is_found, select(is_missed, others.depth_m, hits.depth_m)};
  }

  void store(const Float& values, float* plane, int u, int v) const {
    float lanes[Pack::kNumLanes];
    values.store(lanes);
    for (int i = 0; i < Pack::kNumLanes; ++i) {
      const int column = u + i % kGroupSide;
      const int row = v + i / kGroupSide;
      if (column < camera_.width && row < camera_.height) {
        plane[row * camera_.width + column] = lanes[i];
      }
    }
  }

  static constexpr float kNan = __builtin_nanf("");

  VolumeLanes<Pack> volume_;
  const RaycastView& view_;
  const PinholeCamera& camera_;
  float truncation_vox_;
};

template <typename Pack>
void raycast_tile(const RaycastVolume& volume, const RaycastView& view, const RaycastTile& tile) {
  TileRaycast<Pack>(volume, view).cast(tile);
}

}  // namespace kintsugi::mapper
