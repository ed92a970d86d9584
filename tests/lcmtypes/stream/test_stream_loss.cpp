// How much a reliable stream resends, by loss, chunk size and number of receivers.

#include <cstdio>
#include <tuple>

#include <gtest/gtest.h>

#include "tests/support/simulated_streams.hpp"

namespace kintsugi {
namespace {

using namespace testing;  // NOLINT: the network and the examples

/// Loss, chunk size, receivers.
class Loss : public ::testing::TestWithParam<std::tuple<double, std::size_t, int>> {};

// Resent over lost chunks. It is above 1 when chunks are requested twice, or late.
constexpr double kMaxResendFactor = 1.1;

TEST_P(Loss, EverySliceIsReceivedOnceAndLittleIsResentForNothing) {
  const auto [loss, chunk_bytes, num_receivers] = GetParam();
  Simulation simulation;
  RecentChunks store(kAll);
  SimulatedSender sender(simulation, chunks_of(chunk_bytes), &store);
  for (int i = 0; i < num_receivers; ++i) {
    sender.join({.loss = loss}, 100U + static_cast<std::uint32_t>(i));
  }
  // 8 MB/s of the 10 MB/s that the bucket allows. For longer with large chunks, because they are
  // few.
  const bool is_large = chunk_bytes == kDatagram;
  const int count = is_large ? 200 : 400;
  const int num_points = is_large ? 9'000 : 300;
  const double duration_s = count * num_points * 32.0 / 8e6;
  publish_over(simulation, sender, count, num_points, duration_s);
  simulation.run_until(duration_s);
  ASSERT_TRUE(completes(simulation, sender, count, 60.0));

  std::int64_t lost = 0;
  for (const auto& receiver : sender.receivers) lost += receiver->datagrams_lost;
  const auto& counts = sender.sender().counts();
  std::printf(
      "loss %4.1f %%, chunks of %5zu bytes, %d receivers: %lld sent, %lld lost, "
      "%lld resent (%.3f a loss), complete %.2f s after the last slice\n",
      100.0 * loss, chunk_bytes, num_receivers, static_cast<long long>(counts.chunks_sent),
      static_cast<long long>(lost), static_cast<long long>(counts.chunks_resent),
      lost > 0 ? static_cast<double>(counts.chunks_resent) / static_cast<double>(lost) : 0.0,
      simulation.now_s() - duration_s);
  EXPECT_LE(static_cast<double>(counts.chunks_resent),
            kMaxResendFactor * static_cast<double>(lost));
  if (loss == 0.0) {
    EXPECT_EQ(counts.requests_received, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Rates, Loss,
                         ::testing::Combine(::testing::Values(0.0, 0.01, 0.05, 0.1, 0.3),
                                            ::testing::Values(kDatagram, kFrame),
                                            ::testing::Values(1, 3)));

}  // namespace
}  // namespace kintsugi
