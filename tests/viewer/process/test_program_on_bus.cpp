// kintsugi-viewer as a program on a private bus, with a mapper and a segmenter that answer.

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "lcmtypes/bus/message_subscriber.hpp"
#include "lcmtypes/channels.hpp"
#include "lcmtypes/stream/stream_publisher.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"
#include "tests/support/private_bus.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/viewer/support/patched_room.hpp"
#include "tests/viewer/support/recorded_room.hpp"
#include "tests/viewer/support/stuck_file.hpp"
#include "tests/viewer/support/viewer_program.hpp"

namespace kintsugi::viewer {
namespace {

namespace fs = std::filesystem;
using testing::TemporaryFolder;

constexpr double kLength_m = 5.0;  // 20 slices
constexpr double kResolution_m = 0.05;

/// Receives the status and the pictures of viewers on a private bus.
class ViewerOnBus : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const auto why_not = testing::enter_private_bus()) GTEST_SKIP() << *why_not;
    bus_ = std::make_unique<Bus>(testing::kPrivateBusUrl);
    subscribe<ViewerStatus>(*bus_, channels::kViewerStatus, [this](const ViewerStatus& status) {
      status_ = status;
      viewers_.insert(status.session);
    });
    snapshots_.subscribe(*bus_);
  }

  std::vector<std::string> arguments(std::vector<std::string> more = {},
                                     const std::string& out = "out") const {
    more.insert(more.end(), {"--lcm-url", testing::kPrivateBusUrl, "--out", folder_ / out, "--size",
                             "640x360"});
    return more;
  }

  /// Starts another viewer and waits for its first status.
  std::unique_ptr<Program> start(const std::string& out, RoomOnBus* room = nullptr) {
    const std::size_t others = viewers_.size();
    auto program = std::make_unique<Program>(arguments({"--exit-on-final"}, out));
    EXPECT_TRUE(wait_until([&] { return viewers_.size() > others; }, room));
    return program;
  }

  /// Handles the bus until `done` or a generous timeout; true when done.
  template <class Condition>
  bool wait_until(Condition&& done, RoomOnBus* room = nullptr) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    while (!done() && std::chrono::steady_clock::now() < deadline) {
      bus_->handle(std::chrono::milliseconds(20));
      if (room != nullptr) room->serve();
    }
    return done();
  }

  const TemporaryFolder folder_;
  std::unique_ptr<Bus> bus_;
  std::optional<ViewerStatus> status_;  // the newest one, of any viewer
  std::set<std::int64_t> viewers_;      // sessions of the viewers whose status was received
  std::vector<Snapshot> pictures_;
  StreamSubscriber<Snapshot> snapshots_{
      channels::kSnapshot, [this](Snapshot snapshot) { pictures_.push_back(std::move(snapshot)); }};
};

TEST_F(ViewerOnBus, DrawsTheFinalMapAndExits) {
  Program program(arguments({"--exit-on-final"}));
  ASSERT_TRUE(wait_until([&] { return status_.has_value(); }));
  publish(*bus_, make_room(kLength_m, kResolution_m));
  ASSERT_TRUE(wait_until([&] { return status_->finished; }));
  ASSERT_TRUE(wait_until([&] { return program.has_ended(); }));
  EXPECT_EQ(0, program.wait());
  ASSERT_TRUE(wait_until([&] { return !pictures_.empty(); }));  // it may come after the status

  EXPECT_EQ(20, status_->slices_received);
  EXPECT_EQ(20, status_->updates_applied);
  EXPECT_EQ(0, status_->lag_slices);
  EXPECT_EQ(0, status_->messages_bad);
  EXPECT_TRUE(fs::exists(folder_ / "out/final.png"));
  EXPECT_EQ(cv::Size(640, 360), cv::imdecode(pictures_.back().image_jpeg, cv::IMREAD_COLOR).size());
}

TEST_F(ViewerOnBus, ShowsWhatTheSegmenterAnswersToAnybody) {
  const SyntheticMap room = make_room(kLength_m, kResolution_m);
  const Program program(arguments());
  ASSERT_TRUE(wait_until([&] { return status_.has_value(); }));
  publish(*bus_, room);
  ASSERT_TRUE(wait_until([&] { return status_->finished; }));
  SegmentAnswer answer;
  answer.utime = 1;
  answer.session = room.updates.front().session;
  answer.client = 77;
  answer.map_session = room.slices.front().session;
  answer.map_slices = 20;
  answer.map_points = 1'000;
  answer.map_segments = 6;
  answer.num_matching = 1;
  DescribedSegment& segment = answer.segments.emplace_back();
  segment.statistics.segment_id = 7;
  segment.statistics.num_points = 1;
  for (int i = 0; i < 3; ++i) segment.oriented_box_axes_W[i][i] = 1.0F;
  StreamPublisher answers(*bus_, channels::kSegmentAnswer, answer.session, {});
  answers.publish(answer);
  EXPECT_TRUE(wait_until([&] { return fs::exists(folder_ / "out/highlight.png"); }));
  EXPECT_EQ(0, status_->messages_bad);
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
  EXPECT_TRUE(fs::exists(folder_ / "out/snapshot_0004.5s.png"));

  program.signal(SIGTERM);
  EXPECT_EQ(0, program.wait());
  EXPECT_TRUE(fs::exists(folder_ / "out/final.png"));
  EXPECT_TRUE(cv::VideoCapture((folder_ / "room.mp4").string()).isOpened());
}

TEST_F(ViewerOnBus, ShowsWhatTheCameraSeesBeforeThereIsAMap) {
  const SyntheticMap room = make_patched_room(kLength_m, kResolution_m);
  Program program(arguments({}));
  ASSERT_TRUE(wait_until([&] { return status_.has_value(); }));
  StreamPublisher views(*bus_, channels::kCameraView, room.views.front().session, {});
  views.publish(room.views.front());
  ASSERT_TRUE(wait_until([&] { return status_->map_session == room.views.front().session; }));
  program.signal(SIGUSR1);
  ASSERT_TRUE(wait_until([&] { return status_->snapshots_written == 1; }));
  EXPECT_TRUE(fs::exists(folder_ / "out/snapshot_0000.0s.png"));
  program.signal(SIGTERM);
  EXPECT_EQ(0, program.wait());
  EXPECT_FALSE(fs::exists(folder_ / "out/final.png"));
}

std::string bytes_of_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST_F(ViewerOnBus, DrawsTheSameFinalPicturesWheneverItWasStartedAndWhoeverWasRestarted) {
  const SyntheticMap room = make_room(kLength_m, kResolution_m);
  RoomOnBus trio(*bus_, room);
  const auto from_start = start("from_start");
  const auto killed = start("restarted");
  trio.publish(8);
  killed->signal(SIGKILL);
  killed->wait();
  const auto restarted = start("restarted", &trio);
  const auto half_way = start("half_way", &trio);
  trio.publish(6);
  trio.restart_segmenter();
  trio.publish(6);
  const auto late = start("late", &trio);
  const std::vector<Program*> programs{from_start.get(), restarted.get(), half_way.get(),
                                       late.get()};
  EXPECT_TRUE(wait_until(
      [&] { return std::ranges::all_of(programs, [](Program* p) { return p->has_ended(); }); },
      &trio));
  for (Program* program : programs) EXPECT_EQ(0, program->wait());
  EXPECT_GE(trio.states_sent(), 1);

  for (const std::string name : {"final.png", "map_final.png", "segments_final.png"}) {
    const std::string expected = bytes_of_file(folder_ / ("from_start/" + name));
    EXPECT_GT(expected.size(), 1'000U);
    for (const std::string other : {"restarted/", "half_way/", "late/"}) {
      EXPECT_TRUE(expected == bytes_of_file(folder_ / (other + name))) << other << name;
    }
  }
}

TEST_F(ViewerOnBus, RefusesWhatComesWhileItDrawsAndAsksForItLater) {
  const SyntheticMap room = make_room(kLength_m, 0.02);  // 9 MB of points
  RoomOnBus trio(*bus_, room);
  fs::create_directory(folder_ / "out");
  const StuckFile first_picture(folder_ / "out/snapshot_0002.5s.partial.png");
  Program program(arguments({"--exit-on-final", "--max-queue", "1", "--every", "1"}), 0,
                  folder_ / "said.txt");
  ASSERT_TRUE(wait_until([&] { return status_.has_value(); }));
  trio.publish(1);
  ASSERT_TRUE(wait_until([&] { return first_picture.is_being_written(); }, &trio));

  trio.publish(19);
  // The viewer logs bad messages when they arrive: then it has received all messages before them.
  const Bytes nonsense(100, 0xff);
  ASSERT_TRUE(wait_until(
      [&] {
        bus_->publish(channels::kCloudSlice, nonsense);
        return bytes_of_file(folder_ / "said.txt").find("bad message") != std::string::npos;
      },
      &trio));
  EXPECT_TRUE(first_picture.go_on());

  ASSERT_TRUE(wait_until([&] { return program.has_ended(); }, &trio));
  EXPECT_EQ(0, program.wait());
  ASSERT_TRUE(wait_until([&] { return status_->finished; }));
  EXPECT_GT(status_->chunks_refused, 0);
  EXPECT_GT(status_->requests_sent, 0);
  EXPECT_EQ(20, status_->slices_received);
  EXPECT_EQ(0, status_->lag_slices);
}

TEST_F(ViewerOnBus, DrawsTheMapItHeardFirstAndNamesTheOther) {
  const SyntheticMap room = make_room(kLength_m, kResolution_m);
  SyntheticMap cellar = make_room(2.5, kResolution_m);
  for (CloudSlice& slice : cellar.slices) {
    slice.session += 7;
    slice.map_name = "cellar";
  }
  for (SegmentUpdate& update : cellar.updates) {
    update.session += 7;
    update.map_session += 7;
    update.map_name = "cellar";
  }
  RoomOnBus above(*bus_, room);
  RoomOnBus below(*bus_, cellar);
  const auto program = start("out");
  above.publish(10);
  below.publish(cellar.slices.size());
  above.publish(10);
  ASSERT_TRUE(wait_until([&] { return program->has_ended(); }, &above));
  EXPECT_EQ(0, program->wait());
  ASSERT_TRUE(wait_until([&] { return status_->finished; }));
  EXPECT_EQ("room", status_->map_name);
  EXPECT_EQ(room.slices.front().session, status_->map_session);
  EXPECT_EQ(20, status_->slices_received);
  EXPECT_NE(std::string::npos, status_->problem.find("\"cellar\" is not")) << status_->problem;
}

}  // namespace
}  // namespace kintsugi::viewer
