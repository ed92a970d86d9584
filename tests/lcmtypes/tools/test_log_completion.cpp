#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/base/patient_clock.hpp"
#include "lcmtypes/bus/bus_thread.hpp"
#include "lcmtypes/channels.hpp"
#include "lcmtypes/log/log_writer.hpp"
#include "lcmtypes/stream/stream_publisher.hpp"
#include "lcmtypes/tools/log_completion.hpp"
#include "tests/support/example_messages.hpp"
#include "tests/support/private_bus.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi {
namespace {

using namespace testing;  // NOLINT: the examples and the private bus

constexpr int kNumPoints = 10'000;  // 320 kB: 6 datagrams
constexpr std::size_t kPlentyBytes = 100'000'000;
constexpr int kNumSlices = 5;

struct Sent {
  std::string channel;
  Bytes message;
};

/// All that a sender of some messages transmits, its heartbeats included.
template <BulkMessage Message>
std::vector<Sent> sent(const std::string& channel, std::int64_t session,
                       const std::vector<Message>& messages) {
  std::vector<Sent> all;
  RecentChunks store(kPlentyBytes);
  StreamPublisher publisher(
      [&all](const std::string& on, ByteView message) {
        all.push_back({on, Bytes(message.begin(), message.end())});
      },
      channel, session, {}, &store);
  for (const Message& message : messages) publisher.publish(message);
  publisher.flush();
  return all;
}

std::vector<Sent> sent_slices() {
  return sent<CloudSlice>(channels::kCloudSlice, 42,
                          {example_slice(kNumPoints, 0), example_slice(kNumPoints, 1)});
}

SegmentUpdate update_of_session(std::int64_t session) {
  SegmentUpdate update = example_update(3, 0);
  update.session = session;
  return update;
}

class LogCompletionTest : public ::testing::Test {
 protected:
  void append(const Sent& event) { writer_.append(1, event.channel, event.message); }
  /// But for the event with this number.
  void append_all_but(const std::vector<Sent>& events, std::size_t left_out) {
    for (std::size_t i = 0; i < events.size(); ++i) {
      if (i != left_out) append(events[i]);
    }
  }
  std::int64_t num_missing() {
    completion().read_on();
    return completion().missing().chunks;
  }
  LogCompletion& completion() {
    if (!completion_) completion_.emplace(path());
    return *completion_;
  }
  [[nodiscard]] std::filesystem::path path() const { return folder_ / "run.lcm"; }

 private:
  TemporaryFolder folder_;
  LogWriter writer_ = LogWriter::create(path());
  std::optional<LogCompletion> completion_;
};

TEST_F(LogCompletionTest, KnowsWhatALogLacksUntilItComes) {
  const std::vector<Sent> events = sent_slices();
  append_all_but(events, 2);
  EXPECT_EQ(num_missing(), 1);
  append(events[2]);
  EXPECT_EQ(num_missing(), 0);
}

TEST_F(LogCompletionTest, ReadsAnEventOfWhichTheEndComesLater) {
  const std::vector<Sent> events = sent_slices();
  append_all_but(events, 2);
  EXPECT_EQ(num_missing(), 1);
  const auto size = std::filesystem::file_size(path());
  append(events[2]);
  std::ifstream file(path(), std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(file), {}};
  for (const auto cut : {size + 1, size + 30, size + 1'000}) {
    std::ofstream(path(), std::ios::binary) << whole.substr(0, cut);
    EXPECT_EQ(num_missing(), 1) << cut;
    EXPECT_EQ(completion().damage(), "") << cut;
  }
  std::ofstream(path(), std::ios::binary) << whole;
  EXPECT_EQ(num_missing(), 0);
}

TEST_F(LogCompletionTest, DoesNotWaitForASegmenterThatWasReplaced) {
  append_all_but(sent<SegmentUpdate>(channels::kSegmentUpdate, 5,
                                     {update_of_session(5), update_of_session(5)}),
                 1);
  EXPECT_EQ(num_missing(), 1);
  append_all_but(sent<SegmentUpdate>(channels::kSegmentUpdate, 6, {update_of_session(6)}), 100);
  EXPECT_EQ(num_missing(), 0);
}

TEST_F(LogCompletionTest, TellsWhereALogIsDamaged) {
  append(sent_slices().front());
  EXPECT_EQ(num_missing(), 0);
  std::ofstream(path(), std::ios::binary | std::ios::app) << "this is no event of a log at all";
  completion().read_on();
  EXPECT_THAT(completion().damage(), ::testing::HasSubstr("sync word"));
}

// As lcm-logger, which has no time for every third message.
TEST_F(LogCompletionTest, WhatItRequestsIsSentAgainAndRecorded) {
  if (const auto why_not = enter_private_bus()) GTEST_SKIP() << *why_not;
  Bus logging(kPrivateBusUrl);
  int num_heard = 0;
  for (const char* channel : {channels::kCloudSlice, channels::kHeartbeat}) {
    logging.subscribe(channel, [&, channel](ByteView message) {
      if (++num_heard % 3 != 0) append({channel, Bytes(message.begin(), message.end())});
    });
  }

  Bus sending(kPrivateBusUrl);
  RecentChunks store(kPlentyBytes);
  StreamPublisher publisher(sending, channels::kCloudSlice, 42, {}, &store);
  publisher.subscribe(sending);
  const BusThread answering(sending);
  for (int id = 0; id < kNumSlices; ++id) publisher.publish(example_slice(kNumPoints, id));
  publisher.flush();

  Bus asking(kPrivateBusUrl);
  PatientClock clock;
  const auto still_missing = [&] {
    while (logging.handle(std::chrono::milliseconds(20))) {
    }
    const std::int64_t missing = num_missing();
    completion().ask(asking, clock.now_s());
    return missing;
  };
  EXPECT_GT(still_missing(), 0);
  bool is_whole = false;
  for (int i = 0; i < 1'000 && !is_whole; ++i) is_whole = still_missing() == 0;
  EXPECT_TRUE(is_whole);
}

}  // namespace
}  // namespace kintsugi
