#include <string>

#include <gtest/gtest.h>

#include "viewer/session/map_session.hpp"

namespace kintsugi::viewer {
namespace {

constexpr std::int64_t kSession = 1'000;
constexpr double kPartDistance_m = 1000.0;

Pose pose_in_part(std::int32_t part) {
  Pose X_WC = Pose::Identity();
  X_WC.translation().x() = kPartDistance_m * part;
  return X_WC;
}

CameraPose camera_pose(std::int32_t part, std::int64_t utime) {
  CameraPose pose;
  pose.utime = utime;
  pose.session = kSession;
  pose.state = TrackingState::kTracking;
  pose.X_WC = pose_in_part(part);
  pose.part = part;
  return pose;
}

CameraView camera_view(std::int32_t part, std::int64_t utime) {
  CameraView view;
  view.utime = utime;
  view.session = kSession;
  view.part = part;
  view.state = TrackingState::kTracking;
  view.X_WC = pose_in_part(part);
  return view;
}

CloudSlice patch(std::int32_t id, std::int32_t part, std::int64_t utime) {
  CloudSlice slice;
  slice.session = kSession;
  slice.id = id;
  slice.kind = SliceKind::kPatch;
  slice.part = part;
  slice.utime = utime;
  slice.resolution_m = 0.01F;
  slice.X_WC = pose_in_part(part);
  slice.points_W.resize(1);
  return slice;
}

ObjectDetection detection_of(const std::string& name) {
  ObjectDetection detection;
  detection.session = 5;
  detection.map_session = kSession;
  detection.detection = 1;
  detection.event_number = 1;
  detection.name = name;
  return detection;
}

DetectorStatus status_of_detector(bool is_finished) {
  DetectorStatus status;
  status.session = 5;
  status.map_session = kSession;
  status.finished = is_finished;
  return status;
}

void expect_paths_apart(const MapSession& session) {
  for (const std::int32_t part : {0, 1}) {
    const CameraTrack track = session.map().received_track(part);
    for (const Eigen::Vector3f& p_W : track.path_W) {
      EXPECT_EQ(p_W.x(), static_cast<float>(kPartDistance_m) * static_cast<float>(part));
    }
  }
}

TEST(MapSession, FollowsTheCameraInEachPartOfTheMap) {
  MapSession session(kSession, 0.0);
  session.use(patch(0, 0, 1'000), 0.0);
  session.use(camera_pose(0, 2'000));
  EXPECT_FALSE(session.depth_camera(1).has_pose());
  session.use(camera_pose(1, 3'000));
  EXPECT_EQ(session.depth_camera(0).position_W().x(), 0.0) << "it did not go there";
  EXPECT_EQ(session.depth_camera(1).position_W().x(), kPartDistance_m);
  session.use(patch(1, 2, 4'000), 0.0);
  EXPECT_EQ(session.depth_camera(2).position_W().x(), 2 * kPartDistance_m) << "as the slice says";
}

TEST(MapSession, AViewStandsForAPoseOfItsPart) {
  MapSession session(kSession, 0.0);
  session.use(patch(0, 0, 1'000), 0.0);
  session.use(camera_view(0, 2'000));
  EXPECT_EQ(session.map().received_track(0).path_W.size(), 2U) << "in place of a pose";
  session.use(camera_pose(1, 3'000));
  session.use(camera_view(1, 3'000));  // there is nothing in part 1 yet
  EXPECT_EQ(session.map().received_track(1).path_W.size(), 1U) << "it is the same pose";
  session.use(camera_view(1, 4'000));
  EXPECT_EQ(session.view()->utime, 4'000);
  session.use(camera_pose(0, 6'000));
  session.use(camera_view(1, 5'000));  // late
  expect_paths_apart(session);
}

TEST(MapSession, HasTheObjectsThatAreNotGone) {
  MapSession session(kSession, 0.0);
  ObjectDetection detection = detection_of("mug");
  detection.box_max_O[1] = 0.25F;
  session.use(detection, 0.0);
  ASSERT_EQ(session.objects().size(), 1U);
  EXPECT_EQ(session.objects()[0].name, "mug");
  EXPECT_EQ(session.objects()[0].box_max_O.y(), 0.25F);
  EXPECT_FALSE(session.objects()[0].is_confirmed);
  detection.event_number = 2;
  detection.event = DetectionEvent::kConfirmed;
  session.use(detection, 1.0);
  EXPECT_TRUE(session.objects()[0].is_confirmed);
  detection.event_number = 3;
  detection.event = DetectionEvent::kGone;
  session.use(detection, 2.0);
  EXPECT_TRUE(session.objects().empty());
}

TEST(MapSession, IsSearchedUntilTheDetectorHasFinishedOrIsSilent) {
  MapSession session(kSession, 0.0);
  EXPECT_FALSE(session.is_searched(0.0)) << "there is no detector";
  session.use(status_of_detector(false), 1.0);
  EXPECT_TRUE(session.is_searched(5.9));
  EXPECT_FALSE(session.is_searched(6.0)) << "it was killed";
  session.use(status_of_detector(false), 7.0);
  EXPECT_TRUE(session.is_searched(7.0));
  DetectorStatus before = status_of_detector(true);
  before.session = 4;
  session.use(before, 7.0);
  EXPECT_TRUE(session.is_searched(7.0)) << "another detector has taken its place";
  session.use(status_of_detector(true), 8.0);
  EXPECT_FALSE(session.is_searched(8.0));
}

TEST(MapSession, HasToBeDrawnAgainWhenMoreIsKnownOfObjects) {
  MapSession session(kSession, 0.0);
  session.use(patch(0, 0, 1'000), 0.0);
  session.note_final("");
  ObjectDetection detection = detection_of("mug");
  session.use(detection, 1.0);
  EXPECT_TRUE(session.final_is_due(""));
  session.note_final("");
  session.use(detection, 2.0);  // repeated
  EXPECT_FALSE(session.final_is_due(""));
  detection.event_number = 2;
  session.use(detection, 3.0);
  EXPECT_TRUE(session.final_is_due(""));
}

}  // namespace
}  // namespace kintsugi::viewer
