#include "mapper/core/volume/tsdf_block_pool.hpp"

#include <cassert>
#include <mutex>
#include <utility>

#include "lcmtypes/base/reserved_memory.hpp"

namespace kintsugi::mapper {
namespace {

constexpr std::size_t kBlocksOfPage = ReservedMemory::kPageBytes / sizeof(VoxelBlock);
static_assert(sizeof(VoxelBlock) == sizeof(ColorBlock));

}  // namespace

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
  if (--holders_[slot] > 0) return;
  free_.push(slot);
  --pages_[slot / kBlocksOfPage].num_blocks;
}

void TsdfBlockPool::tidy() {
  collect_returns();
  for (std::size_t i = 0; i < pages_.size(); ++i) {
    Page& page = pages_[i];
    if (page.num_blocks > 0 || !page.has_memory) continue;
    memory_->voxels.discard_page(i);
    memory_->colors.discard_page(i);
    page.has_memory = false;
    ++num_without_memory_;
  }
}

std::shared_ptr<const void> TsdfBlockPool::lend(std::vector<BlockSlot> slots) const {
  auto loan = std::make_shared<Loan>();
  loan->slots = std::move(slots);
  loan->memory = memory_;
  loan->returns = returns_;
  return loan;
}

std::size_t TsdfBlockPool::memory_bytes() const {
  return memory_->voxels.committed_bytes() + memory_->colors.committed_bytes() -
         2 * num_without_memory_ * ReservedMemory::kPageBytes +
         coords_.capacity() * sizeof(BlockCoord) + holders_.capacity() +
         free_.size() * sizeof(BlockSlot);
}

BlockSlot TsdfBlockPool::take_unset(BlockCoord coord) {
  if (free_.empty()) collect_returns();
  if (free_.empty()) grow();
  const BlockSlot slot = free_.top();
  free_.pop();
  coords_[slot] = coord;
  holders_[slot] = 1;
  Page& page = pages_[slot / kBlocksOfPage];
  ++page.num_blocks;
  if (!page.has_memory) --num_without_memory_;
  page.has_memory = true;
  return slot;
}

void TsdfBlockPool::grow() {
  const std::size_t size = coords_.size() + 1;
  memory_->voxels.commit(size * sizeof(VoxelBlock));
  memory_->colors.commit(size * sizeof(ColorBlock));
  coords_.emplace_back();
  holders_.push_back(0);
  pages_.resize((size - 1) / kBlocksOfPage + 1);
  free_.push(static_cast<BlockSlot>(size) - 1);
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
