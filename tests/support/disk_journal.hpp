#pragma once
// The journal of forgetful_disk.cpp, which power_cut.cpp reads. Host byte order; both run on one
// machine.

#include <cstdint>

namespace kintsugi::testing {

/// What a program has done to the disk, or to others. Files and folders have numbers, of which 0 is
/// the watched folder.
enum class DiskAction : std::uint8_t {
  kFound,       ///< `node` was there before; text: its path in the watched folder
  kMadeFile,    ///< `node` in `folder`; text: its name
  kMadeFolder,  ///< the same
  kRemoved,     ///< from `folder`; text: its name
  kRenamed,     ///< from `folder` to `to_folder`; text: both names, with a zero byte between
  kExchanged,   ///< the same, each takes the other's place
  kWritten,     ///< text: to `node` at `offset`
  kShortened,   ///< `node` to the size `offset`, or made longer
  kSyncBegun,   ///< of `node`
  kSyncDone,    ///< of `node`; offset: the number of the record with which it begun
  kSyncFailed,  ///< the same
  kSent,        ///< text: a datagram of LCM
};

/// Is followed by its text.
struct DiskRecord {
  std::int64_t time_us = 0;  ///< wall clock
  std::int64_t offset = 0;
  std::int32_t node = 0;
  std::int32_t folder = 0;
  std::int32_t to_folder = 0;
  std::uint32_t text_bytes = 0;
  DiskAction action = DiskAction::kFound;
  std::uint8_t unused[7] = {};
};
static_assert(sizeof(DiskRecord) == 40);

}  // namespace kintsugi::testing
