// Reliable streams over a simulated network: whatever fails, every message is received once.

#include <algorithm>
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/simulated_streams.hpp"

namespace kintsugi {
namespace {

using namespace testing;  // NOLINT: the network and the examples

TEST(StreamFaults, DuplicatesAndDisorderCauseNoRequests) {
  Simulation simulation;
  RecentChunks store(kAll);
  SimulatedSender sender(simulation, chunks_of(kFrame), &store);
  SimulatedReceiver& receiver = sender.join({.duplication = 0.2, .reordering = 0.3}, 1);
  publish_over(simulation, sender, 200, 300, 1.0);
  ASSERT_TRUE(completes(simulation, sender, 200, 20.0));
  EXPECT_EQ(receiver.requests, 0);
  EXPECT_EQ(sender.sender().counts().chunks_resent, 0);
  EXPECT_GT(receiver.subscriber.counts().chunks_duplicate, 100);
}

TEST(StreamFaults, AStoppedReceiverCatchesUpWithoutDelayingOthers) {
  for (const double stop_s : {0.5, 10.0}) {
    Simulation simulation;
    RecentChunks store(kAll);
    SimulatedSender sender(simulation, chunks_of(kDatagram), &store);
    SimulatedReceiver& stopped = sender.join({}, 1);
    SimulatedReceiver& other = sender.join({}, 2);
    publish_over(simulation, sender, 200, 9'000, 12.0);
    simulation.at(1.0, [&] { stopped.stop(); });
    simulation.at(1.0 + stop_s, [&] { stopped.go_on(); });
    simulation.run_until(12.2);
    EXPECT_TRUE(has_each_once(other, 200)) << stop_s;
    ASSERT_TRUE(completes(simulation, sender, 200, 20.0)) << stop_s;
    EXPECT_GT(stopped.datagrams_unsocketed, 0) << stop_s;
    EXPECT_EQ(stopped.subscriber.counts().chunks_given_up, 0);
    EXPECT_LE(sender.sender().counts().chunks_resent, 1.1 * stopped.datagrams_lost) << stop_s;
  }
}

TEST(StreamFaults, ALateReceiverGetsEverythingWhileOthersAreServed) {
  Simulation simulation;
  RecentChunks store(kAll);
  SimulatedSender sender(simulation, chunks_of(kDatagram), &store);
  SimulatedReceiver& early = sender.join({.loss = 0.02}, 1);
  publish_over(simulation, sender, 400, 9'000, 20.0);  // 115 MB
  simulation.run_until(15.0);
  sender.join({.loss = 0.02}, 2);
  simulation.run_until(20.0);
  // The early receiver does not have to wait until the late one has everything.
  simulation.run_until(21.5);
  EXPECT_TRUE(has_each_once(early, 400));
  ASSERT_TRUE(completes(simulation, sender, 400, 60.0));
  // 15 s of the stream at the bucket's rate, and its losses.
  EXPECT_LT(simulation.now_s(), 35.0);
}

TEST(StreamFaults, ALateReceiverGetsManySmallMessages) {
  Simulation simulation;
  RecentChunks store(kAll);
  SimulatedSender sender(simulation, chunks_of(kDatagram), &store);
  publish_over(simulation, sender, 5'000, 10, 1.0);
  simulation.run_until(2.0);
  sender.join({}, 1);
  ASSERT_TRUE(completes(simulation, sender, 5'000, 10.0));
}

TEST(StreamFaults, ASaturatedStreamSendsBothNewChunksAndResends) {
  Simulation simulation;
  RecentChunks store(kAll);
  SimulatedSender sender(simulation, chunks_of(kDatagram), &store);
  SimulatedReceiver& receiver = sender.join({.loss = 0.05}, 1);
  SimulatedReceiver& late = sender.join({.loss = 1.0}, 2);  // from 2 s on it requests everything
  publish_over(simulation, sender, 400, 9'000, 0.1);  // 115 MB at once: 11.5 s at the bucket's rate
  simulation.at(2.0, [&] { late.link.loss = 0.0; });
  simulation.run_until(8.0);
  const auto& counts = sender.sender().counts();
  const double resent_share = static_cast<double>(counts.chunks_resent) /
                              static_cast<double>(counts.chunks_resent + counts.chunks_sent);
  EXPECT_GT(resent_share, 0.75 / 8.0);  // one in eight, from 2 s of 8 on
  EXPECT_LE(resent_share, 1.0 / 8.0);
  EXPECT_GT(receiver.times_received.size(), 100U);
  ASSERT_TRUE(completes(simulation, sender, 400, 60.0));
}

TEST(StreamFaults, AKilledAndResumedSenderContinuesItsNumbers) {
  Simulation simulation;
  RecentChunks store(kAll);
  SimulatedSender sender(simulation, chunks_of(kDatagram), &store);
  SimulatedReceiver& receiver = sender.join({.loss = 0.05}, 1);
  std::mt19937 random(7);
  int published = 0;  // by one run of the sender, which starts again after each kill
  std::function<void()> publish_next = [&] {
    if (sender.is_running() && published < 200) sender.publish(example_slice(9'000, published++));
    simulation.after(0.03, publish_next);
  };
  publish_next();
  for (int kill = 0; kill < 5; ++kill) {
    const double time_s = 0.5 + 0.5 * kill + 0.0001 * static_cast<double>(random() % 1'000);
    simulation.at(time_s, [&] {
      sender.crash();
      published = 0;
    });
    // The last pause is so long that the receiver gives up.
    simulation.at(time_s + (kill < 4 ? 0.3 : 8.0), [&] {
      sender.start();
      for (int id = 0; id < 60; ++id) sender.publish(example_slice(9'000, published++));
    });
  }
  simulation.run_until(10.3);
  EXPECT_GT(receiver.subscriber.counts().chunks_given_up, 0);
  ASSERT_TRUE(completes(simulation, sender, 200, 60.0));
  EXPECT_GT(sender.sender().counts().chunks_compared, 0);
  EXPECT_EQ(receiver.subscriber.counts().chunks_given_up, 0);
}

TEST(StreamFaults, AFullStateReplacesChunksThatAreNotInTheStore) {
  Simulation simulation;
  RecentChunks store(2'000'000);  // about 7 slices
  std::int64_t states_wanted = 0;
  StreamPublisherConfig config = chunks_of(kDatagram);
  config.on_state_wanted = [&] { ++states_wanted; };
  SimulatedSender sender(simulation, config, &store);
  publish_over(simulation, sender, 100, 9'000, 5.0);
  simulation.run_until(5.0);
  EXPECT_EQ(states_wanted, 0);

  SimulatedReceiver& late = sender.join({.loss = 0.05}, 1);
  simulation.run_until(6.0);
  EXPECT_GT(states_wanted, 0);
  const std::int64_t wanted_before = states_wanted;
  sender.publish(example_slice(20'000, 1'000), true);
  sender.publish(example_slice(9'000, 1'001));
  simulation.run_until(8.0);
  EXPECT_LE(states_wanted, wanted_before + 3);  // until the receiver has a heartbeat
  EXPECT_EQ(late.times_received[1'000], 1);
  EXPECT_EQ(late.times_received[1'001], 1);
  EXPECT_TRUE(late.subscriber.is_complete(42));
  EXPECT_EQ(late.subscriber.counts().chunks_given_up, 0);
  EXPECT_EQ(late.subscriber.pending_bytes(), 0U);
  const std::int64_t asked = late.requests;
  simulation.run_until(30.0);
  EXPECT_EQ(late.requests, asked);
}

TEST(StreamFaults, OnlyChunksThatAreNotInTheStoreAreGivenUp) {
  Simulation simulation;
  RecentChunks store(2'000'000);
  SimulatedSender sender(simulation, chunks_of(kDatagram), &store);
  SimulatedReceiver& receiver = sender.join({.loss = 1.0}, 1);
  publish_over(simulation, sender, 100, 9'000, 5.0);
  simulation.run_until(4.0);
  receiver.link.loss = 0.1;
  simulation.run_until(4.5);
  store.set_max_bytes(kAll);
  publish_over(simulation, sender, 400, 9'000, 20.0, 100);
  simulation.run_until(30.0);
  // Chunks that no sender has are given up, even while other requests are answered.
  const auto gaps = receiver.subscriber.gaps();
  ASSERT_EQ(gaps.size(), 1U);
  EXPECT_LT(gaps[0].ranges.back().last, gaps[0].first_sequence);
  EXPECT_TRUE(receiver.subscriber.has_given_up(42));
  for (int id = 100; id < 500; ++id) EXPECT_EQ(receiver.times_received[id], 1) << id;
}

TEST(StreamFaults, RequestsStopWhenNobodyAnswers) {
  Simulation simulation;
  RecentChunks store(kAll);
  SimulatedSender replay(simulation, chunks_of(kDatagram), &store);
  SimulatedReceiver& receiver = replay.join({.loss = 0.1}, 1);
  receiver.on_request = [](const ResendRequest&) {};  // a replayed log cannot answer
  publish_over(simulation, replay, 100, 9'000, 4.0);
  simulation.run_until(4.5);
  EXPECT_GT(receiver.requests, 0);
  const std::int64_t missing = receiver.subscriber.counts().chunks_missing;
  EXPECT_GT(missing, 10);
  simulation.run_until(10.0);
  EXPECT_EQ(receiver.subscriber.counts().chunks_given_up, missing);
  EXPECT_TRUE(receiver.subscriber.has_given_up(42));
  EXPECT_LE(receiver.requests, 20);
  const std::int64_t requests = receiver.requests;
  simulation.run_until(110.0);
  EXPECT_LE(receiver.requests, requests + 11);  // one every 10 s, while heartbeats are received
  replay.crash();
  simulation.run_until(115.0);
  const std::int64_t at_the_end = receiver.requests;
  simulation.run_until(500.0);
  EXPECT_LE(receiver.requests, at_the_end + 1);
}

TEST(StreamFaults, WithoutMemoryNothingIsKeptRequestedOrGivenUp) {
  Simulation simulation;
  RecentChunks store(kAll);
  SimulatedSender sender(simulation, chunks_of(kDatagram), &store);
  StreamRoom room = StreamRoom::kNone;
  SimulatedReceiver::Subscriber::Config config;
  config.room = [&] { return room; };
  SimulatedReceiver& receiver = sender.join({}, 1, config);
  publish_over(simulation, sender, 100, 9'000, 5.0);
  simulation.run_until(20.0);
  const StreamCounts counts = receiver.subscriber.counts();
  EXPECT_EQ(receiver.requests, 0);
  EXPECT_EQ(receiver.max_pending_bytes, 0U);
  EXPECT_EQ(counts.chunks_given_up, 0);
  EXPECT_EQ(counts.chunks_refused, sender.chunks_on_wire);
  EXPECT_EQ(counts.chunks_missing, sender.chunks_on_wire);

  room = StreamRoom::kOnlyNext;
  simulation.run_until(21.0);
  EXPECT_GT(receiver.times_received.size(), 10U);
  room = StreamRoom::kPlenty;
  ASSERT_TRUE(completes(simulation, sender, 100, 20.0));
}

TEST(StreamFaults, AConsumerWithLittleMemoryGetsAllSlicesInOrder) {
  constexpr int kRoom = 4;
  Simulation simulation;
  RecentChunks store(kAll);
  SimulatedSender sender(simulation, chunks_of(kDatagram), &store);
  int next = 0;  // the consumer takes one slice every 0.1 s, in order
  const SimulatedReceiver* self = nullptr;
  SimulatedReceiver::Subscriber::Config config;
  config.room = [&] {
    if (self == nullptr) return StreamRoom::kPlenty;
    const int waiting = static_cast<int>(self->times_received.size()) - next;
    if (waiting < kRoom) return StreamRoom::kPlenty;
    return self->times_received.contains(next) ? StreamRoom::kNone : StreamRoom::kOnlyNext;
  };
  SimulatedReceiver& receiver = sender.join({.loss = 0.1, .reordering = 0.1}, 1, config);
  self = &receiver;
  int most_waiting = 0;
  std::function<void()> consume = [&] {
    most_waiting = std::max(most_waiting, static_cast<int>(receiver.times_received.size()) - next);
    if (receiver.times_received.contains(next)) ++next;
    simulation.after(0.1, consume);
  };
  consume();
  publish_over(simulation, sender, 100, 9'000, 5.0);
  simulation.run_until(60.0, [&] { return next == 100; });
  EXPECT_EQ(next, 100);
  EXPECT_TRUE(has_each_once(receiver, 100));
  EXPECT_GT(receiver.subscriber.counts().chunks_refused, 0);
  // The consumer's own limit, and the slices that the next 256 chunks complete meanwhile.
  EXPECT_LE(most_waiting, kRoom + 256 / 5 + 1);
  EXPECT_EQ(receiver.subscriber.counts().chunks_given_up, 0);
}

TEST(StreamFaults, AbsurdHeartbeatsCostLittleAndAreForgotten) {
  Simulation simulation;
  RecentChunks store(kAll);
  SimulatedSender sender(simulation, chunks_of(kDatagram), &store);
  SimulatedReceiver& receiver = sender.join({.loss = 0.05}, 1);
  publish_over(simulation, sender, 100, 9'000, 5.0);
  for (int i = 0; i < 20; ++i) {
    simulation.at(0.13 + 0.25 * i, [&, i] {
      Heartbeat absurd;
      absurd.session = 42;
      absurd.channel = channels::kCloudSlice;
      absurd.next_sequence = kMaxSequence;
      if (i % 3 == 1) absurd.state_sequence = kMaxSequence;
      if (i % 3 == 2) absurd.first_sequence = kMaxSequence;
      receiver.subscriber.handle(channels::kHeartbeat, encode(absurd));
    });
  }
  ASSERT_TRUE(completes(simulation, sender, 100, 30.0));
  EXPECT_EQ(receiver.subscriber.counts().chunks_missing, 0);
  EXPECT_LE(receiver.chunks_asked, 200 * 100);  // bounded by the window, not by the heartbeats
}

}  // namespace
}  // namespace kintsugi
