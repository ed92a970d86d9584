// The log of what a mapper published: places of chunks, rotation, full disks, being continued.

#include <filesystem>
#include <fstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/channels.hpp"
#include "mapper/session/session_store.hpp"
#include "mapper/session/stored_stream.hpp"
#include "tests/support/example_messages.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::mapper {
namespace {

using kintsugi::testing::example_slice;
using kintsugi::testing::FileSizeLimit;
using kintsugi::testing::TemporaryFolder;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::int64_t kSession = 42;  // of example_slice()
constexpr std::size_t kChunkBytes = 60'000;
constexpr int kPointsPerChunk = 1'500;  // 48 kB: one chunk each

/// Chunk `sequence` of a stream of small slices.
Bytes chunk(std::int64_t sequence, SliceKind kind = SliceKind::kShiftPlusX) {
  CloudSlice slice = example_slice(kPointsPerChunk, static_cast<std::int32_t>(sequence));
  slice.kind = kind;
  num_chunks(slice, kChunkBytes);
  return encode_chunk(slice, sequence, 0, kChunkBytes);
}

Bytes pose(std::int64_t utime) {
  CameraPose pose = kintsugi::testing::example_camera_pose();
  pose.utime = utime;
  return encode(pose);
}

SessionStore::Config config_for(const std::filesystem::path& path, bool resume = false) {
  SessionStore::Config config;
  config.path = path;
  config.resume = resume;
  config.retry_period = std::chrono::milliseconds(1);
  return config;
}

void add_chunks(SessionStore& log, std::int64_t first, std::int64_t end) {
  StoredStream& stream = log.stream(channels::kCloudSlice, kSession);
  for (std::int64_t i = first; i < end; ++i) stream.add(i, chunk(i));
}

void expect_chunks(SessionStore& log, std::int64_t first, std::int64_t end) {
  const StoredStream& stream = log.stream(channels::kCloudSlice, kSession);
  for (std::int64_t i = first; i < end; ++i) EXPECT_EQ(stream.find(i), chunk(i)) << i;
  EXPECT_EQ(stream.next_sequence(), end);
}

std::string error_of(const SessionStore::Config& config) {
  try {
    const SessionStore log(config);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "no error";
}

Bytes contents(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(SessionStore, GivesBackEveryChunkOfARotatedLogAlsoWhenItIsContinued) {
  const TemporaryFolder folder;
  SessionStore::Config config = config_for(folder / "run.lcm");
  config.max_file_bytes = 1'000'000;
  {
    SessionStore log(config);
    log.begin_session(kSession, {{"device", "a"}});
    add_chunks(log, 0, 50);  // 2.4 MB
    log.add(channels::kCameraPose, pose(100));
    expect_chunks(log, 0, 50);
    EXPECT_EQ(log.stream(channels::kCloudSlice, kSession).find(50), std::nullopt);
    EXPECT_EQ(log.stream(channels::kCloudSlice, kSession).find(-1), std::nullopt);
  }
  for (const char* name : {"run.lcm", "run.1.lcm", "run.2.lcm"}) {
    ASSERT_TRUE(std::filesystem::exists(folder / name)) << name;
    EXPECT_LE(std::filesystem::file_size(folder / name), 1'000'000U);
  }
  config.resume = true;
  {
    SessionStore log(config);
    expect_chunks(log, 0, 50);
    ASSERT_EQ(log.sessions().size(), 1U);
    EXPECT_EQ(log.sessions()[0].session, kSession);
    EXPECT_EQ(log.sessions()[0].options, (MappingOptions{{"device", "a"}}));
    EXPECT_EQ(log.sessions()[0].frames.mapped_utimes, std::vector<std::int64_t>{100});
    EXPECT_FALSE(log.sessions()[0].final_slice_begun);
    add_chunks(log, 50, 60);
    expect_chunks(log, 0, 60);
  }
  SessionStore log(config);
  expect_chunks(log, 0, 60);
  std::int64_t on_disk = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    on_disk += static_cast<std::int64_t>(entry.file_size());
  }
  EXPECT_EQ(log.report().size_bytes, on_disk);
}

TEST(SessionStore, LosesAtMostTheEventThatWasBeingWrittenWhereverItIsCut) {
  const TemporaryFolder folder;
  const auto path = folder / "run.lcm";
  std::uintmax_t before = 0;
  {
    SessionStore log(config_for(path));
    log.begin_session(kSession, {});
    add_chunks(log, 0, 3);
    before = std::filesystem::file_size(path);
    add_chunks(log, 3, 4);
  }
  const Bytes whole = contents(path);
  for (std::uintmax_t cut = before + 1; cut < whole.size(); cut += cut < before + 42 ? 3 : 9'973) {
    std::filesystem::resize_file(path, cut);
    {
      SessionStore log(config_for(path, true));
      expect_chunks(log, 0, 3);
      EXPECT_EQ(std::filesystem::file_size(path), before);
    }
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(whole.data()),
               static_cast<std::streamsize>(whole.size()));
  }
}

TEST(SessionStore, KnowsTheEndOfASession) {
  const TemporaryFolder folder;
  {
    SessionStore log(config_for(folder / "run.lcm"));
    log.begin_session(kSession, {});
    add_chunks(log, 0, 3);
    log.stream(channels::kCloudSlice, kSession).add(3, chunk(3, SliceKind::kFinal));
  }
  const SessionStore log(config_for(folder / "run.lcm", true));
  EXPECT_TRUE(log.sessions().at(0).final_slice_begun);
  EXPECT_EQ(log.sessions().at(0).slice_chunks_end, 4);
}

TEST(SessionStore, RefusesWhatItCannotContinueAndLeavesItAsItIs) {
  const TemporaryFolder folder;
  const auto path = folder / "run.lcm";
  EXPECT_THAT(error_of(config_for(path, true)), HasSubstr("No such file"));
  EXPECT_THAT(error_of(config_for(folder / "no" / "run.lcm")), HasSubstr("No such file"));

  std::ofstream(path) << "something else entirely, and longer than a header of an event";
  const Bytes foreign = contents(path);
  EXPECT_THAT(error_of(config_for(path)), HasSubstr("--resume")) << "is never overwritten";
  EXPECT_THAT(error_of(config_for(path, true)), HasSubstr("is no LCM log"));
  EXPECT_EQ(contents(path), foreign);

  std::filesystem::remove(path);
  {
    LogWriter other = LogWriter::create(path);
    other.append(1, "EXAMPLE", foreign);
  }
  const Bytes other = contents(path);
  EXPECT_THAT(error_of(config_for(path, true)), HasSubstr("a mapper did not make it"));
  EXPECT_EQ(contents(path), other);
}

TEST(SessionStore, SaysWhereALogIsDamagedAndCutsNothing) {
  const TemporaryFolder folder;
  const auto path = folder / "run.lcm";
  {
    SessionStore log(config_for(path));
    log.begin_session(kSession, {});
    add_chunks(log, 0, 5);
  }
  const Bytes whole = contents(path);
  const std::size_t event_bytes = 28 + 11 + chunk(4).size();  // header, channel, data
  const std::size_t chunks_begin = whole.size() - 5 * event_bytes;
  for (const std::size_t place : {chunks_begin + 60, whole.size() / 2, whole.size() - 5}) {
    Bytes damaged = whole;
    damaged[place] ^= 0x10U;
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(damaged.data()),
               static_cast<std::streamsize>(damaged.size()));
    const std::string error = error_of(config_for(path, true));
    EXPECT_THAT(error, HasSubstr(path.string())) << place;
    EXPECT_THAT(error, HasSubstr("byte")) << place;
    EXPECT_EQ(contents(path), damaged);
  }
  // A length that claims more than is there, of an event in the middle: no half-written tail.
  Bytes damaged = whole;
  damaged[whole.size() - 2 * event_bytes + 25] = 2;  // 128 kB: reaches beyond the end
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(damaged.data()),
             static_cast<std::streamsize>(damaged.size()));
  EXPECT_THAT(error_of(config_for(path, true)), HasSubstr("is damaged"));
  EXPECT_EQ(contents(path), damaged);
}

TEST(SessionStore, MissesAFileOfARotatedLog) {
  const TemporaryFolder folder;
  SessionStore::Config config = config_for(folder / "run.lcm");
  config.max_file_bytes = 1'000'000;
  {
    SessionStore log(config);
    log.begin_session(kSession, {});
    add_chunks(log, 0, 50);
  }
  config.resume = true;
  std::filesystem::remove(folder / "run.1.lcm");
  EXPECT_THAT(error_of(config), HasSubstr("run.1.lcm' is missing"));
  std::filesystem::remove(folder / "run.lcm");
  EXPECT_THAT(error_of(config), HasSubstr("run.lcm' is missing"));
  config.resume = false;
  EXPECT_THAT(error_of(config), HasSubstr("run.2.lcm' of an earlier run exists"));
}

TEST(SessionStore, KeepsInMemoryWhatADiskHasNoRoomForAndWritesItLater) {
  const TemporaryFolder folder;
  const auto path = folder / "run.lcm";
  {
    SessionStore log(config_for(path));
    log.begin_session(kSession, {});
    {
      const FileSizeLimit limit(200'000);
      add_chunks(log, 0, 20);
      log.add(channels::kCameraPose, pose(100));
      const auto report = log.report();
      EXPECT_THAT(report.problem, HasSubstr(path.string()));
      EXPECT_GT(report.waiting_bytes, 0);
      EXPECT_LE(report.size_bytes, 200'000);
      EXPECT_EQ(report.lost_chunks, 0);
      expect_chunks(log, 0, 20);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    log.retry();
    EXPECT_THAT(log.report().problem, IsEmpty());
    EXPECT_EQ(log.report().waiting_bytes, 0);
    expect_chunks(log, 0, 20);
  }
  SessionStore log(config_for(path, true));
  expect_chunks(log, 0, 20);
  EXPECT_EQ(log.sessions().at(0).frames.mapped_utimes.size(), 1U);
}

TEST(SessionStore, BoundsWhatWaitsAndCountsTheChunksThatAreLost) {
  const TemporaryFolder folder;
  SessionStore::Config config = config_for(folder / "run.lcm");
  config.max_waiting_bytes = 10 * kChunkBytes;
  {
    SessionStore log(config);
    log.begin_session(kSession, {});
    const StoredStream& stream = log.stream(channels::kCloudSlice, kSession);
    {
      const FileSizeLimit limit(100'000);
      add_chunks(log, 0, 1);
      log.add(channels::kCameraPose, pose(50));
      add_chunks(log, 1, 30);
      EXPECT_LE(log.report().waiting_bytes, static_cast<std::int64_t>(config.max_waiting_bytes));
    }
    const std::int64_t lost = log.report().lost_chunks;
    EXPECT_GT(lost, 0);
    std::int64_t not_found = 0;
    for (std::int64_t i = 0; i < 30; ++i) not_found += stream.find(i) ? 0 : 1;
    EXPECT_EQ(not_found, lost);
    EXPECT_EQ(stream.first_sequence(), 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    add_chunks(log, 30, 31);
    EXPECT_EQ(log.report().waiting_bytes, 0);
    EXPECT_EQ(log.report().lost_chunks, lost);
  }
  // What was lost is made again when the session is continued.
  config.resume = true;
  SessionStore log(config);
  StoredStream& stream = log.stream(channels::kCloudSlice, kSession);
  EXPECT_EQ(stream.next_sequence(), 31);
  stream.index().truncate_at_gap();
  const std::int64_t next = stream.next_sequence();
  EXPECT_GT(next, 0);
  EXPECT_LT(next, 30);
  add_chunks(log, next, 31);
  expect_chunks(log, 0, 31);
}

TEST(SessionStore, WithoutANameLeavesNothingBehind) {
  const TemporaryFolder folder;
  setenv("TMPDIR", folder.path().c_str(), 1);
  {
    SessionStore log(config_for({}));
    log.begin_session(kSession, {});
    add_chunks(log, 0, 20);
    expect_chunks(log, 0, 20);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  }
  setenv("TMPDIR", "/no/such/folder", 1);
  EXPECT_THAT(error_of(config_for({})), HasSubstr("--store"));
  unsetenv("TMPDIR");
}

TEST(SessionStore, IsSharedByThreads) {
  const TemporaryFolder folder;
  SessionStore log(config_for(folder / "run.lcm"));
  log.begin_session(kSession, {});
  const StoredStream& stream = log.stream(channels::kCloudSlice, kSession);
  std::thread writer([&] { add_chunks(log, 0, 200); });
  std::thread poses([&] {
    for (int i = 0; i < 500; ++i) log.add(channels::kCameraPose, pose(i));
  });
  while (stream.next_sequence() < 200) {
    const std::int64_t newest = stream.next_sequence() - 1;
    if (newest >= 0) {
      EXPECT_EQ(stream.find(newest), chunk(newest));
    }
  }
  writer.join();
  poses.join();
  expect_chunks(log, 0, 200);
}

}  // namespace
}  // namespace kintsugi::mapper
