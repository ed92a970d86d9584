// A segmented map with its views, from a saved map and from a log.

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/io/saved_map.hpp"
#include "segmenter/io/views_file.hpp"
#include "segmenter/map/segment_map.hpp"
#include "segmenter/objects/maps/observed_map_file.hpp"
#include "segmenter/views/view_record.hpp"
#include "tests/segmenter/evaluation/session/log_of_slices.hpp"
#include "tests/segmenter/evaluation/session/log_of_views.hpp"
#include "tests/segmenter/process/slice_session.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// Two patches, a view, a correction that moves both by 5 m along x, a view, and the final slice.
struct Session {
  std::vector<CloudSlice> slices = testing::wavy_session(2, 400);
  std::vector<CameraView> views;

  Session() {
    for (CloudSlice& slice : slices) slice.kind = SliceKind::kPatch;
    CloudSlice correction = slices[0];
    correction.points_W.clear();
    correction.kind = SliceKind::kCorrection;
    correction.id = 2;
    correction.utime = 3000;
    correction.correction = 1;
    PatchPose X_WP;
    X_WP.t_WP[0] = 5.0F;
    correction.motions = {{0, X_WP}, {1, X_WP}};
    CloudSlice last = correction;
    last.kind = SliceKind::kFinal;
    last.motions.clear();
    last.id = 3;
    last.utime = 5000;
    slices.push_back(correction);
    slices.push_back(last);
    views = {testing::view_at(1.0, 2000), testing::view_at(6.5, 4000)};
  }
};

class ObservedMapFile : public ::testing::Test {
 protected:
  void save() {
    SegmentMapConfig config = default_map_config();
    SegmentMap map(config, 1, session_.slices[0]);
    (void)map.add(session_.slices);
    ViewRecord record(5, "map");
    for (const CameraView& view : session_.views) record.add(view);
    for (const CloudSlice& slice : session_.slices) record.add(slice);
    write_map_state(map.state(), saved_);
    write_views(record.views(), views_file_of(saved_));
  }
  void write_log() {
    testing::LogMessages messages;
    testing::append_slices(session_.slices, messages);
    testing::append_views(session_.views, messages);
    testing::write_log(log_, messages);
  }
  void expect_the_map(const ObservedMap& map) {
    EXPECT_EQ(map.map_name, "map");
    EXPECT_EQ(map.map_session, 5);
    EXPECT_EQ(map.resolution_m, 0.01F);
    EXPECT_EQ(map.points_W.size(), 800U);
    EXPECT_EQ(map.segment_ids.size(), 800U);
    for (const CloudPoint& point : map.points_W) EXPECT_GT(point.x, 4.0F);  // after the correction
    ASSERT_EQ(map.views.size(), 2U);
    EXPECT_DOUBLE_EQ(map.views[0].X_WC.translation().x(), 6.0);
    EXPECT_DOUBLE_EQ(map.views[1].X_WC.translation().x(), 6.5);
    EXPECT_EQ(map.views[0].depth_mm, session_.views[0].depth_mm);
    EXPECT_EQ(map.config.engine.color_weight, 0.003);
  }

  Session session_;
  kintsugi::testing::TemporaryFolder folder_;
  std::filesystem::path saved_ = folder_ / "map.kseg";
  std::filesystem::path log_ = folder_ / "run.lcm";
};

TEST_F(ObservedMapFile, IsReadFromASavedMapAndItsViews) {
  save();
  const ObservedMap map = read_observed_map(saved_);
  expect_the_map(map);
  EXPECT_EQ(map.source, saved_.string());
}

TEST_F(ObservedMapFile, IsReadFromALog) {
  write_log();
  const ObservedMap map = read_observed_map(log_);
  expect_the_map(map);
  EXPECT_EQ(std::ranges::count(map.segment_ids, 0U), 0);
}

TEST_F(ObservedMapFile, BothHaveTheSameSegments) {
  save();
  write_log();
  const ObservedMap from_file = read_observed_map(saved_);
  const ObservedMap from_log = read_observed_map(log_);
  const testing::Labels a{{0, from_file.segment_ids}};
  const testing::Labels b{{0, from_log.segment_ids}};
  EXPECT_EQ(from_file.points_W, from_log.points_W);
  EXPECT_TRUE(testing::same_partition(a, b));
}

TEST_F(ObservedMapFile, WithoutViewsItHasNone) {
  save();
  std::filesystem::remove(views_file_of(saved_));
  EXPECT_TRUE(read_observed_map(saved_).views.empty());
  session_.views.clear();
  write_log();
  EXPECT_TRUE(read_observed_map(log_).views.empty());
}

TEST_F(ObservedMapFile, OfSeveralPartsItIsTheLargest) {
  session_.slices = testing::session_in_two_parts();
  for (CloudPoint& point : session_.slices[0].points_W) {  // none is accepted
    point.x = std::numeric_limits<float>::quiet_NaN();
  }
  session_.views = {testing::view_at(1.0, 2000), testing::view_at(1001.0, 3000)};
  session_.views[1].part = 1;
  save();
  write_log();
  for (const auto& path : {saved_, log_}) {
    const ObservedMap map = read_observed_map(path);
    EXPECT_EQ(map.points_W.size(), 98U) << path;
    for (const CloudPoint& point : map.points_W) EXPECT_GT(point.x, 900.0F) << path;
    ASSERT_EQ(map.views.size(), 1U) << path;
    EXPECT_EQ(map.views[0].utime, 3000) << path;
  }
}

TEST_F(ObservedMapFile, IsRefusedByName) {
  save();
  const auto refusal = [](const std::filesystem::path& path, const std::string& reason) {
    EXPECT_THAT(
        [&] { read_observed_map(path); },
        ThrowsMessage<std::runtime_error>(AllOf(HasSubstr(path.string()), HasSubstr(reason))));
  };
  refusal(folder_ / "absent", "");
  std::ofstream(folder_ / "text") << "this is neither a map nor a log of anything";
  refusal(folder_ / "text", "");
  std::filesystem::resize_file(views_file_of(saved_), 300);
  refusal(saved_, "cut off");
  ViewSet foreign;
  foreign.map_session = 6;
  foreign.map_name = "map";
  write_views(foreign, views_file_of(saved_));
  refusal(saved_, "of session 6");
  std::filesystem::resize_file(saved_, 300);
  refusal(saved_, "cut off");
}

}  // namespace
}  // namespace kintsugi::segmenter
