#pragma once
// What a power cut would have left of a folder, told from the journal of forgetful_disk.cpp.

#include <cstdint>
#include <deque>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/disk_journal.hpp"

namespace kintsugi::testing {

/// A record of a journal. The text belongs to the DiskJournal. The number of the record with which
/// a sync has begun is that of the event.
struct DiskEvent {
  DiskRecord record;
  std::string_view text;
  int program = 0;  ///< whose numbers of files and folders these are
};

/// What programs have done to the folder that was watched, in the order of time.
class DiskJournal {
 public:
  /// Reads the journals with the name `file` that the programs have written.
  /// @throws std::runtime_error when there is none
  explicit DiskJournal(const std::filesystem::path& file);
  DiskJournal(const DiskJournal&) = delete;
  DiskJournal& operator=(const DiskJournal&) = delete;

  const std::vector<DiskEvent>& events() const { return events_; }

 private:
  void read(const std::filesystem::path& file);
  void sort();

  std::deque<std::string> bytes_;  ///< of each program
  std::vector<DiskEvent> events_;
};

/// Writes into the new folder `to` what is left when the power is cut after the given events of
/// programs that began with the files of the folder `before` (empty: with none).
///
/// What was synced is left: contents of a file by syncing it, names by syncing their folder. Of
/// what came after the last sync anything may be left, by `seed`: nothing, a part of it in its
/// order, sectors of 512 or 4,096 bytes in no order with zeros between them, a size without
/// contents; and names in their order or not, but a renaming as a whole. After a sync that failed,
/// what was written before it is left by chance, and no later sync changes that, as on Linux.
void cut_power(std::span<const DiskEvent> events, const std::filesystem::path& before,
               std::uint32_t seed, const std::filesystem::path& to);

/// The environment, as words for /usr/bin/env, in which a program's doings in `folder` are written
/// into `journal`. Removes the journals of earlier ones.
std::vector<std::string> forgetful_disk(const std::filesystem::path& folder,
                                        const std::filesystem::path& journal);

/// Runs a test of this program, named DISABLED_, on such a disk; FORGETFUL_DISK tells it the
/// folder. Returns the exit code.
int run_on_forgetful_disk(const std::string& test, const std::filesystem::path& folder,
                          const std::filesystem::path& journal);

/// Writes a number into the journal, as what others have heard, and returns the last one in these
/// events; 0: none.
void tell_others(int number);
int last_told(std::span<const DiskEvent> events);

}  // namespace kintsugi::testing
