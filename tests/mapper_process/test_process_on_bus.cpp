// The built program on a bus of the test's own: what it publishes and leaves behind.

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "lcmtypes/bus_thread.hpp"
#include "lcmtypes/channels.hpp"
#include "lcmtypes/message_subscriber.hpp"
#include "lcmtypes/stream_subscriber.hpp"
#include "lcmtypes/trajectory.hpp"
#include "tests/support/private_bus.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::mapper {
namespace {

using kintsugi::testing::kPrivateBusUrl;

class MapperProgram {
 public:
  explicit MapperProgram(std::vector<std::string> flags) {
    const auto here = std::filesystem::read_symlink("/proc/self/exe").parent_path();
    flags.insert(flags.begin(), here.parent_path() / "bin" / "kintsugi-mapper");
    flags.insert(flags.end(), {"--lcm-url", kPrivateBusUrl});
    std::vector<char*> argv;
    argv.reserve(flags.size() + 1);
    for (std::string& flag : flags) argv.push_back(flag.data());
    argv.push_back(nullptr);
    if (posix_spawn(&pid_, argv[0], nullptr, nullptr, argv.data(), environ) != 0) pid_ = -1;
  }
  ~MapperProgram() {
    if (pid_ > 0) {
      kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
  }
  MapperProgram(const MapperProgram&) = delete;
  MapperProgram& operator=(const MapperProgram&) = delete;

  void interrupt() const { kill(pid_, SIGINT); }

  /// Its exit code; -1 if a signal ended it.
  int wait() {
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t pid_ = -1;
};

/// Everything the mapper says, kept.
class Listener {
 public:
  Listener() : bus_(kPrivateBusUrl) {
    kintsugi::subscribe<CameraPose>(bus_, channels::kCameraPose,
                                    [this](const CameraPose& pose) { keep(poses_, pose); });
    kintsugi::subscribe<MapperStatus>(
        bus_, channels::kMapperStatus,
        [this](const MapperStatus& status) { keep(statuses_, status); });
    slices_in_.subscribe(bus_);
    frames_in_.subscribe(bus_);
    thread_.emplace(bus_);
  }

  std::vector<CameraPose> poses() const { return copy(poses_); }
  std::vector<MapperStatus> statuses() const { return copy(statuses_); }
  std::vector<CloudSlice> slices() const { return copy(slices_); }
  std::vector<RgbdFrameMessage> frames() const { return copy(frames_); }

  bool heard_the_end() const {
    const auto statuses = this->statuses();
    return !statuses.empty() && statuses.back().finished;
  }

  /// Waits, long enough for a machine that has other things to do.
  template <typename Condition>
  static bool wait_until(const Condition& condition) {
    for (int i = 0; i < 600 && !condition(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return condition();
  }

 private:
  template <typename Message>
  void keep(std::vector<Message>& messages, Message message) {
    const std::scoped_lock lock(mutex_);
    messages.push_back(std::move(message));
  }
  template <typename Message>
  std::vector<Message> copy(const std::vector<Message>& messages) const {
    const std::scoped_lock lock(mutex_);
    return messages;
  }

  mutable std::mutex mutex_;
  std::vector<CameraPose> poses_;
  std::vector<MapperStatus> statuses_;
  std::vector<CloudSlice> slices_;
  std::vector<RgbdFrameMessage> frames_;
  Bus bus_;
  StreamSubscriber<CloudSlice> slices_in_{
      channels::kCloudSlice, [this](CloudSlice slice) { keep(slices_, std::move(slice)); }};
  StreamSubscriber<RgbdFrameMessage> frames_in_{
      channels::kRgbdFrame, [this](RgbdFrameMessage frame) { keep(frames_, std::move(frame)); }};
  std::optional<BusThread> thread_;
};

void expect_complete(const std::vector<CloudSlice>& slices, std::int64_t session) {
  ASSERT_FALSE(slices.empty());
  for (std::size_t i = 0; i < slices.size(); ++i) {
    EXPECT_EQ(slices[i].id, static_cast<int>(i));
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
