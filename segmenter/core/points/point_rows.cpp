#include "segmenter/core/points/point_rows.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <limits>
#include <utility>

#include <oneapi/tbb/parallel_for.h>

#include "segmenter/core/points/cell.hpp"

namespace kintsugi::segmenter {
namespace {

/// The sort key of a point; unsigned numbers that are ordered as the coordinates they stand for.
struct Key {
  std::uint32_t x;  ///< coordinate
  std::uint32_t y;  ///< of the row
  std::uint32_t z;
  PointIndex index;
};

constexpr std::uint32_t kSignBit = 0x80000000U;

std::uint32_t ordered_bits(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  return (bits & kSignBit) != 0 ? ~bits : bits | kSignBit;
}
std::uint32_t ordered_bits(std::int32_t value) {
  return static_cast<std::uint32_t>(value) ^ kSignBit;
}
std::int32_t from_ordered_bits(std::uint32_t bits) {
  return static_cast<std::int32_t>(bits ^ kSignBit);
}

/// Stable radix sort by one member. Digits that are the same everywhere are skipped.
void sort_by(std::uint32_t Key::*member, GrowingArray<Key>& keys, GrowingArray<Key>& scratch) {
  constexpr int kDigitBits = 11;
  constexpr std::size_t kNumDigits = std::size_t{1} << kDigitBits;
  std::uint32_t varying = 0;
  for (const Key& key : keys) varying |= key.*member ^ (*keys.begin()).*member;
  for (int shift = 0; shift < std::numeric_limits<std::uint32_t>::digits; shift += kDigitBits) {
    const auto digit = [&](std::uint32_t value) { return (value >> shift) & (kNumDigits - 1); };
    if (digit(varying) == 0) continue;
    std::array<std::uint32_t, kNumDigits + 1> next{};
    for (const Key& key : keys) ++next[digit(key.*member) + 1];
    for (std::size_t d = 0; d < kNumDigits; ++d) next[d + 1] += next[d];
    for (const Key& key : keys) scratch[next[digit(key.*member)]++] = key;
    std::swap(keys, scratch);
  }
}

GrowingArray<Key> sorted_keys(std::span<const CloudPoint> points_W,
                              std::span<const PointIndex> points, double cell_m) {
  GrowingArray<Key> keys(points.size());
  oneapi::tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t k) {
    const CloudPoint& p = points_W[points[k]];
    keys[k] = {ordered_bits(p.x), ordered_bits(cell_coordinate(p.y, cell_m)),
               ordered_bits(cell_coordinate(p.z, cell_m)), points[k]};
  });
  GrowingArray<Key> scratch(points.size());
  sort_by(&Key::x, keys, scratch);
  sort_by(&Key::y, keys, scratch);
  sort_by(&Key::z, keys, scratch);
  return keys;
}

}  // namespace

PointRows::PointRows(std::span<const CloudPoint> points_W, std::span<const PointIndex> points,
                     float radius_m)
    : squared_radius_m2_(radius_m * radius_m),
      reach_m_(static_cast<float>(radius_m * kCellsPerRadius)) {
  assert(radius_m > 0.0F);
  const GrowingArray<Key> keys = sorted_keys(points_W, points, radius_m * kCellsPerRadius);
  points_.resize(keys.size());
  oneapi::tbb::parallel_for(std::size_t{0}, keys.size(), [&](std::size_t k) {
    const CloudPoint& p = points_W[keys[k].index];
    points_[k] = {p.x, p.y, p.z, p.nx, p.ny, p.nz, p.red, p.green, p.blue, keys[k].index};
  });
  for (Slot k = 0; k < keys.size(); ++k) {
    const RowStart row{from_ordered_bits(keys[k].z), from_ordered_bits(keys[k].y), k};
    if (rows_.empty() || rows_.back().z != row.z || rows_.back().y != row.y) rows_.push_back(row);
  }
  constexpr std::int32_t kNowhere = std::numeric_limits<std::int32_t>::max();
  rows_.push_back({kNowhere, kNowhere, static_cast<Slot>(keys.size())});
}

std::array<PointRows::Window, 5> PointRows::windows_of(std::size_t row) const {
  std::array<Window, 5> windows;
  std::size_t num_windows = 0;
  const auto add = [&](std::size_t other) {
    const Slot first = rows_[other].first;
    windows.at(num_windows++) = {.begin = first, .end = first, .limit = rows_[other + 1].first};
  };
  const std::int32_t y = rows_[row].y;
  const std::int32_t z = rows_[row].z;
  add(row);
  if (rows_[row + 1].z == z && rows_[row + 1].y == y + 1) add(row + 1);
  for (std::size_t above = find_row(z + 1, y - 1);
       rows_[above].z == z + 1 && rows_[above].y <= y + 1; ++above) {
    add(above);
  }
  return windows;
}

/// The first row at or after (z, y).
std::size_t PointRows::find_row(std::int32_t z, std::int32_t y) const {
  const auto found = std::partition_point(rows_.begin(), rows_.end(), [&](const RowStart& row) {
    return row.z != z ? row.z < z : row.y < y;
  });
  return static_cast<std::size_t>(found - rows_.begin());
}

}  // namespace kintsugi::segmenter
