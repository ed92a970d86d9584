// A log that a power cut cannot take: what waits for the disk, and what is cut off or refused when
// it is continued. test_power_cut.cpp cuts the power of the whole program.

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/log/log_format.hpp"
#include "lcmtypes/log/session_log.hpp"
#include "mapper/session/log_marks.hpp"
#include "mapper/session/session_store.hpp"
#include "mapper/session/stored_stream.hpp"
#include "tests/support/example_messages.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;
using kintsugi::testing::example_slice;
using kintsugi::testing::FileSizeLimit;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::int64_t kSession = 42;  // of example_slice()
constexpr std::size_t kChunkBytes = 60'000;

Bytes chunk(std::int64_t sequence) {
  CloudSlice slice = example_slice(1'500, static_cast<std::int32_t>(sequence));
  num_chunks(slice, kChunkBytes);
  return encode_chunk(slice, sequence, 0, kChunkBytes);
}

class DurableLog : public ::testing::Test {
 protected:
  SessionStore::Config config(bool resume = false) const {
    SessionStore::Config config;
    config.path = path_;
    config.resume = resume;
    config.durable = true;
    config.sync_period = std::chrono::milliseconds(1);
    config.retry_period = std::chrono::milliseconds(1);
    config.max_file_bytes = 1'000'000;
    return config;
  }

  static void add(SessionStore& log, std::int64_t first, std::int64_t end) {
    StoredStream& stream = log.stream(channels::kCloudSlice, kSession);
    for (std::int64_t i = first; i < end; ++i) stream.add(i, chunk(i));
  }

  static void expect_chunks(SessionStore& log, std::int64_t end) {
    const StoredStream& stream = log.stream(channels::kCloudSlice, kSession);
    for (std::int64_t i = 0; i < end; ++i) EXPECT_EQ(stream.find(i), chunk(i)) << i;
    EXPECT_EQ(stream.next_sequence(), end);
  }

  /// Waits for the thread of the log.
  template <typename Condition>
  static void wait_until(const Condition& condition) {
    while (!condition()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  /// Returns the size of the log of these chunks.
  std::uintmax_t write_log(std::int64_t num_chunks) const {
    SessionStore log(config());
    log.begin_session(kSession, {});
    add(log, 0, num_chunks);
    log.finish();
    return fs::file_size(path_);
  }

  void overwrite(std::uintmax_t place, const std::string& text) const {
    std::fstream file(path_, std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(static_cast<std::streamoff>(place));
    file << text;
  }

  const kintsugi::testing::TemporaryFolder folder_;
  const fs::path path_ = folder_ / "run.lcm";
};

TEST_F(DurableLog, HasItsNameWhenItsFirstEventIsOnTheDisk) {
  SessionStore log(config());
  EXPECT_FALSE(fs::exists(path_));
  log.begin_session(kSession, {});
  EXPECT_GT(fs::file_size(path_), 0U);
}

TEST_F(DurableLog, GivesBackEveryChunkAndIsContinuedInSeveralFiles) {
  {
    SessionStore log(config());
    log.begin_session(kSession, {});
    add(log, 0, 50);  // 2.4 MB
    expect_chunks(log, 50);
    wait_until([&] { return log.report().waiting_bytes == 0; });
    expect_chunks(log, 50);
    add(log, 50, 60);
  }  // writes the rest
  EXPECT_TRUE(fs::exists(folder_ / "run.2.lcm"));
  SessionStore log(config(true));
  expect_chunks(log, 60);
  add(log, 60, 61);
  log.finish();
  expect_chunks(log, 61);
  EXPECT_EQ(log.report().waiting_bytes, 0);
  EXPECT_THAT(log.report().problem, IsEmpty());
}

TEST_F(DurableLog, LetsAChunkBeSentWhenItIsOnTheDisk) {
  SessionStore::Config never = config();
  never.sync_period = std::chrono::hours(1);
  SessionStore log(never);
  log.begin_session(kSession, {});
  add(log, 0, 1);
  const StoredStream& stream = log.stream(channels::kCloudSlice, kSession);
  EXPECT_FALSE(stream.is_safe(0));
  log.finish();
  EXPECT_TRUE(stream.is_safe(0));
}

TEST_F(DurableLog, DoesNotHoldAChunkBackForADiskThatStandsStill) {
  SessionStore::Config never = config();
  never.sync_period = std::chrono::hours(1);
  SessionStore log(never);
  log.begin_session(kSession, {});
  add(log, 0, 1);
  wait_until([&] { return log.stream(channels::kCloudSlice, kSession).is_safe(0); });
  EXPECT_THAT(log.report().problem, HasSubstr("s behind, which a power cut would take"));
  log.finish();
  EXPECT_THAT(log.report().problem, IsEmpty());
}

TEST_F(DurableLog, KeepsInMemoryWhatADiskHasNoRoomForAndWritesItLater) {
  {
    SessionStore log(config());
    log.begin_session(kSession, {});
    {
      const FileSizeLimit limit(200'000);
      add(log, 0, 12);
      wait_until([&] { return !log.report().problem.empty(); });
      EXPECT_THAT(log.report().problem, HasSubstr(path_.string()));
      EXPECT_GT(log.report().waiting_bytes, 0);
      EXPECT_LE(fs::file_size(path_), 200'000U);
      expect_chunks(log, 12);
    }
    wait_until([&] { return log.report().waiting_bytes == 0; });
    EXPECT_THAT(log.report().problem, IsEmpty());
  }
  SessionStore log(config(true));
  expect_chunks(log, 12);
}

TEST_F(DurableLog, CutsOffWhatIsDamagedBehindItsLastMark) {
  const std::uintmax_t bytes = write_log(3);  // one batch or a few
  for (const std::string& damage : {std::string(512, '\0'), std::string("?")}) {
    overwrite(bytes - 1'000, damage);  // in the last chunk
    SessionStore log(config(true));
    expect_chunks(log, 2);
    add(log, 2, 3);
  }
  SessionStore log(config(true));
  expect_chunks(log, 3);
}

TEST_F(DurableLog, RefusesDamageBeforeAMarkAndCutsNothing) {
  const std::uintmax_t bytes = write_log(3);
  {
    SessionStore log(config(true));  // another batch
    log.add(channels::kCameraPose, encode(kintsugi::testing::example_camera_pose()));
  }
  const std::uintmax_t whole = fs::file_size(path_);
  ASSERT_GT(whole, bytes);
  overwrite(bytes - 1'000, std::string(512, '\0'));
  EXPECT_THROW(SessionStore{config(true)}, std::runtime_error);
  SessionStore::Config plain = config(true);
  plain.durable = false;
  EXPECT_THROW(SessionStore{plain}, std::runtime_error);
  EXPECT_EQ(fs::file_size(path_), whole);
}

TEST_F(DurableLog, TakesNoOtherBytesForAMark) {
  const std::uintmax_t bytes = write_log(1);
  // A mark, but of another place, behind damage: it proves nothing.
  LogWriter other = LogWriter::create(folder_ / "other.lcm");
  (void)other.append(1, kMarkChannel, mark_at(7));
  std::ifstream in(folder_ / "other.lcm", std::ios::binary);
  const std::string mark{std::istreambuf_iterator<char>(in), {}};
  std::ofstream(path_, std::ios::binary | std::ios::app) << std::string(100, '\0') << mark;
  {
    SessionStore log(config(true));
    expect_chunks(log, 1);
  }
  EXPECT_EQ(fs::file_size(path_), bytes);
  // Of its own place: what is before was on the disk, so this was no power cut.
  LogWriter another = LogWriter::create(folder_ / "another.lcm");
  (void)another.append(1, kMarkChannel, mark_at(static_cast<std::int64_t>(bytes + 100)));
  std::ifstream again(folder_ / "another.lcm", std::ios::binary);
  std::ofstream(path_, std::ios::binary | std::ios::app) << std::string(100, '\0') << again.rdbuf();
  EXPECT_THROW(SessionStore{config(true)}, std::runtime_error);
}

TEST_F(DurableLog, RefusesWhatExistsAndReplacesWhatAPowerCutHasLeftOfABeginning) {
  std::ofstream(folder_ / "run.partial.lcm") << "the beginning of a log that never had its name";
  (void)write_log(2);
  EXPECT_FALSE(fs::exists(folder_ / "run.partial.lcm"));
  const std::uintmax_t bytes = fs::file_size(path_);
  EXPECT_THROW(SessionStore{config()}, std::runtime_error);
  EXPECT_EQ(fs::file_size(path_), bytes);
  SessionStore::Config nameless = config();
  nameless.path.clear();
  EXPECT_THROW(SessionStore{nameless}, std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::mapper
