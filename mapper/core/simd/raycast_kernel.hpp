#pragma once
// RaycastTileFunction over any pack: four groups of sixteen rays.

#include "mapper/core/kernels/raycast.hpp"
#include "mapper/core/simd/ray_lanes.hpp"

namespace kintsugi::mapper {

/// The rays of 4 x 4 neighbouring pixels, which read the same blocks and need about the same number
/// of steps.
template <typename Pack>
class PixelGroup {
 public:
  static constexpr int kSideBits = 2;
  static constexpr int kSide = 1 << kSideBits;
  static_assert(kSide * kSide == Pack::kNumLanes);

  /// Pixels [u, u + 4) x [v, v + 4), clipped to the image.
  PixelGroup(const VolumeLanes<Pack>& volume, const RaycastArguments& arguments,
             const RaycastTile& tile, int u, int v)
      : in_(arguments),
        camera_(arguments.camera),
        first_u_(u),
        first_v_(v),
        near_m_(tile.near_m),
        far_m_(tile.far_m),
        u_(Int(u) + (Int::iota() & Int(kSide - 1))),
        v_(Int(v) + shift_right<kSideBits>(Int::iota())),
        is_in_image_((u_ < Int(camera_.width)) & (v_ < Int(camera_.height))),
        march_(volume, RayLanes<Pack>(arguments.origin_vox, direction())) {}

  /// Rays with a guide start just before it, the others at the tile's near_m.
  void start() {
    const Float start_m = guide_m() - Float(in_.guide_margin_m);
    is_guided_ = is_in_image_ & (start_m > near_m_) & (start_m < far_m_);
    march_.start(select(is_guided_, start_m, near_m_), far_m_, is_in_image_);
  }
  /// After finish(): searches the whole ray where the guided search found no surface.
  void start_again() { march_.start(near_m_, far_m_, is_guided_ & ~hits_.is_found); }

  bool is_going() const { return march_.is_going(); }
  void step() { march_.step(); }
  void finish() {
    const Hits hits = march_.refine();
    hits_ = {hits_.is_found | hits.is_found, select(hits.is_found, hits.depth_m, hits_.depth_m)};
  }

  void store_depths() const {
    float depths_m[Pack::kNumLanes];
    select(hits_.is_found, hits_.depth_m, Float(kNan)).store(depths_m);
    for (int i = 0; i < Pack::kNumLanes; ++i) {
      const int u = first_u_ + i % kSide;
      const int v = first_v_ + i / kSide;
      if (u < camera_.width && v < camera_.height) in_.depth_m[v * camera_.width + u] = depths_m[i];
    }
  }

 private:
  using Float = typename Pack::Float;
  using Int = typename Pack::Int;
  using Mask = typename Pack::Mask;
  using Hits = typename RayMarch<Pack>::Hits;

  static constexpr float kNan = __builtin_nanf("");

  Vec3Lanes<Pack> direction() const {
    const Float x = (to_float(u_) - Float(camera_.cx)) * Float(camera_.inverse_fx);
    const Float y = (to_float(v_) - Float(camera_.cy)) * Float(camera_.inverse_fy);
    const auto along_axis = [&](const float vox_per_m[3]) {
      return Float(vox_per_m[0]) * x + Float(vox_per_m[1]) * y + Float(vox_per_m[2]);
    };
    return {along_axis(in_.vox_per_m[0]), along_axis(in_.vox_per_m[1]),
            along_axis(in_.vox_per_m[2])};
  }

  /// The guide's depths under the pixels; zero or NaN where there is none.
  Float guide_m() const {
    if (in_.guide_m == nullptr) return Float(0.0F);
    const auto scaled = [](const Int& index, int from, int to) {
      const float scale = static_cast<float>(to) / static_cast<float>(from);
      return min(to_int((to_float(index) + Float(0.5F)) * Float(scale)), Int(to - 1));
    };
    const Int column = scaled(u_, camera_.width, in_.guide_columns);
    const Int row = scaled(v_, camera_.height, in_.guide_rows);
    return gather(in_.guide_m, row * Int(in_.guide_columns) + column, is_in_image_);
  }

  const RaycastArguments& in_;
  const PinholeCamera& camera_;
  int first_u_;
  int first_v_;
  Float near_m_;
  Float far_m_;
  Int u_;
  Int v_;
  Mask is_in_image_;
  Mask is_guided_ = Mask::first(0);
  RayMarch<Pack> march_;
  Hits hits_{Mask::first(0), Float(0.0F)};
};

/// The groups take steps in turns, so that the processor can compute for one group while it waits
/// for the voxels of another.
template <typename Pack, int kNumGroups>
void find_surfaces(PixelGroup<Pack> (&groups)[kNumGroups]) {
  bool is_going = true;
  while (is_going) {
    is_going = false;
    for (PixelGroup<Pack>& group : groups) {
      if (!group.is_going()) continue;
      group.step();
      is_going = true;
    }
  }
  for (PixelGroup<Pack>& group : groups) group.finish();
}

template <typename Pack>
void raycast_tile(const VolumeAccess& access, const RaycastArguments& arguments,
                  const RaycastTile& tile) {
  constexpr int kSide = PixelGroup<Pack>::kSide;
  static_assert(RaycastTile::kSide_px == 2 * kSide);
  const VolumeLanes<Pack> volume(access);
  PixelGroup<Pack> groups[] = {{volume, arguments, tile, tile.u, tile.v},
                               {volume, arguments, tile, tile.u + kSide, tile.v},
                               {volume, arguments, tile, tile.u, tile.v + kSide},
                               {volume, arguments, tile, tile.u + kSide, tile.v + kSide}};
  for (PixelGroup<Pack>& group : groups) group.start();
  find_surfaces(groups);
  for (PixelGroup<Pack>& group : groups) group.start_again();
  find_surfaces(groups);
  for (const PixelGroup<Pack>& group : groups) group.store_depths();
}

}  // namespace kintsugi::mapper
