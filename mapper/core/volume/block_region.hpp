#pragma once

#include <cstdint>

#include "mapper/core/volume/tsdf_block.hpp"

namespace kintsugi::mapper {

enum class RegionShape : std::uint8_t {
  kBall,  ///< all that is near the camera, whichever way it looks
  kCube,
};

/// The blocks that can be in a volume at one time: a cube of blocks, or the ball inside it.
struct BlockRegion {
  RegionShape shape = RegionShape::kCube;
  /// The cube is blocks min .. min + side - 1 along each axis; side 0: the region is empty.
  BlockCoord min;
  int side = 0;  ///< odd for a ball, whose middle is the middle of a block

  bool contains(const BlockCoord& coord) const {
    const auto length = static_cast<unsigned>(side);
    const bool is_in_cube = static_cast<unsigned>(coord.x - min.x) < length &&
                            static_cast<unsigned>(coord.y - min.y) < length &&
                            static_cast<unsigned>(coord.z - min.z) < length;
    if (!is_in_cube || shape == RegionShape::kCube) return is_in_cube;
    return is_in_ball(offset_of(coord));
  }

  /// Whether a block is in the region or shares a face, an edge or a corner with it.
  bool touches(const BlockCoord& coord) const {
    if (side == 0) return false;
    if (shape == RegionShape::kCube) {
      return BlockRegion{shape, make_block_coord(min.x - 1, min.y - 1, min.z - 1), side + 2}
          .contains(coord);
    }
    const auto towards_middle = [](int c) { return c > 0 ? c - 1 : (c < 0 ? c + 1 : 0); };
    const BlockCoord offset = offset_of(coord);
    return is_in_ball(make_block_coord(towards_middle(offset.x), towards_middle(offset.y),
                                       towards_middle(offset.z)));
  }

 private:
  /// From the block in the middle of a ball.
  BlockCoord offset_of(const BlockCoord& coord) const {
    const int radius = side / 2;
    return make_block_coord(coord.x - min.x - radius, coord.y - min.y - radius,
                            coord.z - min.z - radius);
  }
  bool is_in_ball(const BlockCoord& offset) const {
    const auto square = [](int c) { return std::int64_t{c} * c; };
    return square(offset.x) + square(offset.y) + square(offset.z) <= square(side / 2);
  }
};

}  // namespace kintsugi::mapper
