// The steps of a publisher, without its thread.

#include <map>
#include <optional>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/stream/stream_sender.hpp"

namespace kintsugi {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::size_t kChunkBytes = 1'000;

/// A sender whose chunks have their number as content, and everything that it has sent.
struct Sending {
  std::vector<std::int64_t> sequences;
  std::vector<double> times_s;
  std::vector<Heartbeat> heartbeats;
  std::vector<ChunksReplaced> replaced;
  double now_s = 0.0;
  StreamSender sender;

  explicit Sending(SentStore* store, const StreamPublisherConfig& config = fast())
      : sender([this](const std::string& channel, ByteView bytes) { note(channel, bytes); },
               channels::kCloudSlice, 42, config, store) {}

  static StreamPublisherConfig fast() {
    StreamPublisherConfig config;
    config.rate_bytes_per_s = 1e12;
    return config;
  }

  static Bytes chunk(std::int64_t sequence, std::uint8_t text = 0) {
    Bytes bytes(kChunkBytes, text);
    bytes[0] = static_cast<std::uint8_t>(sequence);
    return bytes;
  }
  void push(int num_chunks, bool starts_state = false, std::uint8_t text = 0) {
    sender.push(job(num_chunks, text, starts_state));
  }
  /// A message of three chunks that supersedes waiting ones with its key.
  void push_newest(std::int64_t key, std::uint8_t text) {
    StreamSender::Job newest = job(3, text);
    newest.key = key;
    newest.encode_superseded = [text](std::int64_t sequence) { return stub(sequence, text); };
    sender.push(std::move(newest));
  }
  static StreamSender::Job job(int num_chunks, std::uint8_t text, bool starts_state = false) {
    StreamSender::Job job;
    job.num_chunks = num_chunks;
    job.bytes = kChunkBytes * static_cast<std::size_t>(num_chunks);
    job.starts_state = starts_state;
    job.encode = [text](std::int64_t sequence, std::int32_t) { return chunk(sequence, text); };
    return job;
  }
  static Bytes stub(std::int64_t sequence, std::uint8_t text) {
    return {static_cast<std::uint8_t>(sequence), text};
  }
  void note(const std::string& channel, ByteView bytes) {
    if (channel == channels::kChunksReplaced) {
      replaced.push_back(decode<ChunksReplaced>(bytes));
    } else if (channel == channels::kHeartbeat) {
      heartbeats.push_back(decode<Heartbeat>(bytes));
    } else {
      sequences.push_back(bytes[0]);
      times_s.push_back(now_s);
    }
  }
  void ask(std::vector<SequenceRange> ranges) {
    sender.request({0, 42, channels::kCloudSlice, 1, std::move(ranges)}, now_s);
  }
  void run_until(double time_s) {
    while (now_s < time_s) {
      const double wait_s = sender.step(now_s);
      if (wait_s > 0.0) now_s = std::min(now_s + wait_s, time_s);
    }
  }
};

/// A store that needs time.
struct SlowStore : RecentChunks {
  SlowStore() : RecentChunks(1'000'000) {}
  bool is_safe(std::int64_t sequence) const override { return sequence < safe_end; }
  std::int64_t safe_end = 0;
};

TEST(StreamSender, SendsAndAnnouncesNothingThatIsNotSafeInTheStore) {
  SlowStore store;
  Sending sending(&store);
  sending.push(3, true);
  sending.push(2);
  sending.sender.announce();
  sending.run_until(0.5);
  EXPECT_EQ(store.next_sequence(), 5) << "all are on the way to where they are safe";
  EXPECT_THAT(sending.sequences, IsEmpty());
  EXPECT_EQ(sending.heartbeats.back().next_sequence, 0);
  EXPECT_EQ(sending.sender.queued_bytes(), 5 * kChunkBytes);
  EXPECT_FALSE(sending.sender.is_done());
  sending.ask({{0, 4}});
  sending.run_until(0.6);
  EXPECT_THAT(sending.sequences, IsEmpty()) << "on request neither";
  store.safe_end = 4;
  sending.run_until(1.0);
  EXPECT_THAT(sending.sequences, ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(sending.heartbeats.back().next_sequence, 4);
  EXPECT_EQ(sending.sender.queued_bytes(), 2 * kChunkBytes) << "until the whole message is sent";
  store.safe_end = 5;
  sending.run_until(1.5);
  EXPECT_THAT(sending.sequences, ElementsAre(0, 1, 2, 3, 4));
  EXPECT_TRUE(sending.sender.is_done());
}

TEST(StreamSender, StoresNoMoreThanASecondAhead) {
  SlowStore store;
  StreamPublisherConfig config;
  config.rate_bytes_per_s = 10.0 * kChunkBytes;
  Sending sending(&store, config);
  for (int i = 0; i < 20; ++i) sending.push(1);
  sending.run_until(0.5);
  EXPECT_EQ(store.next_sequence(), 10);
}

TEST(StreamSender, SendsNumberedChunksAndHeartbeatsFiveTimesASecond) {
  RecentChunks store(1'000'000);
  Sending sending(&store);
  sending.push(3);
  sending.push(2);
  EXPECT_EQ(sending.sender.queued_bytes(), 5 * kChunkBytes);
  sending.run_until(2.05);
  EXPECT_THAT(sending.sequences, ElementsAre(0, 1, 2, 3, 4));
  EXPECT_EQ(sending.heartbeats.size(), 11U);
  EXPECT_EQ(sending.heartbeats.back().next_sequence, 5);
  EXPECT_EQ(sending.heartbeats.back().first_sequence, 0);
  EXPECT_TRUE(sending.sender.is_done());
  EXPECT_EQ(sending.sender.queued_bytes(), 0U);
}

TEST(StreamSender, ResendsFromItsStoreOnly) {
  RecentChunks store(3 * kChunkBytes);
  Sending sending(&store);
  sending.push(10);
  sending.run_until(1.0);
  sending.sequences.clear();
  sending.ask({{0, kMaxSequence}});
  sending.run_until(1.1);
  EXPECT_THAT(sending.sequences, ElementsAre(7, 8, 9));
  EXPECT_EQ(sending.sender.counts().chunks_resent, 3);
  EXPECT_EQ(sending.heartbeats.back().first_sequence, 7);

  Sending without(nullptr);
  without.push(10);
  without.run_until(1.0);
  without.sequences.clear();
  without.ask({{0, 9}});
  without.run_until(2.0);
  EXPECT_THAT(without.sequences, IsEmpty());
  EXPECT_EQ(without.heartbeats.back().first_sequence, 10);
}

TEST(StreamSender, SkipsChunksThatItsStoreHasLost) {
  struct Holed : RecentChunks {
    using RecentChunks::RecentChunks;
    std::optional<Bytes> find(std::int64_t sequence) const override {
      return sequence < 90 ? std::nullopt : RecentChunks::find(sequence);
    }
  } store(1'000'000);
  Sending sending(&store);
  sending.push(100);
  sending.run_until(1.0);
  sending.sequences.clear();
  sending.ask({{0, 92}});
  sending.run_until(1.01);  // at once, without a wait for each lost chunk
  EXPECT_THAT(sending.sequences, ElementsAre(90, 91, 92));

  sending.sequences.clear();
  sending.ask({{0, 7}});
  sending.push(80);
  sending.run_until(1.02);
  EXPECT_EQ(sending.sequences.size(), 80U);
}

TEST(StreamSender, LimitsTheRateOfNewChunksAndResendsTogether) {
  RecentChunks store(1'000'000);
  StreamPublisherConfig config;
  constexpr std::size_t kCost = 8'000;  // of a small message
  config.rate_bytes_per_s = 50.0 * kCost;
  config.burst_bytes = 2 * kCost;
  Sending sending(&store, config);
  sending.push(200);
  sending.run_until(1.0);
  sending.ask({{0, 30}});
  sending.run_until(3.0);
  // The burst, and 50 per second for 3 s.
  EXPECT_NEAR(static_cast<double>(sending.sequences.size()), 152.0, 2.0);
  EXPECT_NEAR(static_cast<double>(sending.sender.counts().chunks_resent), 100.0 / 8.0, 1.0);
  for (std::size_t i = 3; i < sending.times_s.size(); ++i) {
    ASSERT_GE(sending.times_s[i] - sending.times_s[i - 3], 0.019) << i;  // at most three in 20 ms
  }
}

TEST(StreamSender, SmallMessagesInABurstAreFewerThanASubscriberHolds) {
  Sending sending(nullptr, {});
  sending.push(1'000);
  sending.run_until(0.0005);
  EXPECT_EQ(sending.sequences.size(), 15U);  // of 30
}

TEST(StreamSender, ResumesAStoredSessionAndSendsNothingTwice) {
  RecentChunks store(1'000'000);
  for (std::int64_t sequence = 0; sequence < 5; ++sequence) {
    store.add(sequence, Sending::chunk(sequence));
  }
  Sending sending(&store);
  EXPECT_EQ(sending.sender.next_sequence(), 5);
  sending.run_until(0.1);
  EXPECT_EQ(sending.heartbeats.back().next_sequence,
            5);  // announced before any chunk is published again
  sending.ask({{1, 2}});
  sending.push(3);
  sending.push(4);
  sending.run_until(1.0);
  EXPECT_THAT(sending.sequences, ::testing::UnorderedElementsAre(1, 2, 5, 6));
  EXPECT_EQ(sending.sender.counts().chunks_compared, 5);
  EXPECT_EQ(sending.sender.counts().chunks_sent, 2);
  EXPECT_EQ(store.next_sequence(), 7);
}

TEST(StreamSender, DetectsAResumedSessionThatDiffers) {
  RecentChunks store(1'000'000);
  for (std::int64_t sequence = 0; sequence < 5; ++sequence) {
    store.add(sequence, Sending::chunk(sequence));
  }
  Sending sending(&store);
  sending.push(2);
  sending.push(1, false, 99);
  try {
    sending.run_until(1.0);
    FAIL() << "not noticed";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("CLOUD_SLICE, sequence 2: differs from what was sent"));
    EXPECT_THAT(error.what(), HasSubstr("same device and options"));
  }
}

TEST(StreamSender, ALaterMessageSupersedesOneThatWaitsAndKeepsItsPlace) {
  RecentChunks store(1'000'000);
  Sending sending(&store);
  sending.push_newest(7, 1);
  sending.sender.step(0.0);  // the heartbeat
  sending.sender.step(0.0);  // chunk 0 of the first message, which has begun
  sending.push_newest(8, 2);
  sending.push_newest(7, 3);
  sending.push_newest(8, 4);
  EXPECT_EQ(sending.sender.counts().messages_superseded, 1);
  EXPECT_EQ(sending.sender.queued_bytes(), 9 * kChunkBytes);
  sending.run_until(1.0);
  EXPECT_EQ(store.find(2)->at(1), 1) << "the first message is sent whole";
  EXPECT_EQ(*store.find(3), Sending::stub(3, 2)) << "of the second one its place is left";
  EXPECT_EQ(store.find(4)->at(1), 3);
  EXPECT_EQ(store.find(9)->at(1), 4);
  EXPECT_EQ(store.next_sequence(), 10);
}

TEST(StreamSender, AResumedSessionFindsSupersededMessagesInTheirPlaces) {
  RecentChunks store(1'000'000);
  {
    Sending sending(&store);
    sending.push_newest(7, 1);
    sending.push_newest(7, 2);
    sending.run_until(1.0);
    ASSERT_EQ(sending.sender.next_sequence(), 4);
  }
  Sending again(&store);
  again.push_newest(7, 1);  // is superseded in the store, and not now
  again.push_newest(7, 2);
  again.push_newest(7, 3);
  again.run_until(1.0);
  EXPECT_EQ(again.sender.counts().chunks_compared, 4);
  EXPECT_THAT(again.sequences, ElementsAre(4, 5, 6));
}

TEST(StreamSender, AFullStateReplacesWhatWasSentBefore) {
  RecentChunks store(1'000'000);
  StreamPublisherConfig config = Sending::fast();
  int states_wanted = 0;
  config.on_state_wanted = [&] { ++states_wanted; };
  Sending sending(&store, config);
  sending.push(5);
  sending.push(3, true);
  sending.push(2);
  sending.run_until(1.0);
  EXPECT_EQ(sending.heartbeats.back().state_sequence, 5);
  EXPECT_EQ(sending.heartbeats.back().next_sequence, 10);
  sending.sequences.clear();
  sending.ask({{0, 5}});  // by a receiver that does not know of it yet
  sending.run_until(1.1);
  EXPECT_THAT(sending.sequences, ElementsAre(5));
  EXPECT_EQ(states_wanted, 0);

  store.set_max_bytes(3 * kChunkBytes);
  sending.push(1);
  sending.run_until(1.2);
  sending.ask({{0, 4}});
  EXPECT_EQ(states_wanted, 0);
  sending.ask({{8, kMaxSequence}});
  EXPECT_EQ(states_wanted, 0);
  sending.ask({{6, 6}});  // no longer in the store, and part of the full state
  EXPECT_EQ(states_wanted, 1);
}

/// A store from which chunks were removed because newer ones replace them.
struct RewrittenStore : RecentChunks {
  RewrittenStore() : RecentChunks(1'000'000) {}
  std::optional<Bytes> find(std::int64_t sequence) const override {
    const ChunkFate its = fate(sequence);
    if (its == ChunkFate::kKept) return RecentChunks::find(sequence);
    return its == ChunkFate::kChanged ? std::optional(Bytes{1, 2}) : std::nullopt;
  }
  ChunkFate fate(std::int64_t sequence) const override {
    const auto found = fates.find(sequence);
    return found == fates.end() ? ChunkFate::kKept : found->second;
  }
  std::vector<SequenceRange> replaced(std::int64_t begin, std::size_t max_ranges) const override {
    SequenceSet set;
    for (const auto& [sequence, its] : fates) {
      if (its != ChunkFate::kChanged) set.insert(sequence);
    }
    return set.ranges_from(begin, max_ranges);
  }
  std::map<std::int64_t, ChunkFate> fates;
};

TEST(StreamSender, TellsWhoAsksForReplacedChunksOfAllFromTheLowestOn) {
  RewrittenStore store;
  StreamPublisherConfig config = Sending::fast();
  config.map_name = "office";
  Sending sending(&store, config);
  sending.push(20);
  sending.run_until(0.1);
  for (const std::int64_t sequence : {2, 3, 7, 8, 12}) {
    store.fates[sequence] = ChunkFate::kReplaced;
  }
  sending.sequences.clear();
  sending.ask({{4, 9}, {3, 3}});
  sending.ask({{7, 7}});
  sending.run_until(1.0);
  EXPECT_THAT(sending.sequences, ElementsAre(4, 5, 6, 9)) << "those that are there are sent again";
  ASSERT_EQ(sending.replaced.size(), 1U);
  EXPECT_EQ(sending.replaced[0].session, 42);
  EXPECT_EQ(sending.replaced[0].channel, channels::kCloudSlice);
  EXPECT_EQ(sending.replaced[0].map_name, "office");
  EXPECT_THAT(sending.replaced[0].ranges,
              ElementsAre(SequenceRange{3, 3}, SequenceRange{7, 8}, SequenceRange{12, 12}));
  sending.ask({{4, 6}});
  sending.run_until(2.0);
  EXPECT_EQ(sending.replaced.size(), 1U) << "nothing that was asked for is replaced";
}

TEST(StreamSender, TellsOfReplacedChunksNotMoreOftenThanItSendsAgain) {
  RewrittenStore store;
  Sending sending(&store);
  sending.push(4);
  sending.run_until(0.5);
  store.fates[1] = ChunkFate::kReplaced;
  const double begin_s = sending.now_s;
  while (sending.now_s < begin_s + 1.0) {
    sending.ask({{0, 3}});
    sending.run_until(sending.now_s + 0.001);
  }
  EXPECT_LE(sending.replaced.size(), 1.0 / ResendQueue::kInFlight_s + 1);
  EXPECT_GE(sending.replaced.size(), 2U);
}

TEST(StreamSender, TellsOfAsManyReplacedChunksAsFitIntoAMessage) {
  RewrittenStore store;
  StreamPublisherConfig config = Sending::fast();
  config.max_chunk_bytes = kMinMaxChunkBytes;
  Sending sending(&store, config);
  sending.push(200);
  sending.run_until(0.1);
  for (std::int64_t sequence = 0; sequence < 200; sequence += 2) {
    store.fates[sequence] = ChunkFate::kReplaced;
  }
  sending.ask({{0, 0}});
  sending.run_until(1.0);
  ASSERT_EQ(sending.replaced.size(), 1U);
  EXPECT_LE(encode(sending.replaced[0]).size(), kMinMaxChunkBytes);
  EXPECT_GT(encode(sending.replaced[0]).size(), kMinMaxChunkBytes - 32);
}

TEST(StreamSender, AResumedSessionIsComparedAsFarAsItsChunksAreThere) {
  RewrittenStore store;
  {
    Sending before(&store);
    before.push(2, false, 1);
    before.push_newest(7, 1);  // superseded: of one chunk
    before.push_newest(7, 2);
    before.push(2, false, 3);
    before.run_until(1.0);
    ASSERT_THAT(before.sequences, ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
  }
  store.fates = {{0, ChunkFate::kReplaced},
                 {1, ChunkFate::kReplaced},
                 {2, ChunkFate::kSuperseded},
                 {4, ChunkFate::kChanged}};
  Sending again(&store);
  again.push(2, false, 9);  // cannot be compared
  again.push_newest(7, 9);
  again.push_newest(7, 2);
  again.push(2, false, 3);
  again.push(1, false, 4);
  again.run_until(1.0);
  EXPECT_THAT(again.sequences, ElementsAre(8)) << "each message has the place that it had";
  EXPECT_EQ(again.sender.counts().chunks_compared, 8);
  Sending other(&store);
  other.push(2, false, 1);
  other.push_newest(7, 1);
  other.push_newest(7, 9);
  EXPECT_THROW(other.run_until(1.0), std::runtime_error) << "chunk 3 is there, and differs";
}

}  // namespace
}  // namespace kintsugi
