#include "mapper/core/volume/tsdf_block_pool.hpp"

#include <cassert>
#include <mutex>
#include <utility>

#include "lcmtypes/base/reserved_memory.hpp"

namespace kintsugi::mapper {

struct TsdfBlockPool::Memory {
  ReservedMemory voxels{kMaxBlocks * sizeof(VoxelBlock)};
  ReservedMemory colors{kMaxBlocks * sizeof(ColorBlock)};
};

/// Slots whose loan ended; collected when the pool needs a slot.
struct TsdfBlockPool::Returns {
  std::mutex mutex;
  std::vector<BlockSlot> slots;
};

struct TsdfBlockPool::Loan {
  std::vector<BlockSlot> slots;
  std::shared_ptr<Memory> memory;
  std::shared_ptr<Returns> returns;

  ~Loan() {
    const std::scoped_lock lock(returns->mutex);
    returns->slots.insert(returns->slots.end(), slots.begin(), slots.end());
  }
};

TsdfBlockPool::TsdfBlockPool()
    : memory_(std::make_shared<Memory>()),
      voxels_(reinterpret_cast<VoxelBlock*>(memory_->voxels.data())),
      colors_(reinterpret_cast<ColorBlock*>(memory_->colors.data())),
      returns_(std::make_shared<Returns>()) {}

BlockSlot TsdfBlockPool::take(const BlockCoord& coord) {
  const BlockSlot slot = take_unset(coord);
  voxels(slot).voxels.fill(0);
  colors(slot).colors.fill(0);
  return slot;
}

BlockSlot TsdfBlockPool::take_copy_of_voxels(BlockSlot other) {
  const BlockSlot slot = take_unset(coord(other));
  voxels(slot) = voxels(other);
  return slot;
}

void TsdfBlockPool::hold(BlockSlot slot) {
  assert(holders_[slot] > 0 && holders_[slot] < 255);
  ++holders_[slot];
}

void TsdfBlockPool::give_back(BlockSlot slot) {
  assert(holders_[slot] > 0);
  if (--holders_[slot] == 0) free_.push_back(slot);
}

std::shared_ptr<const void> TsdfBlockPool::lend(std::vector<BlockSlot> slots) const {
  auto loan = std::make_shared<Loan>();
  loan->slots = std::move(slots);
  loan->memory = memory_;
  loan->returns = returns_;
  return loan;
}

std::size_t TsdfBlockPool::memory_bytes() const {
  return memory_->voxels.committed_bytes() + memory_->colors.committed_bytes() +
         coords_.capacity() * sizeof(BlockCoord) + holders_.capacity() +
         free_.capacity() * sizeof(BlockSlot);
}

BlockSlot TsdfBlockPool::take_unset(BlockCoord coord) {
  if (free_.empty()) collect_returns();
  if (free_.empty()) grow();
  const BlockSlot slot = free_.back();
  free_.pop_back();
  coords_[slot] = coord;
  holders_[slot] = 1;
  return slot;
}

void TsdfBlockPool::grow() {
  const std::size_t size = coords_.size() + 1;
  memory_->voxels.commit(size * sizeof(VoxelBlock));
  memory_->colors.commit(size * sizeof(ColorBlock));
  coords_.emplace_back();
  free_.reserve(coords_.capacity());
  holders_.push_back(0);
  free_.push_back(static_cast<BlockSlot>(size) - 1);
}

void TsdfBlockPool::collect_returns() {
  std::vector<BlockSlot> slots;
  {
    const std::scoped_lock lock(returns_->mutex);
    slots.swap(returns_->slots);
  }
  for (const BlockSlot slot : slots) give_back(slot);
}

}  // namespace kintsugi::mapper
