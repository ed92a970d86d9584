#pragma once
// Cubic cells of space, numbered.

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

namespace kintsugi::segmenter {

/// The number of a cell. Of two cells further than 2^21 cells apart it may be the same.
using CellKey = std::uint64_t;

inline CellKey cell_key(std::int64_t i, std::int64_t j, std::int64_t k) {
  constexpr std::uint64_t kMask = (1U << 21U) - 1;
  const auto low = [](std::int64_t n) { return static_cast<std::uint64_t>(n) & kMask; };
  return (low(i) << 42U) | (low(j) << 21U) | low(k);
}

/// The place of a coordinate among cells of side `cell_m`.
inline std::int64_t cell_of(double coordinate_m, double cell_m) {
  return static_cast<std::int64_t>(std::floor(coordinate_m / cell_m));
}

inline CellKey cell_at(const Eigen::Vector3d& p_W, double cell_m) {
  return cell_key(cell_of(p_W.x(), cell_m), cell_of(p_W.y(), cell_m), cell_of(p_W.z(), cell_m));
}

/// For maps by CellKey: the keys of cells that are side by side differ in few bits.
struct CellKeyHash {
  std::size_t operator()(CellKey key) const {
    key ^= key >> 31U;
    key *= 0x9E3779B97F4A7C15U;
    return static_cast<std::size_t>(key ^ (key >> 29U));
  }
};

}  // namespace kintsugi::segmenter
