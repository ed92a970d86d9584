#include "mapper/core/volume/block_table.hpp"

#include <algorithm>
#include <bit>

#include "mapper/core/kernels/volume_access.hpp"

namespace kintsugi::mapper {
namespace {

constexpr int kBrickSide = VolumeAccess::kBrickSide;
constexpr std::size_t kBrickEntries = std::size_t{kBrickSide} * kBrickSide * kBrickSide;

int table_side_for(int side) {
  return static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::max(side, kBrickSide))));
}

std::size_t num_entries(int side) { return static_cast<std::size_t>(side) * side * side; }

}  // namespace

BlockTable::BlockTable(int side)
    : side_(table_side_for(side)),
      memory_(num_entries(side_) * sizeof(std::int32_t), ReservedMemory::HugePages::kNowhere),
      is_brick_used_(num_entries(side_) / kBrickEntries, false) {
  memory_.commit(num_entries(side_) * sizeof(std::int32_t));
}

void BlockTable::set(const BlockCoord& coord, BlockSlot slot) {
  const std::size_t index = index_of(coord);
  reinterpret_cast<std::int32_t*>(memory_.data())[index] = slot + 1;
  if (is_brick_used_[index / kBrickEntries]) return;
  is_brick_used_[index / kBrickEntries] = true;
  ++num_bricks_used_;
}

std::size_t BlockTable::memory_bytes() const {
  return num_bricks_used_ * kBrickEntries * sizeof(std::int32_t) + is_brick_used_.size() / 8;
}

std::size_t BlockTable::index_of(const BlockCoord& coord) const {
  const auto bricks = static_cast<std::size_t>(side_ / kBrickSide);
  const auto wrapped = [this](int c) { return static_cast<std::size_t>(c & (side_ - 1)); };
  const std::size_t x = wrapped(coord.x);
  const std::size_t y = wrapped(coord.y);
  const std::size_t z = wrapped(coord.z);
  const std::size_t brick = (z / kBrickSide * bricks + y / kBrickSide) * bricks + x / kBrickSide;
  const std::size_t in_brick =
      (z % kBrickSide * kBrickSide + y % kBrickSide) * kBrickSide + x % kBrickSide;
  return brick * kBrickEntries + in_brick;
}

}  // namespace kintsugi::mapper
