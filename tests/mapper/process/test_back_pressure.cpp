// A camera that does not wait and a bus that cannot keep up: frames go, slices never.

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/mapper/process/mapper_program.hpp"
#include "tests/mapper/process/stored_run.hpp"
#include "tests/support/private_bus.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::mapper {
namespace {

using testing::brisk_walk;
using testing::Listener;
using testing::MapperProgram;

TEST(BackPressure, DropsFramesOfALiveCameraAndCountsThemButNoSlices) {
  if (const auto why_not = kintsugi::testing::enter_private_bus()) GTEST_SKIP() << *why_not;
  const kintsugi::testing::TemporaryFolder folder;
  const Listener listener;
  std::vector<std::string> flags = brisk_walk(folder.path(), 150);
  flags[1] += "&camera=on";
  flags.insert(flags.end(), {"--rate", "0.02", "--map-name", "attic"});
  MapperProgram mapper(flags, folder / "said.txt");
  ASSERT_TRUE(Listener::wait_until([&] {
    const auto statuses = listener.statuses();
    return !statuses.empty() && statuses.back().frames_dropped > 5;
  }));
  mapper.interrupt();
  EXPECT_EQ(mapper.wait(), 0);
  ASSERT_TRUE(Listener::wait_until([&] { return listener.heard_the_end(); }));

  const auto slices = listener.slices();
  ASSERT_GT(slices.size(), 2U);
  EXPECT_TRUE(testing::ids_have_no_gap(slices));
  EXPECT_EQ(slices.back().kind, SliceKind::kFinal);
  // 3.2 s of the stream, and the slices of one frame: the whole volume at most.
  constexpr std::int64_t kMaxQueueBytes = 64'000 + 400'000;
  for (const MapperStatus& status : listener.statuses()) {
    EXPECT_LE(status.queue_bytes, kMaxQueueBytes);
  }
}

}  // namespace
}  // namespace kintsugi::mapper
