#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mapper/synthetic/scene/scene.hpp"

namespace kintsugi::segmenter::bench {

/// Sizes of the building, metres: a corridor along x from 0, its axis at y = 0, and rooms on both
/// sides, each with a doorway in the middle.
inline constexpr double kRoomWidth_m = 4.6;
inline constexpr double kRoomDepth_m = 4.0;
inline constexpr double kCorridorWidth_m = 2.0;

inline int rooms_per_side(int num_rooms) { return (num_rooms + 1) / 2; }
inline double corridor_length_m(int num_rooms) { return kRoomWidth_m * rooms_per_side(num_rooms); }

/// The scene: floor, ceiling, walls and furniture.
synthetic::Scene make_building(int num_rooms, std::uint32_t seed);

/// The path of the cube: along the corridor, into each room and around in it, and back. Corners of
/// a closed path, x and y, metres.
std::vector<std::array<double, 2>> walk_through(int num_rooms);

}  // namespace kintsugi::segmenter::bench
