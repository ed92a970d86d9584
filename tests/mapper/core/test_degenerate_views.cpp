// Views in which depth does not determine all directions of motion: colour determines these and
// only these, and without texture the frame is lost.
#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "mapper/core/mapper_pipeline.hpp"
#include "tests/mapper/core/box_room.hpp"
#include "tests/mapper/core/synthetic_frames.hpp"

namespace kintsugi::mapper {
namespace {

using testing::distance_m;
using testing::synthetic_run;
using testing::SyntheticRun;

constexpr std::int64_t kFrame_us = 33333;

MapperPipeline::Config small_config() {
  MapperPipeline::Config config;
  config.volume.region = RegionShape::kCube;
  config.volume.volume_size_m = 4.0;
  config.volume.resolution_m = 0.015;
  return config;
}

struct Tracked {
  std::vector<TrackingResult> results;
  std::int64_t blocks_after_first = 0;
  std::int64_t blocks = 0;
  double end_error_m = 0.0;  ///< of the last pose
  double path_m = 0.0;       ///< from the first to the last
};

Tracked track(const SyntheticRun& run) {
  MapperPipeline pipeline(small_config());
  Tracked tracked;
  for (const RgbdFrame& frame : run.frames) {
    tracked.results.push_back(pipeline.process(frame).tracking);
    if (tracked.results.size() == 1) tracked.blocks_after_first = pipeline.num_blocks();
  }
  tracked.blocks = pipeline.num_blocks();
  const Pose X_W0 = run.true_path.front().X_WC;
  const Pose X_0C = X_W0.inverse() * run.true_path.back().X_WC;  // the map begins at frame 0
  tracked.end_error_m = distance_m(tracked.results.back().X_WC, X_0C);
  tracked.path_m = X_0C.translation().norm();
  return tracked;
}

SyntheticRun without_color(SyntheticRun run) {
  for (RgbdFrame& frame : run.frames) frame.color_rgb.release();
  return run;
}

int count(const Tracked& tracked, TrackingState state) {
  return static_cast<int>(
      std::count_if(tracked.results.begin(), tracked.results.end(),
                    [&](const TrackingResult& result) { return result.state == state; }));
}

struct View {
  std::string scene;
  int open;  ///< directions at least: more where grazing walls give few normals
};

class DegenerateView : public ::testing::TestWithParam<View> {};
INSTANTIATE_TEST_SUITE_P(Scenes, DegenerateView,
                         ::testing::Values(View{"wall", 3}, View{"floor", 3}, View{"corridor", 1}),
                         [](const auto& info) { return info.param.scene; });

constexpr int kFrames = 8;
constexpr int kStep = 2;         // every second frame of the path: 15 Hz
constexpr double kDrift = 0.03;  // of 0.1 to 0.2 m: 3 to 6 mm, a pixel

TEST_P(DegenerateView, IsFollowedByItsTexture) {
  const Tracked tracked = track(synthetic_run(GetParam().scene, kFrames, true, kStep));
  EXPECT_EQ(count(tracked, TrackingState::kTracking), kFrames);
  EXPECT_LT(tracked.end_error_m, kDrift * tracked.path_m);
  for (std::size_t i = 1; i < tracked.results.size(); ++i) {
    EXPECT_GE(tracked.results[i].open_to_depth_C.cols(), GetParam().open) << "frame " << i;
    EXPECT_EQ(tracked.results[i].undetermined_C.cols(), 0) << "frame " << i;
  }
}

void expect_no_invented_motion(const Tracked& tracked) {
  for (std::size_t i = 1; i < tracked.results.size(); ++i) {
    const TrackingResult& result = tracked.results[i];
    EXPECT_EQ(result.state, TrackingState::kLost) << "frame " << i;
    EXPECT_EQ(result.loss_reason, LossReason::kUndetermined) << "frame " << i;
    EXPECT_GT(result.undetermined_C.cols(), 0) << "frame " << i;
    EXPECT_TRUE(result.X_WC.isApprox(Pose::Identity(), 0.0)) << "frame " << i;
  }
  EXPECT_EQ(tracked.blocks, tracked.blocks_after_first) << "something was fused";
}

TEST_P(DegenerateView, WithoutTextureIsNotKnown) {
  expect_no_invented_motion(track(synthetic_run(GetParam().scene + "-plain", kFrames, true)));
}

TEST_P(DegenerateView, WithoutColourIsNotKnown) {
  expect_no_invented_motion(track(without_color(synthetic_run(GetParam().scene, kFrames, true))));
}

TEST(WallVisit, IsFollowedByTextureOntoTheBareStretch) {
  const Tracked tracked = track(synthetic_run("wall-visit", 40, true, 3));
  EXPECT_EQ(count(tracked, TrackingState::kTracking), 40);
  EXPECT_LT(tracked.end_error_m, 0.01);  // of 1.5 m, at a pixel of 5 mm
}

TEST(WallVisit, WithoutTextureIsLostOnTheBareStretchAndFoundAfterIt) {
  // There and back over the same frames: things, wall, things.
  SyntheticRun run = synthetic_run("wall-visit-plain", 19, true, 5);
  for (std::size_t i = run.frames.size() - 1; i-- > 0;) {
    RgbdFrame frame = run.frames[i];
    frame.utime = 2 * run.frames.back().utime - frame.utime;
    run.true_path.push_back({frame.utime, run.true_path[i].X_WC});
    run.frames.push_back(frame);
    if (run.frames.size() == 37) break;
  }
  const Tracked tracked = track(run);
  EXPECT_GE(count(tracked, TrackingState::kLost), 3);
  for (const TrackingResult& result : tracked.results) {
    if (result.state == TrackingState::kLost) {
      EXPECT_GT(result.undetermined_C.cols(), 0);
    }
  }
  EXPECT_EQ(tracked.results.back().state, TrackingState::kTracking);
  EXPECT_LT(tracked.end_error_m, 0.01);
}

/// However long the camera stands before it.
TEST(BareWall, BeginsNoPartOfTheMap) {
  MapperPipeline::Config config = small_config();
  config.restart_after_s = 0.2;
  MapperPipeline pipeline(config);
  std::int64_t utime = 0;
  const auto num_begun = [&](const SyntheticRun& run) {
    int count = 0;
    for (RgbdFrame frame : run.frames) {
      frame.utime = utime += kFrame_us;
      count += pipeline.process(frame).part_begun ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(num_begun(synthetic_run("wall-plain", 40, true)), 0);
  EXPECT_EQ(num_begun(synthetic_run("office", 10, true)), 1) << "where there is more to see";
}

TEST(DeterminedView, TakesNoNoticeOfColour) {
  const Intrinsics camera = testing::test_camera();
  const Pose X_WV = testing::looking_at_the_crate();
  const auto input_at = [&](const Pose& X_WC, std::int64_t utime, bool colored) {
    TrackingInput input{
        utime, pyramid_from_depth(testing::render_depth(X_WC, camera), camera, 0, 3, 10.0F), {}};
    if (colored) {  // misleading: the same picture from everywhere
      input.color_rgb.create(camera.height, camera.width);
      cv::RNG random(5);
      random.fill(input.color_rgb, cv::RNG::UNIFORM, 0, 256);
    }
    return input;
  };
  const Model model{pyramid_from_surface(testing::render_room(X_WV, camera), 3), X_WV};
  Vector6d motion;
  motion << 0.02, -0.01, 0.015, 0.01, -0.02, 0.01;
  const Pose X_WC = X_WV * se3_retract(motion);
  Pose found[2];
  for (const bool colored : {false, true}) {
    Tracker tracker({});
    tracker.start_at(X_WV, input_at(X_WV, 0, colored), 1.0);
    const TrackingResult result = tracker.track(input_at(X_WC, kFrame_us, colored), model);
    EXPECT_EQ(result.open_to_depth_C.cols(), 0);
    found[colored ? 1 : 0] = result.X_WC;
  }
  EXPECT_EQ(found[0].matrix(), found[1].matrix());
}

TEST(DeterminedView, TellsTheOpenDirectionsInTheCamerasFrame) {
  // A plane 1.5 m ahead; the camera has moved away from where the model was seen.
  const Intrinsics camera = testing::test_camera();
  const SurfacePyramid plane =
      pyramid_from_depth(cv::Mat_<float>(camera.height, camera.width, 1.5F), camera, 0, 3, 10.0F);
  Tracker tracker({});
  tracker.start_at(Pose::Identity(), {0, plane, {}}, 1.0);
  const TrackingResult result = tracker.track({kFrame_us, plane, {}}, {plane, Pose::Identity()});
  EXPECT_EQ(result.state, TrackingState::kLost);
  EXPECT_EQ(result.loss_reason, LossReason::kUndetermined);
  ASSERT_EQ(result.open_to_depth_C.cols(), 3);
  ASSERT_EQ(result.undetermined_C.cols(), 3);
  // Along x and y and about z: nothing of z, and no turn about x and y.
  const double along_z = result.undetermined_C.row(2).norm() / result.undetermined_C.norm();
  const double tilt = result.undetermined_C.middleRows(3, 2).norm() / result.undetermined_C.norm();
  EXPECT_LT(along_z, 1e-3);
  EXPECT_LT(tilt, 1e-3);
}

}  // namespace
}  // namespace kintsugi::mapper
