#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <list>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

namespace kintsugi {

/// Disk space for those parts of large arrays that have not been used for long, so that a process
/// can keep more than it may have in memory. Arrays are as they were: who touches a part that is on
/// disk has it again, and waits for the disk.
///
/// An array consists of chunks. A chunk that goes to disk is written into a file, which is then
/// mapped in its place, privately: the kernel reads the pages that are touched, and those that are
/// changed are memory again until the chunk is written once more. Nothing is written while it is in
/// use, unlike in a shared mapping, and a full disk is an error that leaves all in memory, not a
/// signal. The file has no name: it is gone with the process, however that ends.
///
/// Chunks take turns, the one whose turn was longest ago first. The system does not tell which are
/// in use; but one that went to disk and has changed when its turn comes again was used in between.
/// It goes to disk once more, and misses more and more turns after that. So what is always in use
/// is written seldom, and what is not in use any more goes to disk a few turns later. One that is
/// in use comes back page by page, from the page cache.
///
/// Pages of the file that were only read count as memory of the process, too, but the system takes
/// them back when it needs memory. To unmap them here would cost more than anything else: reading
/// maps them in blocks of 64 kB and more.
///
/// Any thread may add and remove chunks; trim() needs that no thread changes them.
class SwapSpace {
 public:
  static constexpr std::size_t kChunkBytes = std::size_t{1} << 21;  ///< of a huge page

  struct Config {
    std::filesystem::path folder;  ///< of the file, on a disk
    /// Of the process, > 0: of what is not of a file, see ProcessMemory.
    std::size_t max_anonymous_bytes = 0;

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  /// @throws std::invalid_argument for an invalid config, std::runtime_error naming the folder if
  ///   no file can be made in it, or if it is in memory itself (tmpfs)
  explicit SwapSpace(const Config& config);
  ~SwapSpace();
  SwapSpace(const SwapSpace&) = delete;
  SwapSpace& operator=(const SwapSpace&) = delete;

  /// From now on the chunk, which begins on a multiple of kChunkBytes and is readable and writable
  /// anonymous memory, may go to disk. It must stay mapped until remove().
  void add(std::byte* chunk);
  /// Its content is not needed any more.
  void remove(std::byte* chunk);

  /// Puts chunks on disk while the process has more memory than Config::max_anonymous_bytes. Writes
  /// at most 64 MB at a time, so that nobody waits for long: who calls it often stays at the limit.
  void trim();

  /// Bytes of the file.
  std::size_t file_bytes() const { return num_slots_ * kChunkBytes; }
  /// Bytes written so far.
  std::size_t written_bytes() const { return written_bytes_; }
  /// Why the last trim() could not write; empty: it could.
  const std::string& problem() const { return problem_; }

 private:
  static constexpr std::size_t kNoSlot = SIZE_MAX;

  struct Chunk {
    std::byte* data;
    std::size_t slot = kNoSlot;     ///< where it is in the file
    int num_turns_to_miss = 0;      ///< from now on
    int num_turns_missed_last = 0;  ///< before the turn that it took last
  };
  using Chunks = std::list<Chunk>;
  /// Pages of a chunk that have to be written, and how many of these are in memory.
  struct Pages {
    std::vector<bool> are_changed;
    std::size_t num_in_memory = 0;
  };

  std::size_t take_turn(Chunk& chunk, bool may_miss);
  std::size_t put_on_disk(Chunk& chunk, Pages pages);
  Pages pages_of(const Chunk& chunk) const;
  std::size_t take_slot();
  void write_changed(const Chunk& chunk, const std::vector<bool>& are_changed);
  void write(const std::byte* data, std::size_t bytes, std::size_t offset);

  Config config_;
  int file_ = -1;
  int pagemap_ = -1;  ///< of this process: the state of each page
  std::mutex mutex_;  ///< guards chunks, their addresses and slots
  Chunks chunks_;     ///< the next one in front
  std::unordered_map<const std::byte*, Chunks::iterator> by_address_;
  std::vector<std::size_t> free_slots_;
  std::size_t num_slots_ = 0;
  std::size_t written_bytes_ = 0;
  std::string problem_;
};

}  // namespace kintsugi
