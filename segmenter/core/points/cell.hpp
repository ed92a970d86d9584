#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace kintsugi::segmenter {

/// Integer coordinates of a cube in a regular grid over W.
struct Cell {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;

  bool operator==(const Cell&) const = default;
};

struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    std::uint64_t h = static_cast<std::uint32_t>(cell.x);
    h = h * 0x9E3779B97F4A7C15ULL + static_cast<std::uint32_t>(cell.y);
    h = h * 0x9E3779B97F4A7C15ULL + static_cast<std::uint32_t>(cell.z);
    h *= 0x9E3779B97F4A7C15ULL;
    return h ^ (h >> 32);
  }
};

/// The cell coordinate of `value_m` in a grid of cells of size `cell_m`. All coordinates beyond
/// 2^28 cells get the last one. The result never decreases with `value_m`, so that a search by
/// cells is complete there, too.
inline std::int32_t cell_coordinate(double value_m, double cell_m) {
  constexpr double kLast = 1 << 28;
  return static_cast<std::int32_t>(std::clamp(std::floor(value_m / cell_m), -kLast, kLast));
}

/// Two neighbours may be further apart than r by a rounding error of float32 (relative: about
/// 2^-22). Cells that are wider than r by this factor keep them in adjacent cells.
inline constexpr double kCellsPerRadius = 1.0 + 1e-5;

}  // namespace kintsugi::segmenter
