#pragma once

#include <compare>

#include "mapper/core/slices/tile.hpp"

namespace kintsugi::mapper {

/// A time during which the volume held surface of a tile. Each has a patch of its own.
struct TileVisit {
  static constexpr int kOpen = -1;

  TileCoord tile;
  /// Closed visits of a tile are numbered from 0, in the order in which they were closed.
  int number = kOpen;

  // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 sees a pointer in the defaulted body
  auto operator<=>(const TileVisit&) const = default;
};

}  // namespace kintsugi::mapper
