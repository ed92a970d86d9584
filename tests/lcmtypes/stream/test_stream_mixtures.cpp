// All faults of the network and of the processes at once, by seed.

#include <algorithm>
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/simulated_streams.hpp"

namespace kintsugi {
namespace {

using namespace testing;  // NOLINT: the network and the examples

constexpr int kNumSlices = 150;
constexpr double kFaults_s =
    12.0;  // after that the network still loses messages, but no process is stopped or killed

class Mixture : public ::testing::TestWithParam<std::uint32_t> {
 protected:
  double uniform(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }

  /// Delays may be longer than a receiver waits, and longer than ResendQueue::kInFlight_s.
  Link any_link() {
    return {uniform(0.0, 0.3), uniform(0.0, 0.1), uniform(0.0, 0.3), uniform(0.0, 0.3),
            uniform(0.0, 0.05)};
  }

  SimulatedReceiver::Subscriber::Config any_limits() {
    SimulatedReceiver::Subscriber::Config config;
    if (random_() % 2 == 0) config.max_pending_bytes = 500'000;
    if (random_() % 2 == 0) config.max_gaps_per_session = 20;
    if (random_() % 2 == 0) config.max_asked_bytes = 200'000;
    config.room = [this, lacks = random_() % 2 == 0] {
      if (!lacks || simulation_.now_s() > kFaults_s) return StreamRoom::kPlenty;
      return StreamRoom{static_cast<int>(2.0 * simulation_.now_s()) %
                        3};  // another value every 0.5 s
    };
    return config;
  }

  void stop_now_and_then(SimulatedReceiver& receiver) {
    const double begin_s = uniform(0.0, kFaults_s - 4.0);
    simulation_.at(begin_s, [&] { receiver.stop(); });
    simulation_.at(begin_s + uniform(0.1, 4.0), [&] { receiver.go_on(); });
  }

  /// The sender publishes slices at random times, and all of them again after each kill.
  void publish_and_be_killed() {
    publish_next_ = [this] {
      if (sender_.is_running() && published_ < kNumSlices) {
        sender_.publish(example_slice(9'000, published_++));
      }
      simulation_.after(0.05, publish_next_);
    };
    publish_next_();
    for (double time_s = uniform(1.0, 4.0); time_s < kFaults_s - 3.0; time_s += uniform(3.5, 6.0)) {
      simulation_.at(time_s, [this] {
        sender_.crash();
        published_ = 0;
      });
      simulation_.at(time_s + uniform(0.05, 3.0), [this] { sender_.start(); });
    }
  }

  std::mt19937 random_{GetParam()};
  Simulation simulation_;
  RecentChunks store_{kAll};
  SimulatedSender sender_{simulation_, chunks_of(kDatagram), &store_};
  int published_ = 0;
  std::function<void()> publish_next_;
};

TEST_P(Mixture, EveryReceiverGetsEverySliceOnce) {
  for (std::uint32_t i = 0; i < 2; ++i)
    stop_now_and_then(sender_.join(any_link(), i, any_limits()));
  simulation_.at(uniform(1.0, 10.0), [this] { sender_.join(any_link(), 2, any_limits()); });
  publish_and_be_killed();
  simulation_.run_until(kFaults_s);
  EXPECT_TRUE(completes(simulation_, sender_, kNumSlices, 100.0));
  for (const auto& receiver : sender_.receivers) {
    EXPECT_EQ(receiver->subscriber.counts().messages_bad, 0);
    EXPECT_EQ(receiver->subscriber.pending_bytes(), 0U);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, Mixture, ::testing::Range(0U, 12U));

}  // namespace
}  // namespace kintsugi
