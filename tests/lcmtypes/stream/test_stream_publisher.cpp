#include <atomic>
#include <chrono>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/stream_recording.hpp"

namespace kintsugi {
namespace {

using namespace testing;  // NOLINT: the examples and recordings
using ::testing::IsEmpty;

TEST(StreamPublisher, NumbersChunksWithoutGapsAndAnnouncesTheNextNumber) {
  Recording recording;
  {
    StreamPublisher publisher(recording.transmit(), channels::kCloudSlice, 42, fast());
    publisher.publish(example_slice(1'000, 0));
    publisher.publish(example_slice(0, 1));
    publisher.publish(example_slice(300, 2));
    publisher.flush();
    EXPECT_EQ(publisher.chunks_published(), static_cast<std::int64_t>(recording.chunks.size()));
    EXPECT_EQ(publisher.queued_bytes(), 0U);
  }
  ASSERT_GT(recording.chunks.size(), 10U);
  for (std::size_t i = 0; i < recording.chunks.size(); ++i) {
    EXPECT_EQ(decode_chunk<CloudSlice>(recording.chunks[i]).sequence, static_cast<std::int64_t>(i));
    EXPECT_LE(recording.chunks[i].size(), kChunkBytes);
  }
  ASSERT_FALSE(recording.heartbeats.empty());
  EXPECT_EQ(recording.heartbeats.back().next_sequence,
            static_cast<std::int64_t>(recording.chunks.size()));
  EXPECT_EQ(recording.heartbeats.back().session, 42);
  EXPECT_EQ(recording.heartbeats.back().channel, channels::kCloudSlice);
}

TEST(StreamPublisher, SendsTheSameBytesAtAnyRate) {
  const std::vector<CloudSlice> slices = {example_slice(700, 0), example_slice(20, 1)};
  StreamPublisher::Config slow = fast();
  slow.rate_bytes_per_s = 500'000.0;
  slow.burst_bytes = 1'000;
  Recording recording;
  StreamPublisher publisher(recording.transmit(), channels::kCloudSlice, 42, slow);
  for (const CloudSlice& slice : slices) publisher.publish(slice);
  publisher.flush();
  EXPECT_EQ(recording.chunks, chunks_of(slices));
}

TEST(StreamPublisher, SendsQueuedMessagesBeforeItIsDestroyed) {
  Recording recording;
  {
    StreamPublisher publisher(recording.transmit(), channels::kCloudSlice, 42, fast());
    publisher.publish(example_slice(1'000, 0));
  }
  EXPECT_EQ(recording.chunks, chunks_of({example_slice(1'000, 0)}));
  EXPECT_EQ(recording.heartbeats.back().next_sequence,
            static_cast<std::int64_t>(recording.chunks.size()));
}

TEST(StreamPublisher, StoresEachChunkBeforeItIsSent) {
  RecentChunks store(10'000'000);
  Recording recording;
  const auto transmit = recording.transmit();
  StreamPublisher publisher(
      [&](const std::string& channel, ByteView message) {
        transmit(channel, message);
        EXPECT_GE(store.next_sequence(), static_cast<std::int64_t>(recording.chunks.size()));
      },
      channels::kCloudSlice, 42, fast(), &store);
  publisher.publish(example_slice(1'000, 0));
  publisher.flush();
  for (std::size_t i = 0; i < recording.chunks.size(); ++i) {
    EXPECT_EQ(store.find(static_cast<std::int64_t>(i)), recording.chunks[i]);
  }
  EXPECT_EQ(recording.heartbeats.back().first_sequence, 0);
}

TEST(StreamPublisher, RefusesInvalidMessagesInPublish) {
  Recording recording;
  StreamPublisher publisher(recording.transmit(), channels::kCloudSlice, 42, fast());
  CloudSlice bad = example_slice(10);
  bad.resolution_m = -1.0F;
  EXPECT_THROW(publisher.publish(bad), std::invalid_argument);
  CloudSlice other = example_slice(10);
  other.session = 41;
  EXPECT_THROW(publisher.publish(other), std::invalid_argument);
  publisher.flush();
  EXPECT_THAT(recording.chunks, IsEmpty());
}

TEST(StreamPublisher, ThrowsTheErrorOfSendingInFlushAndPublish) {
  StreamPublisher publisher(
      [](const std::string& channel, ByteView) {
        if (channel == channels::kCloudSlice) throw std::runtime_error("the network is down");
      },
      channels::kCloudSlice, 42, fast());
  publisher.publish(example_slice(10));
  EXPECT_THROW(publisher.flush(), std::runtime_error);
  EXPECT_THROW(publisher.publish(example_slice(10)), std::runtime_error);
}

TEST(StreamPublisher, ValidatesItsConfiguration) {
  Recording recording;
  for (auto* change : {+[](StreamPublisher::Config& c) { c.rate_bytes_per_s = 0.0; },
                       +[](StreamPublisher::Config& c) { c.burst_bytes = 0; },
                       +[](StreamPublisher::Config& c) { c.max_chunk_bytes = 100; },
                       +[](StreamPublisher::Config& c) { c.heartbeat_period = {}; }}) {
    StreamPublisher::Config config;
    change(config);
    EXPECT_THROW(StreamPublisher(recording.transmit(), "X", 1, config), std::invalid_argument);
  }
}

TEST(StreamPublisher, AnswersOnlyRequestsForItsSessionAndChannel) {
  Recording recording;
  RecentChunks store(10'000'000);
  StreamPublisher publisher(recording.transmit(), channels::kCloudSlice, 42, fast(), &store);
  publisher.publish(example_slice(1'000, 0));
  publisher.flush();
  const auto published = publisher.chunks_published();
  std::this_thread::sleep_for(std::chrono::milliseconds(60));  // ResendQueue::kInFlight_s is over
  EXPECT_FALSE(publisher.request({1, 41, channels::kCloudSlice, 1, {{0, 9}}}));
  EXPECT_FALSE(publisher.request({1, 42, channels::kSegmentUpdate, 1, {{0, 9}}}));
  EXPECT_TRUE(publisher.request({1, 42, channels::kCloudSlice, 1, {{1, 2}, {0, kMaxSequence}}}));
  while (publisher.counts().chunks_resent < published) std::this_thread::yield();
  EXPECT_EQ(publisher.counts().requests_received, 1);
  publisher.flush();
  EXPECT_EQ(publisher.counts().chunks_resent, published);
  EXPECT_EQ(publisher.chunks_published(), published);
}

TEST(StreamPublisher, ResumesTheSessionOfItsStore) {
  const std::vector<CloudSlice> slices = example_slices(4, 300);
  RecentChunks store(10'000'000);
  Recording first;
  {
    StreamPublisher publisher(first.transmit(), channels::kCloudSlice, 42, fast(), &store);
    publisher.publish(slices[0]);
    publisher.publish(slices[1]);
  }
  Recording second;
  {
    StreamPublisher publisher(second.transmit(), channels::kCloudSlice, 42, fast(), &store);
    EXPECT_EQ(publisher.chunks_published(), store.next_sequence());
    for (const CloudSlice& slice : slices) publisher.publish(slice);
    publisher.flush();
    EXPECT_EQ(publisher.counts().chunks_compared, static_cast<std::int64_t>(first.chunks.size()));
  }
  std::vector<Bytes> both = first.chunks;
  both.insert(both.end(), second.chunks.begin(), second.chunks.end());
  EXPECT_EQ(both, chunks_of(slices));

  Recording none;
  StreamPublisher third(none.transmit(), channels::kCloudSlice, 42, fast(), &store);
  third.publish(slices[1]);
  EXPECT_THROW(third.flush(), std::runtime_error);
  EXPECT_THROW(third.publish(slices[0]), std::runtime_error);
}

TEST(StreamPublisher, CanPublishAFullStateWhenOneIsWanted) {
  Recording recording;
  RecentChunks store(10'000);  // the last two chunks
  std::atomic<bool> is_wanted = false;
  StreamPublisher::Config config = fast();
  config.on_state_wanted = [&] { is_wanted = true; };
  StreamPublisher publisher(recording.transmit(), channels::kCloudSlice, 42, config, &store);
  for (const CloudSlice& slice : example_slices(10, 300)) publisher.publish(slice);
  publisher.flush();
  const auto before = publisher.chunks_published();
  publisher.request({1, 42, channels::kCloudSlice, 1, {{0, 0}}});
  while (!is_wanted) std::this_thread::yield();
  publisher.publish_state(example_slices(2, 300));
  publisher.publish(example_slice(300, 2));
  publisher.flush();
  EXPECT_EQ(recording.heartbeats.back().state_sequence, before);
  EXPECT_EQ(recording.heartbeats.back().next_sequence, before + 9);
  EXPECT_THROW(publisher.publish_state(std::vector<CloudSlice>{}), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi
