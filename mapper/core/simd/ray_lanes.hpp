#pragma once
// Sphere tracing of sixteen rays at once, over any pack: steps by the distance of the nearest voxel
// until the sign changes, then finds where the interpolated distance is zero.

#include "mapper/core/kernels/block_layout.hpp"
#include "mapper/core/simd/volume_lanes.hpp"

namespace kintsugi::mapper {

/// Rays in cube coordinates, parametrised by depth along the camera's z: the point at depth d is
/// origin + direction * d.
template <typename Pack>
class RayLanes {
 public:
  using Float = typename Pack::Float;
  using Vec3 = Vec3Lanes<Pack>;

  RayLanes(const float origin_vox[3], const Vec3& direction_vox_per_m)
      : origin_{Float(origin_vox[0]), Float(origin_vox[1]), Float(origin_vox[2])},
        direction_(direction_vox_per_m),
        faces_x_(direction_.x),
        faces_y_(direction_.y),
        faces_z_(direction_.z),
        voxel_m_(Float(1.0F) / sqrt(direction_.x * direction_.x + direction_.y * direction_.y +
                                    direction_.z * direction_.z)) {}

  Vec3 at(const Float& depth_m) const {
    return {origin_.x + direction_.x * depth_m, origin_.y + direction_.y * depth_m,
            origin_.z + direction_.z * depth_m};
  }

  /// The step in depth by which a ray advances by one voxel's side.
  const Float& voxel_m() const { return voxel_m_; }

  /// A depth just behind where each ray leaves the block in which `point`, its point at `depth_m`,
  /// lies.
  Float depth_of_block_exit(const Vec3& point, const Float& depth_m) const {
    constexpr float kBeyond_vox = 0.01F;
    const Float advance_m = min(min(faces_x_.advance_m(point.x), faces_y_.advance_m(point.y)),
                                faces_z_.advance_m(point.z));
    return depth_m + max(advance_m, Float(0.0F)) + Float(kBeyond_vox) * voxel_m_;
  }

 private:
  /// The faces of blocks that are perpendicular to one axis.
  struct Faces {
    explicit Faces(const Float& direction)
        : exit_vox(select(direction < Float(0.0F), Float(0.0F), Float(kSide))),
          m_per_vox(select(direction == Float(0.0F), Float(kNever), Float(1.0F) / direction)) {}

    static constexpr float kSide = BlockLayout::kSide;
    static constexpr float kNever = 1e30F;  // the ray is parallel to these faces

    /// Step in depth from a coordinate to the face through which the ray leaves its block.
    Float advance_m(const Float& coordinate) const {
      const Float lower = floor(coordinate * Float(1.0F / kSide)) * Float(kSide);
      return (lower + exit_vox - coordinate) * m_per_vox;
    }

    Float exit_vox;  ///< from the block's lower face
    Float m_per_vox;
  };

  Vec3 origin_;
  Vec3 direction_;
  Faces faces_x_;
  Faces faces_y_;
  Faces faces_z_;
  Float voxel_m_;
};

/// Searches each ray for its first crossing from positive to negative distance. A ray that starts
/// behind a surface finds none.
template <typename Pack>
class RayMarch {
 public:
  using Float = typename Pack::Float;
  using Int = typename Pack::Int;
  using Mask = typename Pack::Mask;
  using Rays = RayLanes<Pack>;
  using Vec3 = Vec3Lanes<Pack>;
  using Volume = VolumeLanes<Pack>;

  /// Depths of the surface; undefined where is_found is false.
  struct Hits {
    Mask is_found;
    Float depth_m;
  };

  RayMarch(const Volume& volume, const Rays& rays)
      : volume_(volume), truncation_vox_(volume.truncation_vox()), rays_(rays) {}

  /// Begins a search between two depths for the rays of the mask, and drops earlier results.
  void start(const Float& from_m, const Float& to_m, const Mask& mask) {
    depth_m_ = from_m;
    end_m_ = to_m;
    is_marching_ = mask & (from_m < to_m);
    is_found_ = in_free_space_ = steps_singly_ = Mask::first(0);
  }

  bool is_going() const { return any(is_marching_); }

  /// Each ray that is still marching reads one voxel and advances.
  void step() {
    const Vec3 point = rays_.at(depth_m_);
    const auto [has_block, voxel] = volume_.nearest(point, is_marching_);
    const Mask is_seen = is_marching_ & Volume::is_observed(voxel);
    const Float distance = Volume::distance_of(voxel) * truncation_vox_;

    const Mask is_behind = is_seen & (distance <= Float(0.0F));
    const Mask is_crossing = is_behind & in_free_space_;
    is_found_ = is_found_ | is_crossing;
    after_m_ = select(is_crossing, depth_m_, after_m_);
    distance_after_ = select(is_crossing, distance, distance_after_);
    is_marching_ = is_marching_ & ~is_behind;

    const Mask is_free = is_seen & is_marching_;
    before_m_ = select(is_free, depth_m_, before_m_);
    distance_before_ = select(is_free, distance, distance_before_);
    // From free space into unobserved space: this may be a step through a surface that was seen at
    // a grazing angle, where stored distances are too large. Repeat the step in single voxels.
    const Mask is_retried = is_marching_ & ~is_free & in_free_space_ & ~steps_singly_;
    steps_singly_ = steps_singly_ | is_retried;
    in_free_space_ = is_free | is_retried;

    const Float one(1.0F);
    const Float most_vox = select(steps_singly_, one, volume_.max_step_vox());
    const Float share_vox = max(min(distance * Float(kStepShare), most_vox), one);
    const Float step_vox = select(is_free, share_vox, one);
    const Float from_m = select(is_retried, before_m_, depth_m_);
    Float next_m = from_m + step_vox * rays_.voxel_m();
    const Mask is_leaving = is_marching_ & ~has_block & ~is_retried;
    if (any(is_leaving)) {
      next_m = select(is_leaving, rays_.depth_of_block_exit(point, depth_m_), next_m);
    }
    depth_m_ = next_m;
    is_marching_ = is_marching_ & (depth_m_ < end_m_);
  }

  /// To be called when no ray is marching any more. The distances before and after the crossing are
  /// those of the nearest voxels, so the first guess between them is wrong by up to a voxel: one
  /// Newton step with their slope follows, then one secant step through the two interpolated
  /// values.
  Hits refine() const {
    if (none(is_found_)) return {is_found_, depth_m_};
    const Float slope = (distance_after_ - distance_before_) / (after_m_ - before_m_);
    const Float first_m = before_m_ - distance_before_ / slope;
    const auto at_first = volume_.distance(rays_.at(first_m), is_found_);
    const Float first = at_first.distance * truncation_vox_;

    const Float second_m = first_m + newton_step_m(first, slope);
    const auto at_second = volume_.distance(rays_.at(second_m), at_first.is_known);
    const Float second = at_second.distance * truncation_vox_;

    const Float secant = (second - first) / (second_m - first_m);
    const Mask is_usable = (secant < Float(0.0F)) & (secant > Float(kSteepest));
    return {at_second.is_known, second_m + newton_step_m(second, select(is_usable, secant, slope))};
  }

 private:
  /// A ray advances by this share of the distance: it was measured along other rays.
  static constexpr float kStepShare = 0.8F;
  /// Voxels per metre: a steeper slope means that both depths were the same.
  static constexpr float kSteepest = -1e30F;

  /// The step to where a line of this slope is zero, at most a voxel.
  Float newton_step_m(const Float& distance, const Float& slope) const {
    const Float zero(0.0F);
    return max(min((zero - distance) / slope, rays_.voxel_m()), zero - rays_.voxel_m());
  }

  const Volume& volume_;
  Float truncation_vox_;
  Rays rays_;
  Float depth_m_;
  Float end_m_;
  Mask is_marching_;
  Mask in_free_space_;
  Mask steps_singly_;
  Mask is_found_;
  Float before_m_ = Float(0.0F);         ///< last depth in free space
  Float after_m_ = Float(0.0F);          ///< first depth behind the surface
  Float distance_before_ = Float(0.0F);  ///< voxels, at before_m_
  Float distance_after_ = Float(0.0F);   ///< voxels, at after_m_
};

}  // namespace kintsugi::mapper
