#include <algorithm>
#include <random>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/stream/stream_subscriber.hpp"
#include "tests/support/message_equality.hpp"
#include "tests/support/stream_recording.hpp"

namespace kintsugi {
namespace {

using namespace testing;  // NOLINT: the examples and recordings
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

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

TEST(StreamSubscriber, JoinsShuffledAndDuplicatedChunks) {
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

TEST(StreamSubscriber, ReportsMissingChunksUntilTheyAreReceived) {
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

TEST(StreamSubscriber, LearnsOfMissingChunksFromHeartbeats) {
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

TEST(StreamSubscriber, SeparatesSessions) {
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
  // A chunk with the sequence number of another message's chunk.
  const auto one = chunks_of({example_slice(500, 0)});
  const auto other = chunks_of({example_slice(500, 1)});
  receiver.receive(one[0]);
  receiver.receive(other[1]);
  EXPECT_EQ(receiver.stream.counts().messages_bad, 3);
  receiver.receive(one);
  EXPECT_THAT(receiver.slices, SizeIs(1));
}

TEST(StreamSubscriber, RecoversFromAnInvalidChunkAmongValidOnes) {
  Receiver receiver;
  CloudSlice other = example_slice(500, 0);
  other.utime += 1;
  const auto true_chunks = chunks_of({example_slice(500, 0)});
  receiver.receive(chunks_of({other})[1]);
  for (int round = 0; round < 2; ++round) receiver.receive(true_chunks);  // sent and resent
  ASSERT_THAT(receiver.slices, SizeIs(1));
  EXPECT_TRUE(receiver.slices[0] == example_slice(500, 0));
  EXPECT_EQ(receiver.stream.counts().messages_bad, 1);
  EXPECT_EQ(receiver.stream.counts().chunks_missing, 0);
}

TEST(StreamSubscriber, IgnoresAForgottenSession) {
  Receiver receiver;
  const auto chunks = chunks_of({example_slice(500, 0), example_slice(500, 1)});
  receiver.receive(chunks[1]);
  EXPECT_FALSE(receiver.stream.is_complete(42));
  receiver.stream.forget(42);
  receiver.receive(chunks);
  receiver.stream.handle(channels::kHeartbeat,
                         encode(Heartbeat{1, 42, "CLOUD_SLICE", 0, 99, 0, ""}));
  EXPECT_THAT(receiver.slices, IsEmpty());
  EXPECT_EQ(receiver.stream.counts().chunks_duplicate, static_cast<std::int64_t>(chunks.size()));
  EXPECT_EQ(receiver.stream.counts().chunks_missing, 0);
  EXPECT_EQ(receiver.stream.pending_bytes(), 0U);
  EXPECT_THAT(receiver.stream.poll(1.0), IsEmpty());
}

TEST(StreamSubscriber, IgnoresTheSessionsOfOtherMaps) {
  StreamSubscriber<CloudSlice>::Config config;
  config.wanted = [](const CloudSlice& header) { return header.map_name == "kitchen"; };
  config.wanted_map_name = "kitchen";
  Receiver receiver(config);
  const auto beat = [&](std::int64_t session, const std::string& map_name) {
    receiver.stream.handle(channels::kHeartbeat,
                           encode(Heartbeat{1, session, "CLOUD_SLICE", 0, 50, 0, map_name}));
  };
  beat(42, "office");
  EXPECT_EQ(receiver.stream.counts().chunks_missing, 0);
  beat(42, "");  // may be of any map
  EXPECT_EQ(receiver.stream.counts().chunks_missing, 50);
  receiver.receive(chunks_of({example_slice(500, 0)})[0]);  // of map "office"
  EXPECT_EQ(receiver.stream.counts().chunks_unwanted, 1);
  EXPECT_EQ(receiver.stream.counts().chunks_missing, 0);
  beat(42, "");
  EXPECT_EQ(receiver.stream.counts().chunks_missing, 0);
  beat(43, "kitchen");
  EXPECT_EQ(receiver.stream.counts().chunks_missing, 50);
}

TEST(StreamSubscriber, CutsItsRequestsToTheSizeOfADatagram) {
  StreamSubscriber<CloudSlice>::Config config;
  config.receiver = 5;
  Receiver receiver(config);
  const std::vector<Bytes> chunks = chunks_of(example_slices(1'000, 1));
  for (std::size_t i = 1; i < chunks.size(); i += 2) receiver.receive(chunks[i]);
  receiver.stream.poll(1.0);
  const auto requests = receiver.stream.poll(2.0);
  std::vector<SequenceRange> ranges;
  for (const ResendRequest& request : requests) {
    EXPECT_LE(encode(request).size(), config.max_request_bytes);
    EXPECT_EQ(request.session, 42);
    EXPECT_EQ(request.receiver, 5);
    ranges.insert(ranges.end(), request.ranges.begin(), request.ranges.end());
  }
  EXPECT_GT(requests.size(), 2U);
  EXPECT_EQ(ranges, receiver.stream.gaps()[0].ranges);
  EXPECT_EQ(receiver.stream.counts().requests_sent, static_cast<std::int64_t>(requests.size()));
}

TEST(StreamSubscriber, InventedSessionsDoNotDisplaceARealOne) {
  StreamSubscriber<CloudSlice>::Config config;
  config.max_sessions = 8;
  Receiver receiver(config);
  const std::vector<Bytes> chunks = chunks_of(example_slices(4, 300));
  receiver.receive(chunks);
  for (std::int64_t session = 1'000; session < 3'000; ++session) {
    receiver.stream.handle(channels::kHeartbeat,
                           encode(Heartbeat{1, session, "CLOUD_SLICE", 0, 50, 0, ""}));
  }
  receiver.receive(chunks);
  EXPECT_THAT(receiver.slices, SizeIs(4));  // none twice
  EXPECT_LE(receiver.stream.gaps().size(), 7U);
}

TEST(StreamSubscriber, KeepsOnlyTheLowestMissingChunksBeyondItsMemoryLimit) {
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
  receiver.receive(chunks);  // the refused chunks are resent
  EXPECT_THAT(receiver.slices, SizeIs(300));
  EXPECT_EQ(receiver.stream.counts().chunks_missing, 0);
  EXPECT_EQ(receiver.stream.pending_bytes(), 0U);
}

TEST(StreamSubscriber, DropsTheSessionThatWasSilentLongest) {
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

TEST(StreamSubscriber, RefusesChunksThatWouldCreateTooManyGaps) {
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

/// The chunks of views with the times 0 to count - 1; each has as many.
std::vector<Bytes> chunks_of_views(int count) {
  Recording recording;
  CameraView view = example_view(9'000);
  StreamPublisher publisher(recording.transmit(), channels::kCameraView, view.session, fast());
  for (view.utime = 0; view.utime < count; ++view.utime) publisher.publish(view);
  publisher.flush();
  return recording.chunks;
}

TEST(StreamSubscriber, DropsTheOldestIncompleteMessageWhereNothingIsSentAgain) {
  constexpr int kViews = 600;
  const std::vector<Bytes> chunks = chunks_of_views(kViews);
  const std::size_t per_view = chunks.size() / kViews;
  ASSERT_GE(per_view, 3U);
  StreamSubscriber<CameraView>::Config config;
  config.max_pending_bytes = 100'000;
  std::vector<std::int64_t> times;
  StreamSubscriber<CameraView> stream(
      channels::kCameraView, [&](const CameraView& view) { times.push_back(view.utime); }, {},
      config);
  std::vector<std::int64_t> expected;
  for (std::size_t view = 0; view < kViews; ++view) {
    const bool is_damaged = view % 2 == 0 && view + 1 < kViews;
    if (!is_damaged) expected.push_back(static_cast<std::int64_t>(view));
    for (std::size_t i = 0; i < per_view; ++i) {
      if (is_damaged && i == 1) continue;
      stream.handle(channels::kCameraView, chunks[view * per_view + i]);
    }
    EXPECT_LE(stream.pending_bytes(), config.max_pending_bytes + 10'000);
  }
  EXPECT_EQ(times, expected);
  const StreamCounts counts = stream.counts();
  EXPECT_EQ(counts.chunks_refused, 0);
  EXPECT_GT(counts.messages_given_up, 250);
  EXPECT_LT(counts.messages_given_up, 300) << "the newest still wait";
}

TEST(StreamSubscriber, GapsOfAStreamOfWhichNothingIsSentAgainDoNotEndIt) {
  constexpr int kViews = 200;
  const std::vector<Bytes> chunks = chunks_of_views(kViews);
  const std::size_t per_view = chunks.size() / kViews;
  StreamSubscriber<CameraView>::Config config;
  config.max_gaps_per_session = 4;
  int views = 0;
  StreamSubscriber<CameraView> stream(
      channels::kCameraView, [&](const CameraView&) { ++views; }, {}, config);
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    if (i / per_view % 2 == 0) continue;  // every other view is lost
    stream.handle(channels::kCameraView, chunks[i]);
  }
  EXPECT_EQ(views, kViews / 2);
  EXPECT_EQ(stream.counts().chunks_refused, 0);
}

TEST(StreamSubscriber, WhatAnEndedSessionLeftIncompleteMakesRoomForTheNext) {
  const std::vector<Bytes> left = chunks_of_views(2);
  StreamSubscriber<CameraView>::Config config;
  config.max_pending_bytes = 1;
  int views = 0;
  StreamSubscriber<CameraView> stream(
      channels::kCameraView, [&](const CameraView&) { ++views; }, {}, config);
  stream.handle(channels::kCameraView, left.front());
  Recording next;
  CameraView view = example_view(9'000);
  view.session += 1;
  StreamPublisher publisher(next.transmit(), channels::kCameraView, view.session, fast());
  publisher.publish(view);
  publisher.flush();
  for (const Bytes& chunk : next.chunks) stream.handle(channels::kCameraView, chunk);
  EXPECT_EQ(views, 1);
  EXPECT_EQ(stream.counts().messages_given_up, 1);
}

TEST(Stream, CarriesAllBulkMessages) {
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
  EXPECT_TRUE(carried(example_view(33'333)));
  EXPECT_TRUE(carried(example_keyframe(500)));
  EXPECT_TRUE(carried(example_snapshot(33'333)));
}

ChunksReplaced replaced_chunks(std::vector<SequenceRange> ranges) {
  ChunksReplaced replaced;
  replaced.session = 42;
  replaced.channel = channels::kCloudSlice;
  replaced.ranges = std::move(ranges);
  return replaced;
}

TEST(StreamSubscriber, DoesNotWaitForChunksThatAreReplacedAndDropsWhatCameOfTheirMessages) {
  const std::vector<CloudSlice> slices = {example_slice(300, 0), example_slice(300, 1)};
  const std::vector<Bytes> chunks = chunks_of(slices);
  const auto per_slice = static_cast<std::int64_t>(chunks.size()) / 2;
  ASSERT_GE(per_slice, 3);
  Receiver receiver;
  receiver.receive(chunks[0]);  // of the first slice, whose other chunks are replaced
  for (std::int64_t i = per_slice; i < 2 * per_slice; ++i) receiver.receive(chunks.at(i));
  EXPECT_GT(receiver.stream.pending_bytes(), 0U);
  const auto tell = [&](std::vector<SequenceRange> ranges) {
    EXPECT_TRUE(receiver.stream.handle(channels::kChunksReplaced,
                                       encode(replaced_chunks(std::move(ranges)))));
  };
  tell({{1, per_slice - 1}});
  EXPECT_EQ(receiver.stream.pending_bytes(), 0U);
  EXPECT_EQ(receiver.stream.counts().chunks_missing, 1) << "another one may come in its place";
  ASSERT_FALSE(receiver.stream.poll(1.0).empty() && receiver.stream.poll(2.0).empty());
  tell({{0, 0}});
  EXPECT_TRUE(receiver.stream.is_complete(42));
  receiver.receive(chunks);
  EXPECT_THAT(receiver.slices, SizeIs(1)) << "what comes late is a duplicate";
  EXPECT_THAT(receiver.reasons, IsEmpty());
}

TEST(StreamSubscriber, TakesWhatIsToldOfReplacedChunksOfItsStreamOnly) {
  const std::vector<Bytes> chunks = chunks_of({example_slice(300, 0)});
  StreamSubscriber<CloudSlice>::Config config;
  config.wanted_map_name = "office";
  Receiver receiver(config);
  receiver.receive(chunks.back());
  const auto missing = receiver.stream.counts().chunks_missing;
  ASSERT_GT(missing, 0);
  ChunksReplaced replaced = replaced_chunks({{0, missing}});
  replaced.map_name = "kitchen";
  receiver.stream.handle(channels::kChunksReplaced, encode(replaced));
  replaced.map_name = "office";
  replaced.channel = channels::kKeyframe;
  receiver.stream.handle(channels::kChunksReplaced, encode(replaced));
  EXPECT_EQ(receiver.stream.counts().chunks_missing, missing);
  replaced.channel = channels::kCloudSlice;
  receiver.stream.handle(channels::kChunksReplaced, encode(replaced));
  EXPECT_EQ(receiver.stream.counts().chunks_missing, 0);
}

TEST(StreamSubscriber, IsNotFilledByInventedReplacements) {
  StreamSubscriber<CloudSlice>::Config config;
  config.max_gaps_per_session = 100;
  Receiver receiver(config);
  receiver.receive(chunks_of({example_slice(0, 0)}));
  std::vector<SequenceRange> ranges;
  for (std::int64_t i = 1; i <= 200; ++i) ranges.push_back({10 * i, 10 * i});
  receiver.stream.handle(channels::kChunksReplaced, encode(replaced_chunks(ranges)));
  Heartbeat heartbeat = example_heartbeat();
  heartbeat.state_sequence = heartbeat.first_sequence = 0;
  heartbeat.next_sequence = 3'000;
  receiver.stream.handle(channels::kHeartbeat, encode(heartbeat));
  EXPECT_EQ(receiver.stream.counts().chunks_missing, 2'999) << "none of them was taken";
}

}  // namespace
}  // namespace kintsugi
