// The built program on a bus of the test's own: what it publishes and leaves behind.

#include <algorithm>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/trajectory.hpp"
#include "tests/mapper/process/mapper_program.hpp"
#include "tests/support/private_bus.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::mapper {
namespace {

using testing::Listener;
using testing::MapperProgram;

void expect_complete(const std::vector<CloudSlice>& slices, std::int64_t session) {
  ASSERT_FALSE(slices.empty());
  EXPECT_TRUE(testing::ids_have_no_gap(slices));
  for (std::size_t i = 0; i < slices.size(); ++i) {
    EXPECT_EQ(slices[i].session, session);
    EXPECT_EQ(slices[i].map_name, "attic");
    EXPECT_EQ(slices[i].kind == SliceKind::kFinal, i + 1 == slices.size());
  }
}

class MapperOnBus : public ::testing::Test {
 protected:
  void SetUp() override {
    static const auto why_not = kintsugi::testing::enter_private_bus();
    if (why_not) GTEST_SKIP() << *why_not;
  }
};

TEST_F(MapperOnBus, PublishesPosesStatusFramesAndEverySliceAndWritesThePath) {
  const kintsugi::testing::TemporaryFolder folder;
  const std::string path_file = folder / "path.txt";
  const Listener listener;
  MapperProgram mapper({"--device", "synthetic://office?frames=12", "--replay", "--session", "42",
                        "--map-name", "attic", "--volume-size", "4", "--resolution", "0.02",
                        "--publish-frames", "--output-trajectory", path_file});
  EXPECT_EQ(mapper.wait(), 0);
  ASSERT_TRUE(Listener::wait_until([&] { return listener.heard_the_end(); }));

  const auto poses = listener.poses();
  ASSERT_EQ(poses.size(), 12U);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(poses[i].session, 42);
    EXPECT_EQ(poses[i].frame_index, poses[0].frame_index + static_cast<int>(i));
    EXPECT_EQ(poses[i].state, TrackingState::kTracking);
  }
  expect_complete(listener.slices(), 42);
  EXPECT_EQ(listener.frames().size(), 12U);

  const MapperStatus status = listener.statuses().back();
  EXPECT_EQ(status.session, 42);
  EXPECT_EQ(status.map_name, "attic");
  EXPECT_EQ(status.frames_read, 12);
  EXPECT_EQ(status.frames_total, 12);
  EXPECT_EQ(status.frames_tracked, 12);
  EXPECT_EQ(status.frames_lost, 0);
  EXPECT_EQ(status.frames_dropped, 0);
  EXPECT_EQ(status.slices_published, static_cast<std::int64_t>(listener.slices().size()));
  EXPECT_GT(status.points_published, 0);
  EXPECT_GT(status.memory_bytes, 0);

  std::ifstream in(path_file);
  const Trajectory path = read_tum(in, path_file);
  ASSERT_EQ(path.size(), 12U);
  for (std::size_t i = 0; i < path.size(); ++i) {
    EXPECT_EQ(path[i].utime, poses[i].utime);
    EXPECT_TRUE(path[i].X_WC.isApprox(poses[i].X_WC, 1e-6));
  }
}

TEST_F(MapperOnBus, FinishesWhatItHasWhenInterrupted) {
  const kintsugi::testing::TemporaryFolder folder;
  const std::string path_file = folder / "path.txt";
  const Listener listener;
  MapperProgram mapper({"--device", "synthetic://office", "--replay", "--session", "43",
                        "--map-name", "attic", "--volume-size", "4", "--resolution", "0.02",
                        "--output-trajectory", path_file});
  ASSERT_TRUE(Listener::wait_until([&] { return listener.poses().size() >= 3; }));
  mapper.interrupt();
  EXPECT_EQ(mapper.wait(), 0);
  ASSERT_TRUE(Listener::wait_until([&] { return listener.heard_the_end(); }));
  EXPECT_LT(listener.statuses().back().frames_read, listener.statuses().back().frames_total);
  expect_complete(listener.slices(), 43);
  std::ifstream in(path_file);
  EXPECT_EQ(read_tum(in, path_file).size(), listener.poses().size());
}

TEST_F(MapperOnBus, SurvivesThatTheCameraIsUnpluggedAndPluggedInAgain) {
  const Listener listener;
  // 24 frames missed: 800 ms of the walk, and as long in fact.
  MapperProgram mapper(
      {"--device", "synthetic://office?frames=60&unplug_at=16&replug_after_ms=790&restart_clock=on",
       "--replay", "--session", "44", "--map-name", "attic", "--volume-size", "4", "--resolution",
       "0.02"});
  EXPECT_EQ(mapper.wait(), 0);
  ASSERT_TRUE(Listener::wait_until([&] { return listener.heard_the_end(); }));

  const auto poses = listener.poses();
  ASSERT_EQ(poses.size(), 36U);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    EXPECT_EQ(poses[i].frame_index, poses[i - 1].frame_index + 1);
    EXPECT_GT(poses[i].utime, poses[i - 1].utime);
  }
  EXPECT_GE(poses[16].utime - poses[15].utime, 790'000);
  EXPECT_EQ(poses.back().state, TrackingState::kTracking) << "and knows where it is again";

  const auto statuses = listener.statuses();
  const auto lost = [](const MapperStatus& status) { return status.state == TrackingState::kLost; };
  EXPECT_TRUE(std::ranges::any_of(statuses, lost)) << "while the camera was away";
  EXPECT_FALSE(lost(statuses.back()));
  EXPECT_EQ(statuses.back().frames_read, 36);
  EXPECT_EQ(statuses.back().frames_dropped, 0);
  expect_complete(listener.slices(), 44);
}

TEST_F(MapperOnBus, StopsWhileItWaitsForItsCamera) {
  const Listener listener;
  MapperProgram mapper({"--device", "synthetic://office?frames=60&unplug_at=6", "--replay",
                        "--session", "45", "--map-name", "attic", "--volume-size", "4",
                        "--resolution", "0.02"});
  ASSERT_TRUE(Listener::wait_until([&] {
    const auto statuses = listener.statuses();
    return !statuses.empty() && statuses.back().state == TrackingState::kLost;
  }));
  mapper.interrupt();
  EXPECT_EQ(mapper.wait(), 0);
  ASSERT_TRUE(Listener::wait_until([&] { return listener.heard_the_end(); }));
  EXPECT_EQ(listener.statuses().back().frames_read, 6);
  expect_complete(listener.slices(), 45);
}

}  // namespace
}  // namespace kintsugi::mapper
