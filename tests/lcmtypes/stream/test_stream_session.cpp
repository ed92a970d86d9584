#include <vector>

#include <gtest/gtest.h>

#include "lcmtypes/stream/stream_session.hpp"

namespace kintsugi {
namespace {

Heartbeat beat(std::int64_t first, std::int64_t next, std::int64_t state = 0) {
  Heartbeat heartbeat;
  heartbeat.first_sequence = first;
  heartbeat.next_sequence = next;
  heartbeat.state_sequence = state;
  return heartbeat;
}

StreamSession a_session() { return StreamSession(ResendRequests::Config{}); }

TEST(StreamSession, AcceptsALowerHeartbeatWhenTheNextOneConfirmsIt) {
  StreamSession session = a_session();
  session.hear(beat(0, 10));
  session.hear(beat(0, 8));  // late
  EXPECT_EQ(session.next_sequence(), 10);
  session.hear(beat(0, 12));
  EXPECT_EQ(session.next_sequence(), 12);
  session.hear(beat(0, std::int64_t{1} << 48));  // false
  session.hear(beat(0, 13));
  session.hear(beat(0, 13));
  EXPECT_EQ(session.next_sequence(), 13);
}

TEST(StreamSession, AnInvalidChunkIsForgottenToo) {
  StreamSession session = a_session();
  session.hear(beat(0, 10));
  session.note(std::int64_t{1} << 47);
  session.keep(std::int64_t{1} << 47, 100);
  session.hear(beat(0, 10));
  session.hear(beat(0, 10));
  EXPECT_EQ(session.count_missing(), 10);
  for (std::int64_t sequence = 0; sequence < 10; ++sequence) session.keep(sequence, 100);
  EXPECT_TRUE(session.is_complete());
}

TEST(StreamSession, MissesNothingBeforeAFullState) {
  StreamSession session = a_session();
  session.hear(beat(0, 10));
  session.keep(9, 100);
  EXPECT_EQ(session.count_missing(), 9);
  session.hear(beat(0, 10, 9));
  EXPECT_TRUE(session.is_complete());
  EXPECT_TRUE(session.has(3));
}

TEST(StreamSession, TakesTheLowestMissingChunkIfThereIsAnyMemory) {
  StreamSession session = a_session();
  session.hear(beat(0, 10'000));
  for (std::int64_t sequence = 1; sequence < 100; sequence += 2) session.keep(sequence, 100);
  constexpr std::size_t kMaxGaps = 50;
  EXPECT_TRUE(session.takes(0, StreamRoom::kPlenty, kMaxGaps));
  EXPECT_TRUE(session.takes(100, StreamRoom::kPlenty, kMaxGaps));   // creates no gap
  EXPECT_FALSE(session.takes(200, StreamRoom::kPlenty, kMaxGaps));  // would create one too many
  EXPECT_TRUE(session.takes(200, StreamRoom::kPlenty, kMaxGaps + 1));
  EXPECT_TRUE(session.takes(0, StreamRoom::kOnlyNext, kMaxGaps));
  EXPECT_FALSE(session.takes(1'000, StreamRoom::kOnlyNext, 1'000));
  EXPECT_FALSE(session.takes(0, StreamRoom::kNone, kMaxGaps));
}

TEST(StreamSession, MissesNothingThatAnEarlierRunHasReceived) {
  StreamSession session = a_session();
  session.restore({{0, 499}, {600, 699}});
  EXPECT_EQ(session.next_sequence(), 700);
  EXPECT_EQ(session.chunks_kept(), 600);
  EXPECT_TRUE(session.has(499));
  session.hear(beat(0, 1'000));
  // The size of chunks is known from one further chunk only, not from restored ones.
  session.keep(999, 60'000);
  session.poll(StreamRoom::kPlenty, 600'000, 100, 0.0);
  const auto ranges = session.poll(StreamRoom::kPlenty, 600'000, 100, 0.1);
  ASSERT_EQ(ranges.size(), 1U);
  EXPECT_EQ(ranges[0], (SequenceRange{500, 509}));
}

/// Polls for `duration_s`. The sender is heard, and resends chunks from number 5 on.
std::vector<double> times_of_asking_for_the_rest(StreamSession& session, double duration_s) {
  std::vector<double> times_s;
  for (double now_s = 0.0; now_s < duration_s; now_s += 0.02) {
    session.hear(beat(5, 1'000));
    for (const auto& range : session.poll(StreamRoom::kPlenty, 4'000'000, 100, now_s)) {
      for (std::int64_t i = range.first; i <= range.last; ++i) {
        if (i < 5) continue;
        session.keep(i, 60'000);
        times_s.push_back(now_s);
      }
    }
  }
  return times_s;
}

TEST(StreamSession, GivesUpLostChunksAndThenAsksForTheRest) {
  StreamSession session = a_session();
  const auto times_s = times_of_asking_for_the_rest(session, 10.0);
  EXPECT_EQ(times_s.size(), 995U);
  EXPECT_GE(times_s.front(), 5.0);  // meanwhile a full state could have come
  EXPECT_EQ(session.count_given_up(), 5);
  EXPECT_TRUE(session.has_given_up());
}

TEST(StreamSession, AsksForNothingThatAFullStateReplaces) {
  StreamSession session = a_session();
  EXPECT_TRUE(times_of_asking_for_the_rest(session, 2.0).empty());
  session.hear(beat(5, 1'000, 999));
  session.poll(StreamRoom::kPlenty, 4'000'000, 100, 2.0);
  const auto ranges = session.poll(StreamRoom::kPlenty, 4'000'000, 100, 2.1);
  ASSERT_EQ(ranges.size(), 1U);
  EXPECT_EQ(ranges[0], (SequenceRange{999, 999}));
}

}  // namespace
}  // namespace kintsugi
