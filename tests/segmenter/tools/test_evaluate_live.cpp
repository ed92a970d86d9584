// kintsugi-evaluate --live, run as a program.

#include <fstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/codec/codec.hpp"
#include "lcmtypes/log/log_writer.hpp"
#include "tests/segmenter/evaluation/live/watched_wall.hpp"
#include "tests/segmenter/tools/evaluate_program.hpp"

namespace kintsugi::segmenter {
namespace {

using testing::BusEvent;
using ::testing::HasSubstr;

/// Writes events as lcm-logger does, in chunks of one datagram.
class BusLog {
 public:
  explicit BusLog(const std::filesystem::path& path) : log_(LogWriter::create(path)) {}

  void append(const BusEvent& event) {
    const auto utime = static_cast<std::int64_t>(1e6 * (1'000.0 + event.time_s));
    const auto write = [&](const char* channel, std::int64_t& sequence, const auto& message) {
      const std::int32_t count = num_chunks(message, kDefaultMaxChunkBytes);
      for (std::int32_t i = 0; i < count; ++i) {
        log_.append(utime, channel, encode_chunk(message, sequence + i, i, kDefaultMaxChunkBytes));
      }
      sequence += count;
    };
    if (const auto* slice = std::get_if<CloudSlice>(&event.message)) {
      write(channels::kCloudSlice, num_slice_chunks_, *slice);
    } else if (const auto* update = std::get_if<SegmentUpdate>(&event.message)) {
      write(channels::kSegmentUpdate, num_update_chunks_, *update);
    } else {
      write(channels::kCameraView, num_view_chunks_, std::get<CameraView>(event.message));
    }
  }

 private:
  LogWriter log_;
  std::int64_t num_slice_chunks_ = 0;
  std::int64_t num_update_chunks_ = 0;
  std::int64_t num_view_chunks_ = 0;
};

class EvaluateLive : public testing::EvaluateProgram {
 protected:
  void write_log(std::vector<BusEvent> events) {
    testing::in_order_of_time(events);
    BusLog log(path("run.lcm"));
    for (const BusEvent& event : events) log.append(event);
  }
};

TEST_F(EvaluateLive, MeasuresWhatWasOnTheBusByTheClockOfTheLog) {
  std::vector<BusEvent> events = testing::watch_wall();
  const CloudSlice wall = testing::wall_slice(0, 0, -1.5, 1.5, testing::kWall_m);
  events.push_back({1.05, wall});
  events.push_back({6.05, testing::labels_of(wall, 1)});
  write_log(events);
  const auto result = run("--live " + path("run.lcm") + " --json " + path("live.json"));
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("| centre pixel has its right segment | 49.4 % |"));
  EXPECT_THAT(result.output, HasSubstr("| queries by pixel: wrong answers | 0.0 % |"));
  const auto json = nlohmann::json::parse(std::ifstream(path("live.json")));
  EXPECT_EQ(json["session"], testing::kWallSession);
  EXPECT_NEAR(json["centre_right"].get<double>(), 40.0 / 81.0, 1e-9);
  EXPECT_NEAR(json["delay_median_s"].get<double>(), 6.05 - 0.3, 1e-5);
  EXPECT_NEAR(json["duration_s"].get<double>(), 10.0, 1e-6);
  EXPECT_EQ(json["times_sent"], 1.0);
}

TEST_F(EvaluateLive, SaysWhatTheLogLacks) {
  std::vector<BusEvent> events = testing::watch_wall();
  write_log(events);
  EXPECT_THAT(run("--live " + path("run.lcm")).output, HasSubstr("no slice of the map"));
  std::filesystem::remove(path("run.lcm"));
  events.push_back({1.05, testing::wall_slice(0, 0, -1.5, 1.5, testing::kWall_m)});
  write_log(events);
  EXPECT_THAT(run("--live " + path("run.lcm")).output, HasSubstr("no labels of its slices"));
  std::filesystem::remove(path("run.lcm"));
  write_log({events.back()});
  const auto result = run("--live " + path("run.lcm"));
  EXPECT_THAT(result.output, HasSubstr("no view of the camera"));
  EXPECT_EQ(result.exit_code, 1);
}

TEST_F(EvaluateLive, IsOneTaskAmongSeveral) {
  EXPECT_THAT(run("--live a.lcm b.lcm --out out").output, HasSubstr("--live excludes IN"));
  EXPECT_THAT(run("--json a.json b.lcm --out out").output, HasSubstr("--json requires"));
  EXPECT_THAT(run("--live a.lcm --out out").output, HasSubstr("--out excludes"));
}

}  // namespace
}  // namespace kintsugi::segmenter
