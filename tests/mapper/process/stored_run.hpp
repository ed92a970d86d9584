#pragma once
// What a mapper left in its log, read as anybody reads an LCM log; and a run that makes many slices
// in little time.

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/codec/codec.hpp"
#include "lcmtypes/log/log_reader.hpp"
#include "mapper/session/mapped_frames.hpp"

namespace kintsugi::mapper::testing {

struct StoredRun {
  /// By session and sequence number. A chunk that is there twice is the same both times.
  std::map<std::pair<std::int64_t, std::int64_t>, Bytes> slice_chunks;
  std::vector<std::int64_t> pose_utimes;
  std::vector<std::int64_t> tracked_only_utimes;
  std::vector<MapperStatus> statuses;
  std::int64_t events = 0;
  std::vector<std::int64_t> event_utimes;  ///< when each was appended
  std::string damage;                      ///< what is wrong behind the last event; empty: nothing
  bool has_final_slice = false;
};

/// The file of a log, or nothing more than the whole events before its cut end.
inline StoredRun read_stored_run(const std::filesystem::path& path) {
  StoredRun run;
  LogReader reader(path);
  while (const auto event = reader.next()) {
    ++run.events;
    run.event_utimes.push_back(event->utime);
    if (event->channel == channels::kCloudSlice) {
      const auto chunk = decode_chunk<CloudSlice>(event->data);
      run.has_final_slice |= chunk.header.kind == SliceKind::kFinal;
      const Bytes data(event->data.begin(), event->data.end());
      const auto [place, is_new] =
          run.slice_chunks.emplace(std::pair{chunk.header.session, chunk.sequence}, data);
      EXPECT_TRUE(is_new) << "chunk " << chunk.sequence << " was published twice";
      EXPECT_EQ(place->second, data);
    } else if (event->channel == channels::kCameraPose) {
      run.pose_utimes.push_back(decode<CameraPose>(event->data).utime);
    } else if (event->channel == kTrackedOnlyChannel) {
      const auto utimes = decode_mapped_frames(event->data).utimes;
      run.tracked_only_utimes.insert(run.tracked_only_utimes.end(), utimes.begin(), utimes.end());
    } else if (event->channel == channels::kMapperStatus) {
      run.statuses.push_back(decode<MapperStatus>(event->data));
    }
  }
  run.damage = reader.damage().value_or("");
  return run;
}

/// A camera on a walk of its own over what the synthetic room shows: a slice every other frame.
/// What is mapped is no room, but every bit of it follows from the frames.
inline std::vector<std::string> brisk_walk(const std::filesystem::path& folder, int num_frames) {
  const std::filesystem::path path = folder / "walk.txt";
  std::ofstream file(path);
  for (int i = 0; i < 200; ++i) {
    file << 1.0 / 30.0 * i << ' ' << 0.1 * i << " 0 " << 0.05 * (i % 3) << " 0 0 0 1\n";
  }
  return {"--device",      "synthetic://office?frames=" + std::to_string(num_frames),
          "--trajectory",  path,
          "--volume-size", "3.2",
          "--resolution",  "0.02",
          "--shift",       "8",
          "--min-weight",  "0",
          "--session",     "7",
          "--linger",      "0"};
}

}  // namespace kintsugi::mapper::testing
