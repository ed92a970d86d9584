#include "mapper/core/reserved_memory.hpp"

#include <new>
#include <utility>

#include <sys/mman.h>

namespace kintsugi::mapper {
namespace {

constexpr std::size_t kStepBytes = std::size_t{1} << 21;  // a huge page

}  // namespace

ReservedMemory::ReservedMemory(std::size_t reserved_bytes) : reserved_bytes_(reserved_bytes) {
  void* const range = ::mmap(nullptr, reserved_bytes, PROT_NONE,
                             MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (range == MAP_FAILED) throw std::bad_alloc();
  // Scattered reads in pages of 4 kB cost a page walk each. Only a wish.
  ::madvise(range, reserved_bytes, MADV_HUGEPAGE);
  data_ = static_cast<std::byte*>(range);
}

ReservedMemory::ReservedMemory(ReservedMemory&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)),
      reserved_bytes_(std::exchange(other.reserved_bytes_, 0)),
      committed_bytes_(std::exchange(other.committed_bytes_, 0)) {}

ReservedMemory& ReservedMemory::operator=(ReservedMemory&& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(reserved_bytes_, other.reserved_bytes_);
  std::swap(committed_bytes_, other.committed_bytes_);
  return *this;
}

ReservedMemory::~ReservedMemory() {
  if (data_ != nullptr) ::munmap(data_, reserved_bytes_);
}

void ReservedMemory::commit(std::size_t bytes) {
  if (bytes <= committed_bytes_) return;
  if (bytes > reserved_bytes_) throw std::bad_alloc();
  const std::size_t end = (bytes + kStepBytes - 1) / kStepBytes * kStepBytes;
  const std::size_t usable = end < reserved_bytes_ ? end : reserved_bytes_;
  if (::mprotect(data_, usable, PROT_READ | PROT_WRITE) != 0) throw std::bad_alloc();
  committed_bytes_ = usable;
}

void ReservedMemory::release() {
  if (committed_bytes_ == 0) return;
  ::madvise(data_, committed_bytes_, MADV_DONTNEED);
  ::mprotect(data_, committed_bytes_, PROT_NONE);
  committed_bytes_ = 0;
}

}  // namespace kintsugi::mapper
