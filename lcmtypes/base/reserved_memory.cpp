#include "lcmtypes/base/reserved_memory.hpp"

#include <algorithm>
#include <cassert>
#include <memory>
#include <new>
#include <utility>

#include <sys/mman.h>

#include "lcmtypes/base/swap_space.hpp"

namespace kintsugi {
namespace {

constexpr std::size_t kHugePageBytes = ReservedMemory::kPageBytes;
static_assert(kHugePageBytes == SwapSpace::kChunkBytes);

std::size_t round_up(std::size_t bytes) {
  return (bytes + kHugePageBytes - 1) / kHugePageBytes * kHugePageBytes;
}

// A program has 128 TB of addresses; with the thread sanitizer 1.5, with that of addresses 112.
#if defined(__SANITIZE_THREAD__)
constexpr std::size_t kScarcity = 128;
#elif defined(__SANITIZE_ADDRESS__)
constexpr std::size_t kScarcity = 4;
#else
constexpr std::size_t kScarcity = 1;
#endif

/// Where addresses are scarce, less is reserved for what may become large.
std::size_t reservable(std::size_t bytes) {
  constexpr std::size_t kLarge = std::size_t{1} << 34;
  return bytes < kLarge ? bytes : round_up(bytes / kScarcity);
}

/// Whoever sees "out of memory" would look at memory, of which there may be plenty.
class OutOfAddresses : public std::bad_alloc {
 public:
  const char* what() const noexcept override {
    return "the process has no addresses left for another map: too many maps, or a limit (ulimit "
           "-v)";
  }
};

}  // namespace

ReservedMemory::ReservedMemory(std::size_t reserved_bytes, HugePages huge_pages)
    : range_bytes_(reservable(reserved_bytes) + kHugePageBytes),
      reserved_bytes_(reservable(reserved_bytes)) {
  range_ =
      ::mmap(nullptr, range_bytes_, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (range_ == MAP_FAILED) throw OutOfAddresses();
  std::size_t space = range_bytes_;
  void* start = range_;
  data_ = static_cast<std::byte*>(std::align(kHugePageBytes, reserved_bytes_, start, space));
  // A failure of either is ignored: everything works, only slower or with more memory.
  if (huge_pages == HugePages::kNowhere) {
    ::madvise(data_, reserved_bytes_, MADV_NOHUGEPAGE);
    return;
  }
  const std::size_t first = huge_pages == HugePages::kEverywhere ? 0 : kHugePageBytes;
  if (first < reserved_bytes_) ::madvise(data_ + first, reserved_bytes_ - first, MADV_HUGEPAGE);
}

ReservedMemory::ReservedMemory(ReservedMemory&& other) noexcept
    : range_(std::exchange(other.range_, nullptr)),
      range_bytes_(std::exchange(other.range_bytes_, 0)),
      data_(std::exchange(other.data_, nullptr)),
      reserved_bytes_(std::exchange(other.reserved_bytes_, 0)),
      committed_bytes_(std::exchange(other.committed_bytes_, 0)),
      swap_(std::exchange(other.swap_, nullptr)) {}

ReservedMemory& ReservedMemory::operator=(ReservedMemory&& other) noexcept {
  std::swap(range_, other.range_);
  std::swap(range_bytes_, other.range_bytes_);
  std::swap(data_, other.data_);
  std::swap(reserved_bytes_, other.reserved_bytes_);
  std::swap(committed_bytes_, other.committed_bytes_);
  std::swap(swap_, other.swap_);
  return *this;
}

ReservedMemory::~ReservedMemory() {
  for (std::size_t k = 0; swap_ != nullptr && k < committed_bytes_; k += kHugePageBytes) {
    swap_->remove(data_ + k);
  }
  if (range_ != nullptr) ::munmap(range_, range_bytes_);
}

void ReservedMemory::commit(std::size_t bytes) {
  if (bytes <= committed_bytes_) return;
  if (bytes > reserved_bytes_) throw std::bad_alloc();
  const std::size_t usable = std::min(round_up(bytes), reserved_bytes_);
  if (::mprotect(data_, usable, PROT_READ | PROT_WRITE) != 0) throw std::bad_alloc();
  const std::size_t first_new = std::exchange(committed_bytes_, usable);
  if (swap_ != nullptr) add_to_swap(first_new);
}

void ReservedMemory::discard_page(std::size_t page) {
  assert(swap_ == nullptr);
  const std::size_t first = page * kHugePageBytes;
  if (first >= committed_bytes_) return;
  ::madvise(data_ + first, std::min(kHugePageBytes, committed_bytes_ - first), MADV_DONTNEED);
}

void ReservedMemory::release() {
  assert(swap_ == nullptr);
  if (committed_bytes_ == 0) return;
  ::madvise(data_, committed_bytes_, MADV_DONTNEED);
  ::mprotect(data_, committed_bytes_, PROT_NONE);
  committed_bytes_ = 0;
}

void ReservedMemory::swap_to(SwapSpace& space) {
  assert(swap_ == nullptr && reserved_bytes_ % kHugePageBytes == 0);
  swap_ = &space;
  add_to_swap(0);
}

void ReservedMemory::add_to_swap(std::size_t first_byte) {
  for (std::size_t k = first_byte; k < committed_bytes_; k += kHugePageBytes) swap_->add(data_ + k);
}

}  // namespace kintsugi
