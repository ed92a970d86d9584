#include <random>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/stream_publisher.hpp"
#include "lcmtypes/stream_subscriber.hpp"
#include "tests/support/example_messages.hpp"
#include "tests/support/message_equality.hpp"

namespace kintsugi {
namespace {

using namespace testing;  // NOLINT: the examples
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr std::size_t kChunkBytes = 4'000;

/// Everything a publisher transmits, in order.
struct Recording {
  std::vector<Bytes> chunks;
  std::vector<Heartbeat> heartbeats;

  StreamPublisher::Transmit transmit() {
    return [this](const std::string& channel, ByteView message) {
      if (channel == channels::kHeartbeat) {
        heartbeats.push_back(decode<Heartbeat>(message));
      } else {
        chunks.emplace_back(message.begin(), message.end());
      }
    };
  }
};

/// Fast enough that no test waits.
StreamPublisher::Config fast() {
  StreamPublisher::Config config;
  config.rate_bytes_per_s = 1e12;
  config.max_chunk_bytes = kChunkBytes;
  return config;
}

std::vector<Bytes> chunks_of(const std::vector<CloudSlice>& slices) {
  Recording recording;
  StreamPublisher publisher(recording.transmit(), channels::kCloudSlice, 42, fast());
  for (const CloudSlice& slice : slices) publisher.publish(slice);
  publisher.flush();
  return recording.chunks;
}

/// Slices 0 .. count - 1.
std::vector<CloudSlice> example_slices(int count, int num_points) {
  std::vector<CloudSlice> slices(static_cast<std::size_t>(count));
  for (int id = 0; id < count; ++id) {
    slices[static_cast<std::size_t>(id)] = example_slice(num_points, id);
  }
  return slices;
}

struct Receiver {
  std::vector<CloudSlice> slices;
  std::vector<std::string> reasons;
  StreamSubscriber<CloudSlice> stream;

  explicit Receiver(const StreamSubscriber<CloudSlice>::Config& config = {})
      : stream(
            channels::kCloudSlice, [this](CloudSlice slice) { slices.push_back(std::move(slice)); },
            [this](const DecodeError& reason) { reasons.emplace_back(reason.what()); }, config) {}

  void receive(const Bytes& chunk) { stream.handle(channels::kCloudSlice, chunk); }
  void receive(const std::vector<Bytes>& chunks) {
    for (const Bytes& chunk : chunks) receive(chunk);
  }
};

TEST(StreamPublisher, NumbersChunksWithoutGapsAndHeartbeatsTheNext) {
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

TEST(StreamPublisher, SendsTheSameBytesForTheSameMessagesHoweverPaced) {
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

TEST(StreamPublisher, SendsWhatIsQueuedBeforeItGoesAway) {
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

TEST(StreamPublisher, RefusesBadMessagesAtTheCall) {
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

TEST(StreamPublisher, ThrowsAtFlushAndPublishWhatSendingThrew) {
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

TEST(StreamSubscriber, PutsShuffledAndDuplicatedChunksTogether) {
  const std::vector<CloudSlice> slices = {example_slice(2'000, 0), example_slice(0, 1),
                                          example_slice(900, 2), example_slice(1, 3)};
  std::vector<Bytes> chunks = chunks_of(slices);
  const std::size_t num_chunks = chunks.size();
  std::mt19937 random(4);
  for (int round = 0; round < 20; ++round) {
    std::vector<Bytes> arrivals = chunks;
    arrivals.insert(arrivals.end(), chunks.begin(), chunks.end());
    std::shuffle(arrivals.begin(), arrivals.end(), random);
    Receiver receiver;
    receiver.receive(arrivals);
    ASSERT_THAT(receiver.slices, SizeIs(slices.size()));
    std::sort(receiver.slices.begin(), receiver.slices.end(),
              [](const auto& a, const auto& b) { return a.id < b.id; });
    for (std::size_t i = 0; i < slices.size(); ++i) EXPECT_TRUE(receiver.slices[i] == slices[i]);
    const StreamCounts counts = receiver.stream.counts();
    EXPECT_EQ(counts.chunks_received, static_cast<std::int64_t>(num_chunks));
    EXPECT_EQ(counts.chunks_duplicate, static_cast<std::int64_t>(num_chunks));
    EXPECT_EQ(counts.chunks_missing, 0);
    EXPECT_EQ(counts.messages_complete, static_cast<std::int64_t>(slices.size()));
    EXPECT_THAT(receiver.stream.gaps(), IsEmpty());
  }
}

TEST(StreamSubscriber, ReportsWhatIsMissingAndCompletesWhenItComes) {
  const CloudSlice slice = example_slice(1'000, 0);
  const std::vector<Bytes> chunks = chunks_of({slice});
  ASSERT_GE(chunks.size(), 8U);
  Receiver receiver;
  for (std::size_t i = 0; i < 6; ++i) {
    if (i != 1 && i != 3 && i != 4) receiver.receive(chunks[i]);
  }
  EXPECT_EQ(receiver.stream.counts().chunks_missing, 3);
  ASSERT_THAT(receiver.stream.gaps(), SizeIs(1));
  EXPECT_EQ(receiver.stream.gaps()[0].session, 42);
  EXPECT_THAT(receiver.stream.gaps()[0].ranges,
              ElementsAre(SequenceRange{1, 1}, SequenceRange{3, 4}));
  EXPECT_THAT(receiver.slices, IsEmpty());
  receiver.receive(chunks);
  EXPECT_EQ(receiver.stream.counts().chunks_missing, 0);
  ASSERT_THAT(receiver.slices, SizeIs(1));
  EXPECT_TRUE(receiver.slices[0] == slice);
}

TEST(StreamSubscriber, LearnsFromHeartbeatsWhatNeverCame) {
  Receiver receiver;
  const auto beat = [&](const Heartbeat& heartbeat) {
    receiver.stream.handle(channels::kHeartbeat, encode(heartbeat));
  };
  beat({1, 42, "SEGMENT_UPDATE", 0, 50, 0, ""});  // another stream
  EXPECT_EQ(receiver.stream.counts().chunks_missing, 0);
  beat({1, 42, "CLOUD_SLICE", 2, 5, 0, ""});
  EXPECT_EQ(receiver.stream.counts().chunks_missing, 5);
  ASSERT_THAT(receiver.stream.gaps(), SizeIs(1));
  EXPECT_EQ(receiver.stream.gaps()[0].first_sequence, 2);
  EXPECT_THAT(receiver.stream.gaps()[0].ranges, ElementsAre(SequenceRange{0, 4}));
  beat({1, 42, "CLOUD_SLICE", 2, 3, 0, ""});  // older than the last
  EXPECT_EQ(receiver.stream.counts().chunks_missing, 5);
}

TEST(StreamSubscriber, KeepsSessionsApart) {
  CloudSlice one = example_slice(500, 0);
  CloudSlice other = example_slice(500, 1);
  other.session = 77;
  Recording recording;
  StreamPublisher publisher(recording.transmit(), channels::kCloudSlice, 77, fast());
  publisher.publish(other);
  publisher.flush();
  const std::vector<Bytes> first = chunks_of({one});
  ASSERT_EQ(first.size(), recording.chunks.size());
  Receiver receiver;
  for (std::size_t i = 0; i < first.size(); ++i) {
    receiver.receive(first[i]);
    receiver.receive(recording.chunks[i]);
  }
  ASSERT_THAT(receiver.slices, SizeIs(2));
  EXPECT_TRUE(receiver.slices[0] == one);
  EXPECT_TRUE(receiver.slices[1] == other);
  EXPECT_EQ(receiver.stream.counts().chunks_duplicate, 0);
}

TEST(StreamSubscriber, CountsAndDropsBadMessages) {
  Receiver receiver;
  receiver.receive(Bytes{1, 2, 3});
  receiver.stream.handle(channels::kHeartbeat, Bytes{});
  EXPECT_EQ(receiver.stream.counts().messages_bad, 2);
  EXPECT_THAT(receiver.reasons, SizeIs(2));
  EXPECT_FALSE(receiver.stream.handle("SNAPSHOT", Bytes{}));
  // A chunk with the number of another message's chunk.
  const auto one = chunks_of({example_slice(500, 0)});
  const auto other = chunks_of({example_slice(500, 1)});
  receiver.receive(one[0]);
  receiver.receive(other[1]);
  EXPECT_EQ(receiver.stream.counts().messages_bad, 3);
  receiver.receive(one);
  EXPECT_THAT(receiver.slices, SizeIs(1));
}

TEST(StreamSubscriber, TakesOnlyWhatIsMissingLowestBeyondItsMemoryBound) {
  StreamSubscriber<CloudSlice>::Config config;
  config.max_pending_bytes = 20'000;
  Receiver receiver(config);
  const std::vector<Bytes> chunks = chunks_of(example_slices(300, 300));
  ASSERT_EQ(chunks.size(), 900U);  // three each
  std::int64_t offered = 0;
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    if (i % 3 == 2) continue;
    receiver.receive(chunks[i]);
    ++offered;
  }
  const StreamCounts before = receiver.stream.counts();
  EXPECT_EQ(before.messages_complete, 0);
  EXPECT_LE(before.chunks_received, 256);  // from the lowest missing one, number 2, on
  EXPECT_EQ(before.chunks_received + before.chunks_refused, offered);
  EXPECT_EQ(before.chunks_missing, 899 - before.chunks_received);
  EXPECT_GT(receiver.stream.pending_bytes(), config.max_pending_bytes);
  receiver.receive(chunks);  // what was refused comes again
  EXPECT_THAT(receiver.slices, SizeIs(300));
  EXPECT_EQ(receiver.stream.counts().chunks_missing, 0);
  EXPECT_EQ(receiver.stream.pending_bytes(), 0U);
}

TEST(StreamSubscriber, ForgetsTheSessionLongestSilent) {
  StreamSubscriber<CloudSlice>::Config config;
  config.max_sessions = 2;
  Receiver receiver(config);
  for (const std::int64_t session : {1, 2, 3}) {
    receiver.stream.handle(channels::kHeartbeat,
                           encode(Heartbeat{1, session, "CLOUD_SLICE", 0, 4, 0, ""}));
  }
  ASSERT_THAT(receiver.stream.gaps(), SizeIs(2));
  EXPECT_EQ(receiver.stream.gaps()[0].session, 2);
}

TEST(StreamSubscriber, RefusesWhatWouldOpenTooManyGaps) {
  StreamSubscriber<CloudSlice>::Config config;
  config.max_gaps_per_session = 4;
  Receiver receiver(config);
  const std::vector<Bytes> chunks = chunks_of(example_slices(40, 1));
  for (std::size_t i = 1; i < chunks.size(); i += 2) receiver.receive(chunks[i]);
  EXPECT_THAT(receiver.slices, SizeIs(4));
  EXPECT_EQ(receiver.stream.counts().chunks_refused, 16);
  receiver.receive(chunks);
  EXPECT_THAT(receiver.slices, SizeIs(40));
  EXPECT_EQ(receiver.stream.counts().chunks_missing, 0);
}

TEST(Stream, CarriesTheOtherBulkMessagesToo) {
  const auto carried = [](const auto& message) {
    using Message = std::remove_cvref_t<decltype(message)>;
    std::vector<Message> received;
    StreamSubscriber<Message> subscriber(
        "X", [&](Message complete) { received.push_back(std::move(complete)); });
    StreamPublisher publisher(
        [&](const std::string& channel, ByteView bytes) { subscriber.handle(channel, bytes); }, "X",
        message.session, fast());
    publisher.publish(message);
    publisher.flush();
    return received.size() == 1 && received[0] == message;
  };
  EXPECT_TRUE(carried(example_update(5'000)));
  EXPECT_TRUE(carried(example_frame(20'000, 9'001)));
  EXPECT_TRUE(carried(example_snapshot(33'333)));
}

}  // namespace
}  // namespace kintsugi
