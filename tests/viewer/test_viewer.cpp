#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"
#include "tests/viewer/synthetic_room.hpp"
#include "viewer/process/viewer.hpp"

namespace kintsugi::viewer {
namespace {

namespace fs = std::filesystem;
using kintsugi::testing::TemporaryFolder;

class ViewerTest : public ::testing::Test {
 protected:
  Viewer make_viewer(const std::string& map_name = "") {
    Viewer::Config config;
    config.renderer.width_px = 160;
    config.renderer.height_px = 120;
    config.folder = folder_.path();
    config.map_name = map_name;
    config.every_slices = 4;
    return {config,
            [this](const cv::Mat3b&, const std::string& caption) { captions_.push_back(caption); }};
  }
  bool exists(const std::string& name) const { return fs::exists(folder_ / name); }

  const TemporaryFolder folder_;
  const SyntheticMap room_ = make_room(2.5, 0.1);  // 10 slices
  std::vector<std::string> captions_;
};

TEST_F(ViewerTest, WritesNothingWithoutAMap) {
  Viewer viewer = make_viewer();
  viewer.add(room_.poses.front());
  viewer.draw_if_due();
  viewer.draw_snapshot_now();
  viewer.close();
  EXPECT_TRUE(fs::is_empty(folder_.path()));
  EXPECT_FALSE(viewer.finished());
}

TEST_F(ViewerTest, WaitsForTheSegmentsOfTheSlicesItShows) {
  Viewer viewer = make_viewer();
  viewer.add(room_.updates[0]);  // there is a segmenter, so slices count when they have segments
  for (const CloudSlice& slice : room_.slices) viewer.add(slice);
  viewer.draw_if_due();
  EXPECT_FALSE(exists("snapshot_000000.png"));
  for (std::size_t i = 1; i < 4; ++i) viewer.add(room_.updates[i]);
  viewer.draw_if_due();
  EXPECT_TRUE(exists("snapshot_000003.png"));
  EXPECT_EQ(1U, captions_.size());
}

TEST_F(ViewerTest, DrawsCorrectedSlicesAgain) {
  Viewer viewer = make_viewer();
  for (std::size_t i = 0; i < 4; ++i) {
    viewer.add(room_.slices[i]);
    viewer.add(room_.updates[i]);
  }
  viewer.draw_if_due();
  EXPECT_EQ(1U, captions_.size());
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(1U, captions_.size());
    CloudSlice slice = room_.slices[i];
    SegmentUpdate update = room_.updates[i];
    slice.revision = update.slice_revision = 1;
    update.sequence += 100;
    viewer.add(update);
    EXPECT_EQ(1, viewer.status().lag_slices);
    viewer.add(slice);
    EXPECT_EQ(0, viewer.status().lag_slices);
    viewer.draw_if_due();
  }
  EXPECT_EQ(2U, captions_.size());
}

TEST_F(ViewerTest, IsFinishedWhenTheFinalUpdateIsDrawn) {
  Viewer viewer = make_viewer();
  for (std::size_t i = 0; i < room_.slices.size(); ++i) {
    EXPECT_FALSE(viewer.complete());
    viewer.add(room_.slices[i]);
    viewer.add(room_.updates[i]);
  }
  EXPECT_TRUE(viewer.complete());
  EXPECT_FALSE(viewer.finished());
  viewer.write_final();
  EXPECT_TRUE(viewer.finished());
  EXPECT_TRUE(viewer.status().finished);
  EXPECT_EQ(10, viewer.status().slices_received);
  EXPECT_EQ(10, viewer.status().updates_applied);
  EXPECT_EQ(3, viewer.status().snapshots_written);
  viewer.write_final();  // nothing new to show
  EXPECT_EQ(3, viewer.status().snapshots_written);
}

TEST_F(ViewerTest, DrawsTheNewestSessionAndKeepsTheFinalPictureOfTheOneBefore) {
  Viewer viewer = make_viewer();
  viewer.add(room_.slices[0]);
  CloudSlice next = room_.slices[1];
  next.session += 1;
  viewer.add(next);
  const std::string before = std::to_string(room_.slices[0].session);
  EXPECT_TRUE(exists("final_" + before + ".png"));
  EXPECT_TRUE(exists("segments_final_" + before + ".png"));
  EXPECT_EQ(1, viewer.status().slices_received);

  viewer.add(room_.slices[2]);  // left over from the session before
  EXPECT_EQ(1, viewer.status().slices_received);
}

TEST_F(ViewerTest, DrawsOnlyTheMapThatWasNamed) {
  Viewer viewer = make_viewer("room");
  CloudSlice other = room_.slices[0];
  other.map_name = "cellar";
  other.session += 1;
  CameraPose pose = room_.poses[0];
  pose.session = other.session;
  viewer.add(room_.slices[0]);
  viewer.add(other);
  viewer.add(pose);
  viewer.add(room_.slices[1]);
  EXPECT_EQ(2, viewer.status().slices_received);
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(ViewerTest, GoesOnWhenItsFolderIsGone) {
  Viewer viewer = make_viewer();
  viewer.add(room_.slices[0]);
  fs::remove_all(folder_.path());
  viewer.draw_snapshot_now();
  EXPECT_EQ(1, viewer.failures());
  EXPECT_EQ(0, viewer.status().snapshots_written);
  EXPECT_EQ(1U, captions_.size());  // still published
  fs::create_directory(folder_.path());
  viewer.close();
  EXPECT_EQ(1, viewer.failures());
  EXPECT_TRUE(exists("final.png"));
}

TEST_F(ViewerTest, RefusesAConfigurationOutOfItsBounds) {
  for (const auto spoil : std::initializer_list<void (*)(Viewer::Config&)>{
           [](Viewer::Config& c) { c.every_slices = 0; },
           [](Viewer::Config& c) { c.video_period_s = 0.0; },
           [](Viewer::Config& c) { c.video_frames_per_s = 0.5; },
           [](Viewer::Config& c) { c.max_drawing_share = 1.5; },
           [](Viewer::Config& c) { c.renderer.width_px = 0; }}) {
    Viewer::Config config;
    spoil(config);
    EXPECT_THROW(config.validate(), std::invalid_argument);
  }
}

}  // namespace
}  // namespace kintsugi::viewer
