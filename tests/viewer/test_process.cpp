// kintsugi-viewer as a program: logs and a private bus in, pictures out.

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/message_subscriber.hpp"
#include "lcmtypes/stream_subscriber.hpp"
#include "tests/support/private_bus.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/viewer/recorded_room.hpp"

namespace kintsugi::viewer {
namespace {

namespace fs = std::filesystem;
using testing::TemporaryFolder;

constexpr double kLength_m = 5.0;  // 20 slices
constexpr double kResolution_m = 0.05;

/// A running kintsugi-viewer.
class Program {
 public:
  /// `max_file_bytes` > 0: writing more than that into one file fails, as on a full disk.
  explicit Program(std::vector<std::string> arguments, rlim_t max_file_bytes = 0) {
    arguments.insert(arguments.begin(), KINTSUGI_VIEWER);
    std::vector<char*> argv;
    argv.reserve(arguments.size() + 1);
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    pid_ = fork();
    if (pid_ == 0) {
      if (max_file_bytes > 0) {
        const rlimit limit{max_file_bytes, max_file_bytes};
        setrlimit(RLIMIT_FSIZE, &limit);
        std::signal(SIGXFSZ, SIG_IGN);
      }
      execv(argv[0], argv.data());
      _exit(127);
    }
  }
  ~Program() {
    if (pid_ > 0) {
      kill(pid_, SIGKILL);
      wait();
    }
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void signal(int number) const { kill(pid_, number); }

  /// The exit code; negative: the signal that ended it.
  int wait() {
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

 private:
  pid_t pid_ = 0;
};

int run(std::vector<std::string> arguments, rlim_t max_file_bytes = 0) {
  return Program(std::move(arguments), max_file_bytes).wait();
}

cv::Size size_of(const fs::path& picture) { return cv::imread(picture.string()).size(); }

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename());
  std::ranges::sort(names);
  return names;
}

TEST(ViewerProcess, DrawsEachTenthSliceOfALogAndTheFinalMap) {
  const TemporaryFolder folder;
  write_log(folder / "room.log", make_room(kLength_m, kResolution_m));

  EXPECT_EQ(0, run({"--log", folder / "room.log", "--out", folder / "out", "--size", "640x360",
                    "--plots"}));

  const std::vector<std::string> expected{"final.png",           "map_final.png",
                                          "plots.png",           "segments_final.png",
                                          "snapshot_000009.png", "snapshot_000019.png"};
  EXPECT_EQ(expected, names_in(folder / "out"));
  for (const char* name : {"final.png", "map_final.png", "segments_final.png",
                           "snapshot_000009.png", "snapshot_000019.png"}) {
    EXPECT_EQ(cv::Size(640, 360), size_of(folder / "out" / name)) << name;
  }
}

TEST(ViewerProcess, DrawsAMapThatNobodySegments) {
  const TemporaryFolder folder;
  write_log(folder / "room.log", make_room(kLength_m, kResolution_m), {.updates = false});

  EXPECT_EQ(0, run({"--log", folder / "room.log", "--out", folder / "out", "--size", "640x360"}));

  EXPECT_TRUE(fs::exists(folder / "out/snapshot_000009.png"));
  EXPECT_TRUE(fs::exists(folder / "out/final.png"));
}

TEST(ViewerProcess, WritesAVideoThatPlaysBack) {
  const TemporaryFolder folder;
  const SyntheticMap room = make_room(kLength_m, kResolution_m);
  write_log(folder / "room.log", room);

  EXPECT_EQ(0, run({"--log", folder / "room.log", "--out", folder / "out", "--size", "320x180",
                    "--video", folder / "room.mp4", "--video-period", "0.5"}));

  // A frame at the first slice, and one for each half second of map time after it; poses come every
  // 1/30 s, so a frame may be that much late and the count one or two smaller.
  const double seconds =
      1e-6 * static_cast<double>(std::max(room.poses.back().utime, room.slices.back().utime) -
                                 room.slices.front().utime);
  cv::VideoCapture video((folder / "room.mp4").string());
  int frames = 0;
  for (cv::Mat frame; video.read(frame); ++frames) EXPECT_EQ(cv::Size(320, 180), frame.size());
  EXPECT_NEAR(1 + seconds / 0.5, frames, 2.0);
  EXPECT_EQ(std::vector<std::string>({"out", "room.log", "room.mp4"}), names_in(folder.path()));
}

TEST(ViewerProcess, KeepsTheFinalPicturesOfAnEarlierSession) {
  const TemporaryFolder folder;
  const SyntheticMap room = make_room(kLength_m, kResolution_m);
  write_log(folder / "room.log", room);
  write_log(folder / "room.log", room, {.session_offset = 5}, true);

  EXPECT_EQ(0, run({"--log", folder / "room.log", "--out", folder / "out", "--size", "320x180"}));

  const std::string session = std::to_string(room.slices.front().session);
  EXPECT_TRUE(fs::exists(folder / ("out/final_" + session + ".png")));
  EXPECT_TRUE(fs::exists(folder / "out/final.png"));
}

TEST(ViewerProcess, ReportsAFullDiskAndLeavesNothingHalfWritten) {
  const TemporaryFolder folder;
  write_log(folder / "room.log", make_room(kLength_m, kResolution_m));

  constexpr rlim_t kMaxFileBytes = 8192;  // smaller than any of the pictures
  EXPECT_EQ(1, run({"--log", folder / "room.log", "--out", folder / "out", "--size", "640x360",
                    "--video", folder / "room.mp4"},
                   kMaxFileBytes));

  EXPECT_EQ(std::vector<std::string>(), names_in(folder / "out"));
  EXPECT_EQ(std::vector<std::string>({"out", "room.log"}), names_in(folder.path()));
}

TEST(ViewerProcess, DrawsWhatATruncatedLogHolds) {
  const TemporaryFolder folder;
  write_log(folder / "room.log", make_room(kLength_m, kResolution_m));
  fs::resize_file(folder / "room.log", fs::file_size(folder / "room.log") - 100);

  EXPECT_EQ(1, run({"--log", folder / "room.log", "--out", folder / "out", "--size", "320x180"}));

  EXPECT_TRUE(fs::exists(folder / "out/final.png"));
}

TEST(ViewerProcess, RefusesWhatItCannotRun) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a_file") << "not a folder";
  EXPECT_NE(0, run({"--log", folder / "missing.log", "--out", folder / "out"}));
  EXPECT_NE(0, run({"--log", folder / "a_file", "--out", folder / "out"}));
  EXPECT_NE(0, run({"--log", folder / "a_file", "--out", folder / "a_file/out"}));
  EXPECT_NE(0, run({"--every", "0"}));
  EXPECT_NE(0, run({"--view", "1,2,3"}));
  EXPECT_NE(0, run({"--size", "1280"}));
  EXPECT_NE(0, run({"--size", "0x720"}));
  EXPECT_NE(0, run({"--unknown"}));
}

/// What the viewer says on a private bus while a room is published to it.
class ViewerOnBus : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const auto why_not = testing::enter_private_bus()) GTEST_SKIP() << *why_not;
    bus_ = std::make_unique<Bus>(testing::kPrivateBusUrl);
    subscribe<ViewerStatus>(*bus_, channels::kViewerStatus,
                            [this](const ViewerStatus& status) { status_ = status; });
    snapshots_.subscribe(*bus_);
  }

  std::vector<std::string> arguments(std::vector<std::string> more = {}) const {
    more.insert(more.end(), {"--lcm-url", testing::kPrivateBusUrl, "--out", folder_ / "out",
                             "--size", "640x360"});
    return more;
  }

  /// Handles the bus until `done` or half a minute has passed; true when done.
  template <class Condition>
  bool wait_until(Condition&& done) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (!done() && std::chrono::steady_clock::now() < deadline) {
      bus_->handle(std::chrono::milliseconds(20));
    }
    return done();
  }

  const TemporaryFolder folder_;
  std::unique_ptr<Bus> bus_;
  std::optional<ViewerStatus> status_;
  std::vector<Snapshot> pictures_;
  StreamSubscriber<Snapshot> snapshots_{
      channels::kSnapshot, [this](Snapshot snapshot) { pictures_.push_back(std::move(snapshot)); }};
};

TEST_F(ViewerOnBus, DrawsTheFinalMapAndExits) {
  Program program(arguments({"--exit-on-final"}));
  ASSERT_TRUE(wait_until([&] { return status_.has_value(); }));
  publish(*bus_, make_room(kLength_m, kResolution_m));
  ASSERT_TRUE(wait_until([&] { return status_->finished; }));
  EXPECT_EQ(0, program.wait());

  EXPECT_EQ(20, status_->slices_received);
  EXPECT_EQ(20, status_->updates_applied);
  EXPECT_EQ(0, status_->lag_slices);
  EXPECT_EQ(0, status_->messages_bad);
  EXPECT_TRUE(fs::exists(folder_ / "out/final.png"));
  ASSERT_FALSE(pictures_.empty());
  EXPECT_EQ(cv::Size(640, 360), cv::imdecode(pictures_.back().image_jpeg, cv::IMREAD_COLOR).size());
}

TEST_F(ViewerOnBus, WritesOnSignals) {
  SyntheticMap room = make_room(kLength_m, kResolution_m);
  room.slices.resize(5);
  room.updates.resize(5);
  Program program(arguments({"--video", folder_ / "room.mp4"}));
  ASSERT_TRUE(wait_until([&] { return status_.has_value(); }));
  publish(*bus_, room);
  ASSERT_TRUE(wait_until([&] { return status_->updates_applied == 5; }));

  program.signal(SIGUSR1);
  ASSERT_TRUE(wait_until([&] { return status_->snapshots_written == 1; }));
  EXPECT_TRUE(fs::exists(folder_ / "out/snapshot_000004.png"));

  program.signal(SIGTERM);
  EXPECT_EQ(0, program.wait());
  EXPECT_TRUE(fs::exists(folder_ / "out/final.png"));
  EXPECT_TRUE(cv::VideoCapture((folder_ / "room.mp4").string()).isOpened());
}

}  // namespace
}  // namespace kintsugi::viewer
