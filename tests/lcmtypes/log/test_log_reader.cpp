#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>

#include "lcmtypes/log/log_reader.hpp"
#include "tests/support/allocation_limit.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi {
namespace {

using kintsugi::testing::TemporaryFolder;
using ::testing::HasSubstr;

constexpr int kNumEvents = 5;

/// Writes a log with LCM's own functions, as lcm-logger does.
std::string write_log(const std::filesystem::path& path) {
  {
    lcm::LogFile log(path.string(), "w");
    for (int i = 0; i < kNumEvents; ++i) {
      std::string data(static_cast<std::size_t>(10 * i), static_cast<char>('a' + i));
      lcm::LogEvent event;
      event.timestamp = 1'000 + i;
      event.channel = "CHANNEL_" + std::to_string(i);
      event.datalen = static_cast<std::int32_t>(data.size());
      event.data = data.data();
      log.writeEvent(&event);
    }
  }
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

int count_events(LogReader& reader) {
  int count = 0;
  while (const auto event = reader.next()) {
    EXPECT_EQ(event->index, count);
    EXPECT_EQ(event->utime, 1'000 + count);
    EXPECT_EQ(event->channel, "CHANNEL_" + std::to_string(count));
    EXPECT_EQ(event->data.size(), static_cast<std::size_t>(10 * count));
    for (const auto byte : event->data) EXPECT_EQ(byte, 'a' + count);
    ++count;
  }
  return count;
}

std::string refusal(const std::filesystem::path& path) {
  try {
    LogReader reader(path);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(LogReader, ReadsWhatLcmWrites) {
  const TemporaryFolder folder;
  const std::string bytes = write_log(folder / "run.lcm");
  LogReader reader(folder / "run.lcm");
  EXPECT_EQ(count_events(reader), kNumEvents);
  EXPECT_FALSE(reader.damage());
  EXPECT_EQ(reader.bytes_read(), static_cast<std::int64_t>(bytes.size()));
}

TEST(LogReader, ReadsUpToACutAndReportsItsPlace) {
  const TemporaryFolder folder;
  const std::string bytes = write_log(folder / "run.lcm");
  std::int64_t last_whole = 0;
  for (std::size_t size = 28; size < bytes.size(); ++size) {
    write(folder / "cut.lcm", bytes.substr(0, size));
    LogReader reader(folder / "cut.lcm");
    EXPECT_LT(count_events(reader), kNumEvents);
    EXPECT_GE(reader.bytes_read(), last_whole);
    last_whole = reader.bytes_read();
    const bool at_an_event = last_whole == static_cast<std::int64_t>(size);
    ASSERT_EQ(reader.damage().has_value(), !at_an_event) << size;
    if (at_an_event) continue;
    EXPECT_THAT(*reader.damage(), HasSubstr("at byte " + std::to_string(last_whole)));
    EXPECT_FALSE(reader.next());
  }
}

TEST(LogReader, GoesOnWithWhatIsAppended) {
  const TemporaryFolder folder;
  const std::string bytes = write_log(folder / "run.lcm");
  write(folder / "growing.lcm", bytes.substr(0, 28));
  LogReader reader(folder / "growing.lcm");
  int count = 0;
  for (std::size_t size = 28; size <= bytes.size(); ++size) {
    write(folder / "growing.lcm", bytes.substr(0, size));
    reader.go_on();
    while (const auto event = reader.next()) EXPECT_EQ(event->index, count++);
    EXPECT_EQ(reader.is_cut_off(), reader.bytes_read() < static_cast<std::int64_t>(size)) << size;
  }
  EXPECT_EQ(count, kNumEvents);
  EXPECT_FALSE(reader.damage());
}

TEST(LogReader, DoesNotGoOnBehindDamage) {
  const TemporaryFolder folder;
  const std::string bytes = write_log(folder / "run.lcm");
  const std::string damaged = bytes + std::string(40, 'X');
  write(folder / "damaged.lcm", damaged);
  LogReader reader(folder / "damaged.lcm");
  EXPECT_EQ(count_events(reader), kNumEvents);
  write(folder / "damaged.lcm", damaged + bytes);
  reader.go_on();
  EXPECT_FALSE(reader.next());
  EXPECT_THAT(reader.damage().value_or(""), HasSubstr("sync word"));
}

TEST(LogReader, StopsAtDamageInTheMiddle) {
  const TemporaryFolder folder;
  std::string bytes = write_log(folder / "run.lcm");
  const std::size_t second = 28 + std::string("CHANNEL_0").size();
  bytes[second] = 'X';
  write(folder / "damaged.lcm", bytes);
  LogReader reader(folder / "damaged.lcm");
  EXPECT_EQ(count_events(reader), 1);
  EXPECT_THAT(reader.damage().value_or(""), HasSubstr("sync word"));
}

TEST(LogReader, AnEventThatClaimsTwoGigabytesTakesNoMemory) {
  const TemporaryFolder folder;
  std::string bytes = write_log(folder / "run.lcm");
  bytes[24] = 0x7F;  // length of the first event's data
  write(folder / "huge.lcm", bytes);
  LogReader reader(folder / "huge.lcm");
  EXPECT_LT(testing::allocated_by([&] { EXPECT_FALSE(reader.next()); }), 4'096U);  // the error text
  EXPECT_THAT(reader.damage().value_or(""), HasSubstr("lacks its last"));
  bytes[24] = static_cast<char>(0xFF);
  write(folder / "negative.lcm", bytes);
  LogReader negative(folder / "negative.lcm");
  EXPECT_FALSE(negative.next());
  EXPECT_TRUE(negative.damage());
}

TEST(LogReader, RefusesFilesThatAreNoLogs) {
  const TemporaryFolder folder;
  EXPECT_THAT(refusal(folder / "missing.lcm"), HasSubstr("missing.lcm' cannot be read: No such"));
  EXPECT_THAT(refusal(folder.path()), HasSubstr("is a folder"));
  write(folder / "empty.lcm", "");
  EXPECT_THAT(refusal(folder / "empty.lcm"), HasSubstr("is empty"));
  write(folder / "foreign.lcm", "ply\nformat binary_little_endian 1.0\n");
  EXPECT_THAT(refusal(folder / "foreign.lcm"), HasSubstr("is no LCM log"));
  write(folder / "short.lcm", "abc");
  EXPECT_THAT(refusal(folder / "short.lcm"), HasSubstr("is no LCM log"));
}

}  // namespace
}  // namespace kintsugi
