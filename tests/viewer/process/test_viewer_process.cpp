#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"
#include "tests/viewer/support/patched_room.hpp"
#include "tests/viewer/support/synthetic_room.hpp"
#include "viewer/process/viewer_process.hpp"

namespace kintsugi::viewer {
namespace {

namespace fs = std::filesystem;
using kintsugi::testing::TemporaryFolder;

class ViewerTest : public ::testing::Test {
 protected:
  ViewerProcess make_viewer() {
    config_.painter.renderer.width_px = 160;
    config_.painter.renderer.height_px = 120;
    config_.folder = folder_.path();
    config_.every_s = 1.5;  // from the first slice to the fourth
    return {config_,
            {.on_picture = [this](const cv::Mat3b&,
                                  const std::string& caption) { captions_.push_back(caption); },
             .on_forgotten = [this](std::int64_t session) { forgotten_.insert(session); }}};
  }
  bool exists(const std::string& name) const { return fs::exists(folder_ / name); }

  std::string read(const std::string& name) const {
    std::ifstream file(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  /// The first `count` slices of the room, with their updates, as another session.
  void add_session(ViewerProcess& viewer, std::int64_t session, std::size_t count,
                   double now_s) const {
    for (std::size_t i = 0; i < count; ++i) {
      CloudSlice slice = room_.slices[i];
      SegmentUpdate update = room_.updates[i];
      slice.session = update.map_session = session;
      viewer.add(slice, now_s);
      viewer.add(update, now_s);
    }
  }

  static constexpr double kNow_s = 100.0;
  static constexpr double kLater_s = kNow_s + 6.0;  // longer than the silence that ends a session

  const TemporaryFolder folder_;
  ViewerProcess::Config config_;
  const SyntheticMap room_ = make_room(2.5, 0.1);  // 10 slices
  std::vector<std::string> captions_;
  std::set<std::int64_t> forgotten_;
};

/// Of an object of half a metre.
ObjectDetection detection_of(std::int64_t map_session, const Eigen::Vector3f& middle_W) {
  ObjectDetection detection;
  detection.session = 5;
  detection.map_session = map_session;
  detection.detection = 1;
  detection.event_number = 1;
  detection.name = "mug";
  detection.X_WO.translation() = middle_W.cast<double>();
  std::ranges::fill(detection.box_min_O, -0.25F);
  std::ranges::fill(detection.box_max_O, 0.25F);
  return detection;
}

TEST_F(ViewerTest, WritesNothingWithoutAMap) {
  ViewerProcess viewer = make_viewer();
  viewer.add(room_.poses.front(), kNow_s);
  viewer.draw_if_due();
  viewer.draw_snapshot_now();
  viewer.write_finals(kLater_s, false);
  viewer.close();
  EXPECT_TRUE(fs::is_empty(folder_.path()));
  EXPECT_FALSE(viewer.finished());
}

TEST_F(ViewerTest, WaitsForTheSegmentsOfTheSlicesItShows) {
  ViewerProcess viewer = make_viewer();
  viewer.add(room_.updates[0], kNow_s);  // there is a segmenter: slices count when labelled
  for (const CloudSlice& slice : room_.slices) viewer.add(slice, kNow_s);
  viewer.draw_if_due();
  EXPECT_TRUE(captions_.empty());
  for (std::size_t i = 1; i < 4; ++i) viewer.add(room_.updates[i], kNow_s);
  viewer.draw_if_due();
  EXPECT_TRUE(exists("snapshot_0001.5s.png"));
  EXPECT_EQ(1U, captions_.size());
}

TEST_F(ViewerTest, DrawsOneSnapshotOfAMapThatWasThereBefore) {
  ViewerProcess viewer = make_viewer();
  for (const CloudSlice& slice : room_.slices) viewer.add(slice, kNow_s);
  viewer.draw_if_due();
  EXPECT_EQ(1U, captions_.size());
  for (const SegmentUpdate& update : room_.updates) viewer.add(update, kNow_s);
  viewer.draw_if_due();  // again, with its segments
  EXPECT_EQ(2U, captions_.size());
  for (SegmentUpdate update : room_.updates) {  // the full state, for a late joiner
    update.sequence += 100;
    update.num_segments = room_.updates.back().num_segments;
    viewer.add(update, kNow_s);
    viewer.draw_if_due();
  }
  EXPECT_EQ(2U, captions_.size());
  EXPECT_EQ(10, viewer.status().updates_applied);
}

TEST_F(ViewerTest, DrawsTheSameFinalPicturesFromWhateverCameInWhateverOrder) {
  ViewerProcess there = make_viewer();
  for (const CameraPose& pose : room_.poses) there.add(pose, kNow_s);
  for (std::size_t i = 0; i < room_.slices.size(); ++i) {
    there.add(room_.slices[i], kNow_s);
    there.add(room_.updates[i], kNow_s);
    there.draw_if_due();
  }
  there.close();
  const std::vector<std::string> names{"final.png", "map_final.png", "segments_final.png"};
  std::vector<std::string> expected;
  expected.reserve(names.size());
  for (const std::string& name : names) expected.push_back(read(name));

  std::mt19937 random(1);
  for (int trial = 0; trial < 5; ++trial) {
    for (const std::string& name : names) fs::remove(folder_ / name);
    std::vector<Message> messages(room_.slices.begin(), room_.slices.end());
    for (SegmentUpdate update : room_.updates) {  // of the full state
      update.sequence += 50;
      update.utime = 0;
      update.num_segments = room_.updates.back().num_segments;
      messages.emplace_back(std::move(update));
    }
    if (trial % 2 == 1) messages.emplace_back(room_.poses[room_.poses.size() / 2]);
    std::ranges::shuffle(messages, random);
    ViewerProcess late = make_viewer();
    for (const Message& message : messages) late.add(message, kNow_s);
    late.close();
    for (std::size_t i = 0; i < names.size(); ++i) {
      EXPECT_TRUE(expected[i] == read(names[i])) << names[i] << ", trial " << trial;
    }
  }
}

TEST_F(ViewerTest, DrawsTheSameFinalPicturesOfPatchesFromTheirNewestRevisionsAlone) {
  const SyntheticMap room = make_patched_room(2.5, 0.1);
  std::map<std::int32_t, std::int32_t> newest;
  for (const CloudSlice& slice : room.slices) newest[slice.id] = slice.revision;
  const auto is_newest = [&](const CloudSlice& slice) {
    return slice.revision == newest.at(slice.id);
  };
  const std::vector<std::string> names{"final.png", "map_final.png", "segments_final.png"};
  std::vector<std::string> expected;
  std::mt19937 random(1);
  for (int trial = 0; trial < 5; ++trial) {
    std::vector<Message> messages;
    for (std::size_t i = 0; i < room.slices.size(); ++i) {
      if (trial > 0 && !is_newest(room.slices[i]) && random() % 2 == 0) continue;
      messages.emplace_back(room.slices[i]);
      messages.emplace_back(room.updates[i]);
    }
    for (const CameraView& view : room.views) {
      if (random() % 2 == 0) messages.emplace_back(view);
    }
    if (trial > 0) std::ranges::shuffle(messages, random);
    ViewerProcess viewer = make_viewer();
    for (const Message& message : messages) viewer.add(message, kNow_s);
    EXPECT_EQ(0, viewer.status().lag_slices);
    viewer.write_finals(kNow_s, true);  // complete: nothing is waited for
    EXPECT_TRUE(viewer.finished());
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (trial == 0) expected.push_back(read(names[i]));
      EXPECT_FALSE(expected[i].empty());
      EXPECT_TRUE(expected[i] == read(names[i])) << names[i] << ", trial " << trial;
      fs::remove(folder_ / names[i]);
    }
  }
}

/// Slices and updates of the patched room, twice: in part 0, and a minute later in part 1, which
/// lies a kilometre away along x of W. The final slice comes last.
SyntheticMap room_in_two_parts() {
  constexpr std::int64_t kMinute_us = 60'000'000;
  const SyntheticMap room = make_patched_room(2.5, 0.1);
  const std::int32_t num_patches = room.slices.back().id;
  SyntheticMap map;
  for (const std::int32_t part : {0, 1}) {
    for (std::size_t i = 0; i < room.slices.size(); ++i) {
      CloudSlice slice = room.slices[i];
      SegmentUpdate update = room.updates[i];
      const bool is_final = slice.kind == SliceKind::kFinal;
      if (is_final && part == 0) continue;
      slice.part = part;
      slice.id += part * num_patches;
      slice.utime += part * kMinute_us;
      slice.revision_sum *= 2;
      slice.X_WC.translation().x() += 1000.0 * part;
      if (!is_final) slice.X_WP.t_WP[0] = 1000.0F * static_cast<float>(part);
      update.slice_id = slice.id;
      update.utime = slice.utime;
      update.sequence += part * std::ssize(room.updates);
      update.num_slices += part * num_patches;
      map.slices.push_back(std::move(slice));
      map.updates.push_back(std::move(update));
    }
  }
  return map;
}

/// The correction by which a loop brings part 1 of room_in_two_parts() beside part 0.
CloudSlice correction_that_joins(const SyntheticMap& map) {
  CloudSlice correction = map.slices.back();
  correction.id += 1;
  correction.kind = SliceKind::kCorrection;
  correction.correction = 1;
  correction.part = 0;
  PatchPose X_WP;
  X_WP.t_WP[0] = 6.0F;
  std::set<std::int32_t> patches;
  for (const CloudSlice& slice : map.slices) {
    if (slice.part == 1 && slice.kind == SliceKind::kPatch) patches.insert(slice.id);
  }
  for (const std::int32_t patch : patches) correction.motions.push_back({patch, X_WP});
  return correction;
}

TEST_F(ViewerTest, DrawsFinalPicturesOfEachPartOfTheMapInWhateverOrderItCame) {
  const SyntheticMap map = room_in_two_parts();
  std::vector<Message> messages(map.slices.begin(), map.slices.end());
  messages.insert(messages.end(), map.updates.begin(), map.updates.end());
  const std::vector<std::string> names{"final.png",           "map_final.png",
                                       "segments_final.png",  "final.part0.png",
                                       "map_final.part0.png", "segments_final.part0.png"};
  std::vector<std::string> expected;
  std::mt19937 random(1);
  for (int trial = 0; trial < 4; ++trial) {
    if (trial == 2) {  // the camera's last poses change nothing
      CameraPose pose = room_.poses.back();
      pose.utime = map.slices.back().utime + 1'000'000;
      messages.emplace_back(pose);
    }
    if (trial > 0) std::ranges::shuffle(messages, random);
    ViewerProcess viewer = make_viewer();
    for (const Message& message : messages) viewer.add(message, kNow_s);
    viewer.write_finals(kNow_s, true);
    EXPECT_TRUE(viewer.finished());
    EXPECT_EQ(0U, captions_.back().find("part 1: ")) << captions_.back();
    EXPECT_FALSE(exists("final.part1.png"));
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (trial == 0) expected.push_back(read(names[i]));
      EXPECT_FALSE(expected[i].empty()) << names[i];
      EXPECT_TRUE(expected[i] == read(names[i])) << names[i] << ", trial " << trial;
      fs::remove(folder_ / names[i]);
    }
  }
  // Of another part nothing is in the picture.
  ViewerProcess alone = make_viewer();
  for (std::size_t i = 0; i < map.slices.size(); ++i) {
    if (map.slices[i].part != 0) continue;
    alone.add(map.slices[i], kNow_s);
    alone.add(map.updates[i], kNow_s);
  }
  alone.close();
  EXPECT_TRUE(expected[4] == read("map_final.png"));
  EXPECT_TRUE(expected[5] == read("segments_final.png"));
  EXPECT_FALSE(exists("map_final.part0.png"));
}

TEST_F(ViewerTest, ShowsThePartInWhichTheCameraIs) {
  const SyntheticMap map = room_in_two_parts();
  ViewerProcess viewer = make_viewer();
  for (const CloudSlice& slice : map.slices) viewer.add(slice, kNow_s);
  viewer.draw_snapshot_now();
  EXPECT_NE(std::string::npos, captions_.back().find(" s   part 1: ")) << captions_.back();
  CameraPose pose = room_.poses.back();
  pose.utime = map.slices.back().utime + 1;
  viewer.add(pose, kNow_s);
  viewer.draw_snapshot_now();
  EXPECT_NE(std::string::npos, captions_.back().find(" s   part 0: ")) << captions_.back();
}

TEST_F(ViewerTest, LeavesNoFinalPicturesOfAPartThatHasBeenJoined) {
  const SyntheticMap map = room_in_two_parts();
  ViewerProcess viewer = make_viewer();
  for (const CloudSlice& slice : map.slices) viewer.add(slice, kNow_s);
  for (const SegmentUpdate& update : map.updates) viewer.add(update, kNow_s);
  viewer.write_finals(kNow_s, false);
  EXPECT_TRUE(exists("segments_final.part0.png"));
  const std::string before = read("final.png");
  viewer.add(correction_that_joins(map), kNow_s);
  viewer.write_finals(kLater_s, false);
  EXPECT_FALSE(exists("final.part0.png"));
  EXPECT_FALSE(exists("map_final.part0.png"));
  EXPECT_FALSE(exists("segments_final.part0.png"));
  EXPECT_TRUE(before != read("final.png"));
  EXPECT_EQ(std::string::npos, captions_.back().find("part")) << captions_.back();
}

TEST_F(ViewerTest, NamesThePartsOfASessionThatAnotherFollows) {
  const SyntheticMap map = room_in_two_parts();
  ViewerProcess viewer = make_viewer();
  for (const CloudSlice& slice : map.slices) viewer.add(slice, kNow_s);
  add_session(viewer, 1'001, 1, kNow_s);
  viewer.write_finals(kLater_s, false);
  EXPECT_TRUE(exists("final_1000.png"));
  EXPECT_TRUE(exists("final_1000.part0.png"));
  EXPECT_FALSE(exists("final.part0.png"));
}

TEST_F(ViewerTest, WaitsForTheRevisionsThatTheFinalSliceTellsOf) {
  const SyntheticMap room = make_patched_room(2.5, 0.1);
  ViewerProcess viewer = make_viewer();
  const CloudSlice* missing = nullptr;
  for (std::size_t i = 0; i < room.slices.size(); ++i) {
    if (room.slices[i].revision > 0) missing = &room.slices[i];  // the last revision of all
  }
  ASSERT_NE(nullptr, missing);
  for (std::size_t i = 0; i < room.slices.size(); ++i) {
    if (&room.slices[i] == missing) continue;
    viewer.add(room.slices[i], kNow_s);
    viewer.add(room.updates[i], kNow_s);
  }
  viewer.write_finals(kNow_s, true);
  EXPECT_FALSE(viewer.finished());
  viewer.add(*missing, kNow_s);
  viewer.write_finals(kNow_s, true);
  EXPECT_FALSE(viewer.finished());  // it lacks its segments
  viewer.add(room.updates[static_cast<std::size_t>(missing - room.slices.data())], kNow_s);
  viewer.write_finals(kNow_s, true);
  EXPECT_TRUE(viewer.finished());
}

TEST_F(ViewerTest, WritesTheSameTimelineFromUpdatesInWhateverOrder) {
  std::vector<SegmentUpdate> updates = room_.updates;
  for (std::size_t i = 0; i < updates.size(); ++i) {
    updates[i].events = {{i == 0 ? SegmentEventType::kCreated : SegmentEventType::kGrown, 1}};
    updates[i].statistics = {{.segment_id = 1, .num_points = static_cast<std::uint32_t>(9 * i)}};
  }
  config_.painter.timelines = {1, 77};
  std::mt19937 random(2);
  std::string expected;
  for (int trial = 0; trial < 4; ++trial) {
    ViewerProcess viewer = make_viewer();
    for (const CloudSlice& slice : room_.slices) viewer.add(slice, kNow_s);
    for (const SegmentUpdate& update : updates) viewer.add(update, kNow_s);
    viewer.close();
    ASSERT_TRUE(exists("timeline_1.png"));
    EXPECT_TRUE(exists("timeline_77.png"));  // says that there is no update about it
    if (trial == 0) expected = read("timeline_1.png");
    EXPECT_TRUE(expected == read("timeline_1.png"));
    std::ranges::shuffle(updates, random);
  }
}

SegmentAnswer answer_of(std::int64_t map_session, std::int64_t utime,
                        std::initializer_list<std::uint32_t> ids) {
  SegmentAnswer answer;
  answer.utime = utime;
  answer.map_session = map_session;
  for (const std::uint32_t id : ids) {
    answer.segments.emplace_back().statistics.segment_id = id;
  }
  return answer;
}

TEST_F(ViewerTest, HighlightsTheSegmentsOfTheNewestAnswer) {
  ViewerProcess viewer = make_viewer();
  const std::int64_t session = room_.slices.front().session;
  add_session(viewer, session, 3, kNow_s);
  const auto picture_after = [&](const SegmentAnswer& answer) {
    fs::remove(folder_ / "highlight.png");
    viewer.add(answer, kNow_s);
    viewer.draw_if_due();
    return exists("highlight.png") ? read("highlight.png") : std::string();
  };
  const std::string of_floor = picture_after(answer_of(session, 10, {1}));
  const std::string of_ceiling = picture_after(answer_of(session, 20, {2}));
  const std::string of_both = picture_after(answer_of(session, 30, {1, 2}));
  const std::string of_none = picture_after(answer_of(session, 40, {}));
  EXPECT_EQ(4U, captions_.size());  // published too
  EXPECT_EQ(4U, (std::set{of_floor, of_ceiling, of_both, of_none}.size()));
  EXPECT_FALSE(of_floor.empty());

  EXPECT_EQ("", picture_after(answer_of(session, 35, {1})));  // older than the newest answer
  EXPECT_EQ("", picture_after(answer_of(session + 1, 50, {1})));
  SegmentAnswer none = answer_of(session, 50, {});
  none.problem = "the map is not here";
  EXPECT_EQ("", picture_after(none));
  EXPECT_TRUE(of_floor == picture_after(answer_of(session, 60, {1})));
}

// kintsugi-objects detect asks for what the camera saw, each second.
TEST_F(ViewerTest, AnAnswerAboutViewsChangesNoHighlight) {
  ViewerProcess viewer = make_viewer();
  const std::int64_t session = room_.slices.front().session;
  add_session(viewer, session, 3, kNow_s);
  viewer.add(answer_of(session, 10, {1}), kNow_s);
  viewer.draw_if_due();
  const std::size_t num_pictures = captions_.size();
  SegmentAnswer about_views = answer_of(session, 20, {});
  about_views.views = {1};
  viewer.add(about_views, kNow_s);
  viewer.draw_if_due();
  EXPECT_EQ(num_pictures, captions_.size());
  viewer.add(answer_of(session, 15, {2}), kNow_s);  // still the newest about segments
  viewer.draw_if_due();
  EXPECT_EQ(num_pictures + 1, captions_.size());
}

TEST_F(ViewerTest, LeavesAnswersOutOfTheFinalPictures) {
  std::string expected;
  for (const bool is_asked : {false, true}) {
    ViewerProcess viewer = make_viewer();
    const std::int64_t session = room_.slices.front().session;
    add_session(viewer, session, room_.slices.size(), kNow_s);
    if (is_asked) viewer.add(answer_of(session, 10, {1}), kNow_s);
    viewer.close();
    if (!is_asked) expected = read("segments_final.png");
    EXPECT_TRUE(expected == read("segments_final.png"));
  }
  config_.painter.highlight = {1};
  ViewerProcess viewer = make_viewer();
  add_session(viewer, room_.slices.front().session, room_.slices.size(), kNow_s);
  viewer.close();
  EXPECT_FALSE(expected == read("segments_final.png"));
}

TEST_F(ViewerTest, WaitsForTheSegmentsOfACorrectionBeforeItCountsAsProgress) {
  ViewerProcess viewer = make_viewer();
  for (std::size_t i = 0; i < 4; ++i) {
    viewer.add(room_.slices[i], kNow_s);
    viewer.add(room_.updates[i], kNow_s);
  }
  viewer.draw_if_due();
  EXPECT_EQ(1U, captions_.size());
  CloudSlice slice = room_.slices[0];
  SegmentUpdate update = room_.updates[0];
  slice.revision = update.slice_revision = 1;
  slice.utime = room_.slices[3].utime + 1'500'000;
  update.sequence += 100;
  viewer.add(slice, kNow_s);
  EXPECT_EQ(1, viewer.status().lag_slices);
  viewer.draw_if_due();
  EXPECT_EQ(1U, captions_.size());
  viewer.add(update, kNow_s);
  EXPECT_EQ(0, viewer.status().lag_slices);
  viewer.draw_if_due();
  EXPECT_EQ(2U, captions_.size());
}

TEST_F(ViewerTest, IsFinishedWhenTheFinalUpdateIsDrawn) {
  ViewerProcess viewer = make_viewer();
  for (std::size_t i = 0; i < room_.slices.size(); ++i) {
    viewer.write_finals(kNow_s, false);
    EXPECT_FALSE(viewer.finished());
    viewer.add(room_.slices[i], kNow_s);
    viewer.add(room_.updates[i], kNow_s);
  }
  EXPECT_FALSE(viewer.finished());
  viewer.write_finals(kNow_s, true);  // more may come, but not of this map
  EXPECT_TRUE(viewer.finished());
  EXPECT_TRUE(viewer.status().finished);
  EXPECT_EQ(10, viewer.status().slices_received);
  EXPECT_EQ(10, viewer.status().updates_applied);
  EXPECT_EQ(3, viewer.status().snapshots_written);
  viewer.write_finals(kLater_s, false);  // nothing new to show
  viewer.close();
  EXPECT_EQ(3, viewer.status().snapshots_written);
}

TEST_F(ViewerTest, DrawsTheObjectsOfAMapWhenTheDetectorHasFinished) {
  ViewerProcess viewer = make_viewer();
  const std::int64_t session = room_.slices.front().session;
  DetectorStatus status;
  status.session = 5;
  status.map_session = session;
  add_session(viewer, session, 1, kNow_s);
  viewer.add(status, kNow_s);
  add_session(viewer, session, room_.slices.size(), kNow_s);
  viewer.write_finals(kNow_s, false);
  EXPECT_FALSE(exists("final.png"));
  EXPECT_FALSE(viewer.finished());
  const Eigen::Vector3f middle_W(room_.slices.front().points_W.front().x,
                                 room_.slices.front().points_W.front().y,
                                 room_.slices.front().points_W.front().z);
  viewer.add(detection_of(session, middle_W), kNow_s);
  status.finished = true;
  viewer.add(status, kNow_s);
  viewer.write_finals(kNow_s, false);
  EXPECT_TRUE(viewer.finished());
  EXPECT_TRUE(exists("final.png"));
  ASSERT_TRUE(exists("objects_final.png"));
  EXPECT_FALSE(read("objects_final.png") == read("map_final.png"));
}

TEST_F(ViewerTest, DrawsNoPictureOfObjectsWhereNoneWereFound) {
  ViewerProcess viewer = make_viewer();
  add_session(viewer, room_.slices.front().session, room_.slices.size(), kNow_s);
  viewer.close();
  EXPECT_TRUE(exists("final.png"));
  EXPECT_FALSE(exists("objects_final.png"));
}

TEST_F(ViewerTest, WaitsForWhatMayStillBeResentAndGoesOnWithoutTheRest) {
  ViewerProcess viewer = make_viewer();
  for (std::size_t i = 0; i < room_.slices.size(); ++i) {
    if (i != 3) viewer.add(room_.slices[i], kNow_s);
    viewer.add(room_.updates[i], kNow_s);
  }
  viewer.write_finals(kNow_s, false);
  EXPECT_FALSE(viewer.finished());
  viewer.write_finals(kLater_s, true);
  EXPECT_FALSE(viewer.finished());
  viewer.write_finals(kLater_s, false);
  EXPECT_TRUE(viewer.finished());
  viewer.add(room_.slices[3], kLater_s);  // late
  viewer.write_finals(kLater_s, false);
  EXPECT_TRUE(viewer.finished());
  EXPECT_EQ(6, viewer.status().snapshots_written);
  EXPECT_EQ(0, viewer.status().lag_slices);
}

TEST_F(ViewerTest, DrawsTheNewestSessionAndKeepsTheFinalPictureOfTheOneBefore) {
  ViewerProcess viewer = make_viewer();
  add_session(viewer, 1'000, 3, kNow_s);
  add_session(viewer, 1'001, 1, kNow_s);
  EXPECT_EQ(1, viewer.status().slices_received);
  EXPECT_EQ(1'001, viewer.status().map_session);
  viewer.write_finals(kNow_s, false);
  EXPECT_FALSE(exists("final_1000.png"));  // more of it may come
  viewer.write_finals(kLater_s, false);
  EXPECT_TRUE(exists("final_1000.png"));
  EXPECT_TRUE(exists("segments_final_1000.png"));
  EXPECT_FALSE(exists("final.png"));
}

TEST_F(ViewerTest, CompletesTheOlderSessionWithWhatComesLate) {
  ViewerProcess viewer = make_viewer();
  add_session(viewer, 1'000, 3, kNow_s);
  add_session(viewer, 1'001, 1, kNow_s);
  viewer.write_finals(kLater_s, false);
  const auto partial_bytes = fs::file_size(folder_ / "final_1000.png");
  add_session(viewer, 1'000, room_.slices.size(), kLater_s);  // again, and the rest
  EXPECT_EQ(1'001, viewer.status().map_session);
  EXPECT_TRUE(forgotten_.empty());
  viewer.write_finals(kLater_s, false);
  EXPECT_NE(partial_bytes, fs::file_size(folder_ / "final_1000.png"));
  EXPECT_EQ(std::set<std::int64_t>{1'000}, forgotten_);  // it is complete
  viewer.add(room_.slices[0], kLater_s);
  EXPECT_EQ(1, viewer.status().slices_received);
}

TEST_F(ViewerTest, WritesTheFinalPicturesOfAFinishedSessionUnderItsNumberWhenAnotherFollows) {
  ViewerProcess viewer = make_viewer();
  add_session(viewer, 1'000, room_.slices.size(), kNow_s);
  viewer.write_finals(kNow_s, false);
  EXPECT_TRUE(viewer.finished());
  add_session(viewer, 1'001, 1, kNow_s);
  viewer.write_finals(kNow_s, false);
  EXPECT_FALSE(viewer.finished());
  EXPECT_TRUE(exists("final_1000.png"));
  viewer.close();
  EXPECT_TRUE(exists("final.png"));
}

TEST_F(ViewerTest, KeepsTwoSessionsInWhateverOrderTheyAreHeard) {
  ViewerProcess viewer = make_viewer();
  add_session(viewer, 1'001, 2, kNow_s);
  add_session(viewer, 1'000, 3, kNow_s);  // beside it
  EXPECT_EQ(1'001, viewer.status().map_session);
  add_session(viewer, 999, 3, kNow_s);  // too old
  add_session(viewer, 1'002, 4, kNow_s);
  EXPECT_TRUE(exists("final_1000.png"));
  EXPECT_EQ(1'002, viewer.status().map_session);
  EXPECT_EQ(4, viewer.status().slices_received);
  EXPECT_EQ((std::set<std::int64_t>{999, 1'000}), forgotten_);
}

TEST_F(ViewerTest, ShowsTheSessionThatHasSlices) {
  ViewerProcess viewer = make_viewer();
  add_session(viewer, 1'000, 3, kNow_s);
  SegmentUpdate ahead = room_.updates[0];
  ahead.map_session = 5'000;
  viewer.add(ahead, kNow_s);
  EXPECT_EQ(1'000, viewer.status().map_session);
  viewer.write_finals(kLater_s, false);
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(ViewerTest, BeginsNothingWithPosesButKeepsThemForTheirMap) {
  ViewerProcess viewer = make_viewer();
  CameraPose other = room_.poses[0];
  other.session += 7;
  viewer.add(other, kNow_s);
  for (const CameraPose& pose : room_.poses) viewer.add(pose, kNow_s);
  EXPECT_EQ(0, viewer.status().map_session);
  viewer.add(room_.slices[0], kNow_s);
  viewer.draw_snapshot_now();
  // From the first pose to the last, though they came before the slice.
  const double seconds =
      1e-6 * static_cast<double>(room_.poses.back().utime - room_.poses.front().utime);
  ASSERT_EQ(1U, captions_.size());
  EXPECT_EQ(0U, captions_[0].find(fmt::format("{:.1f} s", seconds))) << captions_[0];
}

TEST_F(ViewerTest, GoesOnWhenItsFolderIsGone) {
  ViewerProcess viewer = make_viewer();
  add_session(viewer, 1'000, room_.slices.size(), kNow_s);
  fs::remove_all(folder_.path());
  viewer.draw_snapshot_now();
  EXPECT_EQ(1, viewer.failures());
  EXPECT_EQ(0, viewer.status().snapshots_written);
  EXPECT_EQ(1U, captions_.size());  // still published
  EXPECT_NE(std::string::npos, viewer.status().problem.find("snapshot_0001.5s"))
      << viewer.status().problem;

  viewer.write_finals(kNow_s, false);
  EXPECT_FALSE(viewer.finished());
  EXPECT_NE("", viewer.status().problem);
  fs::create_directory(folder_.path());
  viewer.write_finals(kNow_s + 3.0, false);
  EXPECT_TRUE(viewer.finished());
  EXPECT_EQ("", viewer.status().problem);
  EXPECT_TRUE(exists("final.png"));
  viewer.close();
  EXPECT_EQ(1, viewer.failures());  // the snapshot is lost
}

TEST_F(ViewerTest, IsFinishedWithoutItsFinalPicturesAfterTryingLong) {
  ViewerProcess viewer = make_viewer();
  add_session(viewer, 1'000, room_.slices.size(), kNow_s);
  fs::remove_all(folder_.path());
  for (double now_s = kNow_s; now_s < kNow_s + 29.0; now_s += 1.0) {
    viewer.write_finals(now_s, false);
    EXPECT_FALSE(viewer.finished()) << now_s;
  }
  viewer.write_finals(kNow_s + 31.0, false);
  EXPECT_TRUE(viewer.finished());
  viewer.close();
  EXPECT_EQ(1, viewer.failures());
}

TEST_F(ViewerTest, RefusesAConfigurationOutOfItsBounds) {
  for (const auto spoil : std::initializer_list<void (*)(ViewerProcess::Config&)>{
           [](ViewerProcess::Config& c) { c.every_s = 0.0; },
           [](ViewerProcess::Config& c) { c.video_rate_hz = 0.0; },
           [](ViewerProcess::Config& c) { c.video_rate_hz = 500.0; },
           [](ViewerProcess::Config& c) { c.painter.max_drawing_share = 1.5; },
           [](ViewerProcess::Config& c) { c.painter.renderer.width_px = 0; }}) {
    ViewerProcess::Config config;
    spoil(config);
    EXPECT_THROW(config.validate(), std::invalid_argument);
  }
}

}  // namespace
}  // namespace kintsugi::viewer
