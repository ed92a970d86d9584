#include "lcmtypes/base/swap_space.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <linux/magic.h>
#include <sys/mman.h>
#include <sys/vfs.h>
#include <unistd.h>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/base/process_memory.hpp"

namespace kintsugi {
namespace {

constexpr std::size_t kMaxWrittenByTrim = std::size_t{64} << 20;
constexpr std::size_t kPageBytes = 4096;
constexpr std::size_t kPagesOfChunk = SwapSpace::kChunkBytes / kPageBytes;
/// What is always in use is written in one of eight turns; what is not in use any more stays in
/// memory for at most seven.
constexpr int kMaxMissedTurns = 7;

// Of an entry of /proc/self/pagemap (admin-guide/mm/pagemap.rst of the kernel).
constexpr std::uint64_t kIsPresent = std::uint64_t{1} << 63;
/// By the kernel, to a swap of its own.
constexpr std::uint64_t kIsSwapped = std::uint64_t{1} << 62;
constexpr std::uint64_t kIsOfFile = std::uint64_t{1} << 61;

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what, int error) {
  throw std::runtime_error(path.string() + ": " + what + ": " + std::strerror(error));
}

/// A file without a name.
int make_file(const std::filesystem::path& folder) {
  struct statfs system {};
  if (::statfs(folder.c_str(), &system) != 0) fail(folder, "no folder for swapped memory", errno);
  if (system.f_type == TMPFS_MAGIC || system.f_type == RAMFS_MAGIC) {
    throw std::runtime_error(folder.string() +
                             ": no folder for swapped memory: it is in memory itself (tmpfs); "
                             "expected one on a disk");
  }
  std::string path = (folder / "kintsugi-swap.XXXXXX").string();
  const int file = ::mkostemp(path.data(), O_CLOEXEC);
  if (file < 0) fail(folder, "no file for swapped memory can be made", errno);
  ::unlink(path.c_str());
  return file;
}

}  // namespace

void SwapSpace::Config::validate() const {
  require(max_anonymous_bytes > 0, "max_anonymous_bytes", max_anonymous_bytes, "> 0");
}

SwapSpace::SwapSpace(const Config& config)
    : config_((config.validate(), config)), file_(make_file(config.folder)) {
  pagemap_ = ::open("/proc/self/pagemap", O_RDONLY | O_CLOEXEC);
  if (pagemap_ >= 0) return;
  const int error = errno;
  ::close(file_);
  fail("/proc/self/pagemap", "cannot be read", error);
}

SwapSpace::~SwapSpace() {
  ::close(pagemap_);
  ::close(file_);
}

void SwapSpace::add(std::byte* chunk) {
  const std::lock_guard lock(mutex_);
  by_address_[chunk] = chunks_.insert(chunks_.end(), Chunk{.data = chunk});
}

void SwapSpace::remove(std::byte* chunk) {
  const std::lock_guard lock(mutex_);
  const auto found = by_address_.find(chunk);
  if (found == by_address_.end()) return;
  if (found->second->slot != kNoSlot) free_slots_.push_back(found->second->slot);
  chunks_.erase(found->second);
  by_address_.erase(found);
}

void SwapSpace::trim() {
  const auto in_memory = static_cast<std::size_t>(process_memory().anonymous_bytes);
  if (in_memory <= config_.max_anonymous_bytes) return;
  const std::size_t excess = in_memory - config_.max_anonymous_bytes;
  std::size_t freed = 0;
  const std::lock_guard lock(mutex_);
  const std::size_t may_be_written = written_bytes_ + kMaxWrittenByTrim;
  try {
    // What is in use goes to disk, too, if nothing else is left: the limit is kept.
    for (const bool may_miss : {true, false}) {
      for (std::size_t n = chunks_.size();
           n > 0 && freed < excess && written_bytes_ < may_be_written; --n) {
        Chunk& chunk = chunks_.front();
        chunks_.splice(chunks_.end(), chunks_, chunks_.begin());
        freed += take_turn(chunk, may_miss);
      }
    }
    problem_.clear();
  } catch (const std::system_error& error) {
    problem_ = "memory that was not used for long cannot be written to disk, in " +
               config_.folder.string() + ": " + error.code().message();
  }
}

/// Returns how many bytes are free now.
std::size_t SwapSpace::take_turn(Chunk& chunk, bool may_miss) {
  if (may_miss && chunk.num_turns_to_miss > 0) {
    --chunk.num_turns_to_miss;
    return 0;
  }
  Pages pages = pages_of(chunk);
  if (pages.num_in_memory == 0) {
    chunk.num_turns_missed_last = 0;
    return 0;
  }
  const bool was_on_disk = chunk.slot != kNoSlot;
  const std::size_t freed = put_on_disk(chunk, std::move(pages));
  if (was_on_disk) {
    chunk.num_turns_missed_last = std::min(2 * chunk.num_turns_missed_last + 1, kMaxMissedTurns);
    chunk.num_turns_to_miss = chunk.num_turns_missed_last;
  }
  return freed;
}

/// Returns how many bytes are free now.
std::size_t SwapSpace::put_on_disk(Chunk& chunk, Pages pages) {
  const bool is_new = chunk.slot == kNoSlot;
  if (is_new) {
    chunk.slot = take_slot();
    pages.are_changed.assign(kPagesOfChunk, true);  // the slot may have had another chunk
  }
  const auto offset = static_cast<off_t>(chunk.slot * kChunkBytes);
  try {
    write_changed(chunk, pages.are_changed);
    // Takes the place of the old mapping at once: a thread that reads sees either.
    if (::mmap(chunk.data, kChunkBytes, PROT_READ | PROT_WRITE,
               MAP_PRIVATE | MAP_FIXED | MAP_NORESERVE, file_, offset) == MAP_FAILED) {
      throw std::system_error(errno, std::generic_category());
    }
    // Else the system reads as much around a page as it would of a file that is read in order:
    // with a read-ahead of 8 MB, 5 MB for each page that was wanted. Refused: it is only slower.
    ::madvise(chunk.data, kChunkBytes, MADV_RANDOM);
  } catch (...) {
    if (is_new) free_slots_.push_back(std::exchange(chunk.slot, kNoSlot));
    throw;
  }
  return pages.num_in_memory * kPageBytes;
}

SwapSpace::Pages SwapSpace::pages_of(const Chunk& chunk) const {
  std::array<std::uint64_t, kPagesOfChunk> entries{};
  const auto offset =
      reinterpret_cast<std::uintptr_t>(chunk.data) / kPageBytes * sizeof(entries[0]);
  if (::pread(pagemap_, entries.data(), sizeof(entries), static_cast<off_t>(offset)) !=
      static_cast<ssize_t>(sizeof(entries))) {
    throw std::system_error(errno, std::generic_category());
  }
  Pages pages{.are_changed = std::vector<bool>(kPagesOfChunk)};
  for (std::size_t k = 0; k < kPagesOfChunk; ++k) {
    const bool is_in_memory = (entries[k] & kIsPresent) != 0 && (entries[k] & kIsOfFile) == 0;
    pages.num_in_memory += is_in_memory ? 1 : 0;
    pages.are_changed[k] = is_in_memory || (entries[k] & kIsSwapped) != 0;
  }
  return pages;
}

std::size_t SwapSpace::take_slot() {
  if (!free_slots_.empty()) {
    const std::size_t slot = free_slots_.back();
    free_slots_.pop_back();
    return slot;
  }
  const auto offset = static_cast<off_t>(num_slots_ * kChunkBytes);
  // Space is taken now, so that no later write into the slot finds the disk full.
  if (const int error = ::posix_fallocate(file_, offset, static_cast<off_t>(kChunkBytes))) {
    throw std::system_error(error, std::generic_category());
  }
  return num_slots_++;
}

void SwapSpace::write_changed(const Chunk& chunk, const std::vector<bool>& are_changed) {
  for (std::size_t first = 0; first < kPagesOfChunk;) {
    std::size_t last = first;
    while (last < kPagesOfChunk && are_changed[last]) ++last;
    if (last > first) {
      write(chunk.data + first * kPageBytes, (last - first) * kPageBytes,
            chunk.slot * kChunkBytes + first * kPageBytes);
    }
    first = last + 1;
  }
}

void SwapSpace::write(const std::byte* data, std::size_t bytes, std::size_t offset) {
  while (bytes > 0) {
    const ssize_t written = ::pwrite(file_, data, bytes, static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) throw std::system_error(errno, std::generic_category());
    data += written;
    bytes -= static_cast<std::size_t>(written);
    offset += static_cast<std::size_t>(written);
    written_bytes_ += static_cast<std::size_t>(written);
  }
}

}  // namespace kintsugi
