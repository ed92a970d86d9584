#pragma once
// Reads the volume at sixteen points at once, over any pack. Points are in cube coordinates,
// voxels.

#include "mapper/core/kernels/block_layout.hpp"
#include "mapper/core/kernels/volume_access.hpp"

namespace kintsugi::mapper {

/// Sixteen points or directions, by their coordinates.
template <typename Pack>
struct Vec3Lanes {
  typename Pack::Float x, y, z;
};

template <typename Pack>
class VolumeLanes {
 public:
  using Float = typename Pack::Float;
  using Int = typename Pack::Int;
  using Mask = typename Pack::Mask;
  using Vec3 = Vec3Lanes<Pack>;

  struct Nearest {
    Mask has_block;
    Int voxel;  ///< 0, which means never observed, where there is no block
  };
  struct Sample {
    Mask is_known;
    Float distance;  ///< as a fraction of truncation_vox()
  };

  explicit VolumeLanes(const VolumeAccess& volume) : volume_(volume) {}

  Float truncation_vox() const { return Float(volume_.truncation_vox); }
  Float max_step_vox() const { return Float(volume_.max_step_vox); }

  static Float distance_of(const Int& voxel) {
    return to_float(shift_right_signed<16>(shift_left<16>(voxel))) *
           Float(1.0F / BlockLayout::kDistanceScale);
  }
  static Mask is_observed(const Int& voxel) { return shift_right<16>(voxel) != Int(0); }

  /// True where the block with these cube coordinates is inside the cube but does not exist.
  Mask is_missing(const Int& x, const Int& y, const Int& z, const Mask& mask) const {
    const Mask is_inside = mask & is_in_cube(x, y, z, x, y, z);
    const Int place = table_index<0>(x) + table_index<1>(y) + table_index<2>(z);
    return is_inside & (gather(volume_.entries, place, is_inside) == Int(0));
  }

  /// The voxels in which the points lie.
  Nearest nearest(const Vec3& point, const Mask& mask) const {
    const Coordinate x = locate<0>(to_int(floor(point.x)));
    const Coordinate y = locate<1>(to_int(floor(point.y)));
    const Coordinate z = locate<2>(to_int(floor(point.z)));
    const Mask is_inside = mask & is_in_cube(x.block, y.block, z.block, x.block, y.block, z.block);
    const Int slot = slot_at(x.table + y.table + z.table, is_inside);
    const Mask has_block = is_inside & (slot > Int(-1));
    const Int index = shift_left<BlockLayout::kVoxelBits>(slot) + (x.voxel + y.voxel + z.voxel);
    return {has_block, gather(volume_.voxels, index, has_block)};
  }

  /// Trilinear interpolation; known where all eight voxels around the point were observed.
  Sample distance(const Vec3& point, const Mask& mask) const {
    const Cell x = cell<0>(point.x);
    const Cell y = cell<1>(point.y);
    const Cell z = cell<2>(point.z);
    Mask is_known = mask & is_in_cube(x.at[0].block, y.at[0].block, z.at[0].block, x.at[1].block,
                                      y.at[1].block, z.at[1].block);

    const Int first_slot = slot_at(x.at[0].table + y.at[0].table + z.at[0].table, is_known);
    is_known = is_known & (first_slot > Int(-1));
    Float corners[8];
    for (int i = 0; i < 8; ++i) {
      const Coordinate& cx = x.at[i & 1];
      const Coordinate& cy = y.at[(i >> 1) & 1];
      const Coordinate& cz = z.at[i >> 2];
      // Most cells lie in one block.
      Int slot = first_slot;
      const Mask is_elsewhere =
          is_known & (((cx.block != x.at[0].block) | (cy.block != y.at[0].block)) |
                      (cz.block != z.at[0].block));
      if (any(is_elsewhere)) {
        const Int other = slot_at(cx.table + cy.table + cz.table, is_elsewhere);
        slot = select(is_elsewhere, other, slot);
        is_known = is_known & (slot > Int(-1));
      }
      const Int index =
          shift_left<BlockLayout::kVoxelBits>(slot) + (cx.voxel + cy.voxel + cz.voxel);
      const Int voxel = gather(volume_.voxels, index, is_known);
      is_known = is_known & is_observed(voxel);
      corners[i] = distance_of(voxel);
    }
    const Float near = mix(mix(corners[0], corners[1], x.fraction),
                           mix(corners[2], corners[3], x.fraction), y.fraction);
    const Float far = mix(mix(corners[4], corners[5], x.fraction),
                          mix(corners[6], corners[7], x.fraction), y.fraction);
    return {is_known, mix(near, far, z.fraction)};
  }

 private:
  /// One coordinate of a voxel: its block, and its terms of the index into the table of slots and
  /// of the index of the voxel in its block.
  struct Coordinate {
    Int block;  ///< in cube coordinates
    Int table;
    Int voxel;
  };
  /// Two neighbouring voxels along one axis, and how far the point is from the centre of the first.
  struct Cell {
    Coordinate at[2];
    Float fraction;
  };

  /// The slots of the blocks at places of the table; -1 where there is none.
  Int slot_at(const Int& place, const Mask& mask) const {
    return gather(volume_.entries, place, mask) - Int(1);
  }

  template <int kAxis>
  Int table_index(const Int& block) const {
    constexpr int kSide = VolumeAccess::kBrickSide;
    const int bricks = volume_.table_side / kSide;
    const int pitch = kSide * kSide * (kAxis == 0 ? 1 : kAxis == 1 ? bricks : bricks * bricks);
    const Int place = block + Int(volume_.min_block[kAxis]);
    const Int in_brick = place & Int(kSide - 1);
    const Int brick = place & Int(volume_.table_side - kSide);  // times kSide
    return shift_left<kAxis * VolumeAccess::kBrickSideBits>(in_brick) + brick * Int(pitch);
  }

  template <int kAxis>
  Coordinate locate(const Int& voxel) const {
    const Int block = shift_right_signed<BlockLayout::kSideBits>(voxel);
    const Int local = voxel & Int(BlockLayout::kSide - 1);
    return {block, table_index<kAxis>(block), shift_left<kAxis * BlockLayout::kSideBits>(local)};
  }

  template <int kAxis>
  Cell cell(const Float& coordinate) const {
    const Float from_center = coordinate - Float(0.5F);
    const Float corner = floor(from_center);
    const Int first = to_int(corner);
    return {{locate<kAxis>(first), locate<kAxis>(first + Int(1))}, from_center - corner};
  }

  /// Whether all blocks from the low to the high coordinates are in the cube.
  Mask is_in_cube(const Int& low_x, const Int& low_y, const Int& low_z, const Int& high_x,
                  const Int& high_y, const Int& high_z) const {
    const Int lowest = low_x | low_y | low_z;  // negative where one of the three is negative
    const Int highest = max(max(high_x, high_y), high_z);
    return (lowest > Int(-1)) & (highest < Int(volume_.side_blocks));
  }

  static Float mix(const Float& a, const Float& b, const Float& fraction) {
    return a + fraction * (b - a);
  }

  const VolumeAccess& volume_;
};

}  // namespace kintsugi::mapper
