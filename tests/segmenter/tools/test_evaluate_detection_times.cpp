// kintsugi-evaluate --detection-times, run as a program.

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/codec/codec.hpp"
#include "lcmtypes/log/log_writer.hpp"
#include "lcmtypes/object_messages.hpp"
#include "tests/segmenter/evaluation/live/watched_wall.hpp"
#include "tests/segmenter/tools/evaluate_program.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::HasSubstr;

/// A cup of 20 cm on a wall, which patch 0 shows; patch 1 is elsewhere.
class EvaluateDetectionTimes : public testing::EvaluateProgram {
 protected:
  EvaluateDetectionTimes() : log_(LogWriter::create(folder_ / "run.lcm")) {}

  static std::int64_t utime(double time_s) {
    return static_cast<std::int64_t>(1e6 * (1'000.0 + time_s));
  }

  void patch(double time_s, std::int32_t id, std::int32_t revision, double from_x, double to_x) {
    const CloudSlice slice = testing::wall_slice(id, revision, from_x, to_x, testing::kWall_m);
    const std::int32_t count = num_chunks(slice, kDefaultMaxChunkBytes);
    for (std::int32_t i = 0; i < count; ++i) {
      log_.append(utime(time_s), channels::kCloudSlice,
                  encode_chunk(slice, chunks_ + i, i, kDefaultMaxChunkBytes));
    }
    chunks_ += count;
  }

  void tell(double time_s, DetectionEvent event, double x, std::int32_t detection = 1) {
    ObjectDetection message;
    message.session = session_;
    message.map_session = testing::kWallSession;
    message.map_name = "map";
    message.detection = detection;
    message.num_detections = detection;
    message.event_number = ++events_;
    message.event = event;
    message.name = "cup";
    message.X_WO.translation() = Eigen::Vector3d(x, 0.0, testing::kWall_m);
    message.score = 0.9F;
    for (int axis = 0; axis < 3; ++axis) {
      message.box_min_O[axis] = -0.1F;
      message.box_max_O[axis] = 0.1F;
    }
    message.points = 400;
    log_.append(utime(time_s), channels::kObjectDetection, encode(message));
  }

  void tell_share(double time_s, double cpu_share) {
    DetectorStatus status;
    status.session = session_;
    status.cpu_share = cpu_share;
    log_.append(utime(time_s), channels::kDetectorStatus, encode(status));
  }

  nlohmann::json times() {
    const auto result = run("--detection-times " + path("run.lcm") + " --json " + path("t.json"));
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return nlohmann::json::parse(std::ifstream(path("t.json")));
  }

  std::int64_t session_ = 3;

 private:
  LogWriter log_;
  std::int32_t chunks_ = 0;
  std::int64_t events_ = 0;
};

TEST_F(EvaluateDetectionTimes, CountFromTheLastPatchThatChangedTheObject) {
  patch(1.0, 0, 0, -0.5, 0.0);  // half of it
  patch(2.0, 0, 1, -0.5, 0.1);  // nine tenths
  patch(3.0, 0, 2, -0.5, 0.3);  // all
  patch(4.0, 0, 3, -0.5, 0.5);  // more, but not of it
  patch(5.0, 1, 0, 1.0, 1.5);   // elsewhere
  tell(5.5, DetectionEvent::kFound, 0.0);
  tell(6.5, DetectionEvent::kConfirmed, 0.01);
  const nlohmann::json told = times();
  ASSERT_EQ(told["detections"].size(), 1U);
  EXPECT_EQ(told["detections"][0]["name"], "cup");
  EXPECT_NEAR(told["detections"][0]["delay_s"].get<double>(), 2.5, 1e-5);
  EXPECT_NEAR(told["detections"][0]["delay_of_whole_s"].get<double>(), 3.5, 1e-5);
  EXPECT_NEAR(told["delay_median_s"].get<double>(), 2.5, 1e-5);
}

TEST_F(EvaluateDetectionTimes, WhatWasToldBeforeItsLastPatchHasNoDelay) {
  patch(1.0, 0, 0, -0.5, 0.0);
  tell(1.5, DetectionEvent::kFound, 0.0);
  patch(3.0, 0, 1, -0.5, 0.5);
  tell(3.5, DetectionEvent::kConfirmed, 0.0);
  EXPECT_EQ(times()["delay_p99_s"], 0.0);
}

TEST_F(EvaluateDetectionTimes, WhatHasMovedIsToldWhereItIsNow) {
  patch(1.0, 0, 0, -0.5, 1.0);
  tell(2.0, DetectionEvent::kFound, 0.6);
  tell(3.0, DetectionEvent::kGone, 0.6);
  tell(4.0, DetectionEvent::kMoved, 0.0);
  tell(2.5, DetectionEvent::kGone, 0.3, 2);
  const nlohmann::json told = times();
  ASSERT_EQ(told["detections"].size(), 1U);  // the other is gone
  EXPECT_NEAR(told["delay_median_s"].get<double>(), 3.0, 1e-5);
}

TEST_F(EvaluateDetectionTimes, TheLastDetectorCounts) {
  patch(1.0, 0, 0, -0.5, 0.5);
  tell(2.0, DetectionEvent::kFound, 0.0);
  session_ = 4;
  tell(6.0, DetectionEvent::kFound, 0.0);
  session_ = 3;
  tell(7.0, DetectionEvent::kFound, 0.3, 2);
  const nlohmann::json told = times();
  ASSERT_EQ(told["detections"].size(), 1U);
  EXPECT_NEAR(told["delay_median_s"].get<double>(), 5.0, 1e-5);
}

TEST_F(EvaluateDetectionTimes, TheShareOfTheProcessorIsThatUntilTheLastSlice) {
  tell_share(0.5, 0.3);
  patch(1.0, 0, 0, -0.5, 0.5);
  tell_share(1.5, 0.08);
  patch(2.0, 1, 0, 1.0, 1.5);
  tell_share(2.5, 0.9);  // it examines all once more
  tell(3.0, DetectionEvent::kFound, 0.0);
  EXPECT_NEAR(times()["cpu_share"].get<double>(), 0.08, 1e-9);
}

TEST_F(EvaluateDetectionTimes, ALogWithoutDetectionsIsNamed) {
  patch(1.0, 0, 0, -0.5, 0.5);
  const auto result = run("--detection-times " + path("run.lcm"));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.output, HasSubstr("run.lcm: holds no detected object"));
  EXPECT_GE(run("--detection-times x --live y").exit_code, 100);
}

}  // namespace
}  // namespace kintsugi::segmenter
