// Writing logs: LCM itself can read them, events are complete, and data can be read back.

#include <filesystem>
#include <fstream>
#include <system_error>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>

#include "lcmtypes/log/log_reader.hpp"
#include "lcmtypes/log/log_writer.hpp"
#include "tests/support/example_messages.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi {
namespace {

using kintsugi::testing::example_bytes;
using kintsugi::testing::FileSizeLimit;
using kintsugi::testing::TemporaryFolder;
using ::testing::HasSubstr;

/// The number of events that LogReader finds; it must find no damage.
int count_events(const std::filesystem::path& path) {
  LogReader reader(path);
  int events = 0;
  while (reader.next()) ++events;
  EXPECT_EQ(reader.damage().value_or("none"), "none");
  return events;
}

TEST(LogWriter, IsReadByLcmEventByEvent) {
  const TemporaryFolder folder;
  const auto path = folder / "a.lcm";
  {
    LogWriter writer = LogWriter::create(path);
    for (int i = 0; i < 20; ++i) {
      writer.append(1'000'000'000'000 + i, "CHANNEL_" + std::to_string(i % 3),
                    example_bytes(i * 997));
    }
    EXPECT_EQ(writer.size_bytes(), static_cast<std::int64_t>(std::filesystem::file_size(path)));
  }
  lcm::LogFile log(path, "r");
  ASSERT_TRUE(log.good());
  for (int i = 0; i < 20; ++i) {
    const lcm::LogEvent* event = log.readNextEvent();
    ASSERT_NE(event, nullptr);
    EXPECT_EQ(event->eventnum, i);
    EXPECT_EQ(event->timestamp, 1'000'000'000'000 + i);
    EXPECT_EQ(event->channel, "CHANNEL_" + std::to_string(i % 3));
    const auto* data = static_cast<const std::uint8_t*>(event->data);
    EXPECT_EQ(Bytes(data, data + event->datalen), example_bytes(i * 997));
  }
  EXPECT_EQ(log.readNextEvent(), nullptr);
}

TEST(LogWriter, ReadsBackDataAtItsPlace) {
  LogWriter writer = LogWriter::temporary(std::filesystem::temp_directory_path());
  std::vector<std::int64_t> places;
  places.reserve(50);
  for (int i = 0; i < 50; ++i) places.push_back(writer.append(i, "C", example_bytes(i * 31)));
  for (int i = 49; i >= 0; --i) {
    EXPECT_EQ(writer.read(places[static_cast<std::size_t>(i)], static_cast<std::size_t>(i) * 31),
              example_bytes(i * 31));
  }
  EXPECT_THROW(writer.read(places.back(), 1'000'000), std::runtime_error);
}

TEST(LogWriter, WritesAnEventCompletelyOrNotAtAll) {
  const TemporaryFolder folder;
  const auto path = folder / "a.lcm";
  LogWriter writer = LogWriter::create(path);
  writer.append(1, "C", example_bytes(1000));
  const std::int64_t size = writer.size_bytes();
  {
    const FileSizeLimit limit(5000);
    try {
      writer.append(2, "C", example_bytes(60'000));
      FAIL() << "5000 bytes hold no 60 000";
    } catch (const std::system_error& error) {
      EXPECT_THAT(error.what(), HasSubstr(path.string()));
    }
    EXPECT_EQ(writer.size_bytes(), size);
    EXPECT_EQ(std::filesystem::file_size(path), static_cast<std::uintmax_t>(size));
    EXPECT_NO_THROW(writer.append(2, "C", example_bytes(100))) << "what fits is still taken";
  }
  writer.append(3, "C", example_bytes(60'000));
  EXPECT_EQ(count_events(path), 3);
}

TEST(LogWriter, ContinuesAfterAnIncompleteEvent) {
  const TemporaryFolder folder;
  const auto path = folder / "a.lcm";
  {
    LogWriter writer = LogWriter::create(path);
    for (int i = 0; i < 3; ++i) writer.append(i, "C", example_bytes(500));
  }
  const auto whole = std::filesystem::file_size(path);
  for (const int missing : {1, 400, 500, 520}) {  // in the data, in the header
    std::filesystem::resize_file(path, whole - static_cast<std::uintmax_t>(missing));
    LogReader reader(path);
    std::int64_t events = 0;
    while (reader.next()) ++events;
    EXPECT_EQ(events, 2);
    EXPECT_TRUE(reader.is_cut_off());
    LogWriter writer = LogWriter::open(path);
    writer.continue_after({reader.bytes_read(), events});
    writer.append(7, "C", example_bytes(500));
    EXPECT_EQ(count_events(path), 3);
    EXPECT_EQ(std::filesystem::file_size(path), whole);
  }
}

TEST(LogWriter, RefusesExistingMissingAndLockedFiles) {
  const TemporaryFolder folder;
  const auto path = folder / "a.lcm";
  EXPECT_THROW(LogWriter::open(path), std::system_error) << "not there";
  const LogWriter writer = LogWriter::create(path);
  EXPECT_THROW(LogWriter::create(path), std::system_error) << "there already";
  EXPECT_THROW(LogWriter::create(folder / "no" / "a.lcm"), std::system_error);
  EXPECT_THROW(LogWriter::create(folder.path()), std::system_error) << "a folder";
  try {
    LogWriter::open(path);
    FAIL() << "two writers";
  } catch (const std::system_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("another process"));
  }
}

}  // namespace
}  // namespace kintsugi
