#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "mapper/core/mapper_pipeline.hpp"
#include "segmenter/evaluation/trajectory/trajectory_error.hpp"
#include "tests/mapper/core/synthetic_frames.hpp"

namespace kintsugi::mapper {
namespace {

using testing::blank;
using testing::synthetic_run;
using testing::SyntheticRun;

/// Coarse enough for 320x240 images and a fast test; shifts early, so that there are slices.
MapperPipeline::Config small_config() {
  MapperPipeline::Config config;
  config.volume.region = RegionShape::kCube;
  config.volume.volume_size_m = 4.0;
  config.volume.resolution_m = 0.015;
  config.volume.shift_vox = 8;
  config.slices.extractor.weight_threshold = 3;
  return config;
}

struct Output {
  Trajectory path;
  std::vector<TrackingState> states;
  std::vector<CloudSlice> slices;
};

void append(std::vector<CloudSlice>& to, std::vector<CloudSlice> slices) {
  for (CloudSlice& slice : slices) to.push_back(std::move(slice));
}

Output run(const MapperPipeline::Config& config, const std::vector<RgbdFrame>& frames) {
  MapperPipeline pipeline(config);
  Output output;
  for (const RgbdFrame& frame : frames) {
    FrameResult result = pipeline.process(frame);
    output.states.push_back(result.tracking.state);
    output.path.push_back({frame.utime, result.tracking.X_WC});
    append(output.slices, std::move(result.slices));
  }
  append(output.slices, pipeline.finish());
  return output;
}

void expect_same(const Output& a, const Output& b) {
  ASSERT_EQ(a.path.size(), b.path.size());
  for (std::size_t i = 0; i < a.path.size(); ++i) {
    EXPECT_EQ(a.path[i].X_WC.matrix(), b.path[i].X_WC.matrix()) << "frame " << i;
  }
  ASSERT_EQ(a.slices.size(), b.slices.size());
  for (std::size_t i = 0; i < a.slices.size(); ++i) {
    EXPECT_EQ(a.slices[i].utime, b.slices[i].utime);
    EXPECT_EQ(a.slices[i].kind, b.slices[i].kind);
    EXPECT_TRUE(a.slices[i].points_W == b.slices[i].points_W) << "slice " << i;
  }
}

/// The office with noise, shared by several tests.
const SyntheticRun& noisy_office() {
  static const SyntheticRun office = synthetic_run("office", 40, true);
  return office;
}

TEST(MapperPipeline, FollowsTheCameraWithoutNoise) {
  const SyntheticRun office = synthetic_run("office", 30, false);
  const Output output = run(small_config(), office.frames);
  EXPECT_THAT(output.states, ::testing::Each(TrackingState::kTracking));
  // A tenth of a voxel would be perfect; edges smeared over voxels and depth in millimetres leave
  // more. Bound: a third of the 15 mm voxel.
  EXPECT_LT(absolute_trajectory_error(output.path, office.true_path).translation_m.rmse, 0.005);
}

TEST(MapperPipeline, FollowsTheCameraWithNoise) {
  const Output output = run(small_config(), noisy_office().frames);
  EXPECT_THAT(output.states, ::testing::Each(TrackingState::kTracking));
  // Noise of 2 to 8 mm a pixel at 1 to 2.4 m is averaged over 1e4 pixels and many frames; what
  // remains is drift of the model. The target for whole rooms is 10 mm.
  EXPECT_LT(absolute_trajectory_error(output.path, noisy_office().true_path).translation_m.rmse,
            0.010);
}

TEST(MapperPipeline, FollowsTheCameraAlsoWhereMostFramesAreOnlyTracked) {
  MapperPipeline pipeline(small_config());
  Trajectory path;
  std::int64_t num_blocks = 0;
  const std::vector<RgbdFrame>& frames = noisy_office().frames;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const bool fuse = i % 4 == 2;
    const FrameResult result = pipeline.process(frames[i], fuse);
    EXPECT_EQ(result.tracking.state, TrackingState::kTracking);
    EXPECT_EQ(result.is_fused, fuse || i == 0) << "the first frame is what others are tracked in";
    if (!result.is_fused) {
      EXPECT_EQ(pipeline.num_blocks(), num_blocks);
    }
    num_blocks = pipeline.num_blocks();
    path.push_back({frames[i].utime, result.tracking.X_WC});
  }
  EXPECT_LT(absolute_trajectory_error(path, noisy_office().true_path).translation_m.rmse, 0.010);
  const Trajectory corrected = pipeline.corrected_paths().at(0);
  ASSERT_EQ(corrected.size(), frames.size()) << "the path has every frame";
}

TEST(MapperPipeline, NumbersSlicesFromZeroAndEndsWithTheFinalOne) {
  // Every twelfth frame: the camera moves a metre and more, and the cube with it.
  const SyntheticRun office = synthetic_run("office", 40, false, 12);
  MapperPipeline::Config config = small_config();
  config.volume.volume_size_m = 2.5;
  config.slices.extractor.weight_threshold = 1;
  config.given_path = office.true_path;
  const Output output = run(config, office.frames);
  ASSERT_GE(output.slices.size(), 3U);
  for (std::size_t i = 0; i < output.slices.size(); ++i) {
    const CloudSlice& slice = output.slices[i];
    EXPECT_EQ(slice.id, static_cast<int>(i));
    EXPECT_EQ(slice.kind == SliceKind::kFinal, i + 1 == output.slices.size());
    EXPECT_FLOAT_EQ(slice.resolution_m, 0.015F);
    EXPECT_GE(slice.utime, i == 0 ? 0 : output.slices[i - 1].utime);
  }
  EXPECT_EQ(output.slices.back().utime, office.frames.back().utime);
  EXPECT_GT(output.slices.back().points_W.size(), 500U);
}

TEST(MapperPipeline, GivesTheSameBytesWhateverTheThreads) {
  const std::vector<RgbdFrame> frames(noisy_office().frames.begin(),
                                      noisy_office().frames.begin() + 15);
  const auto with_threads = [&](int threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return run(small_config(), frames);
  };
  const Output one = with_threads(1);
  const Output two = with_threads(2);
  const Output two_again = with_threads(2);
  expect_same(one, two);
  expect_same(two, two_again);
}

TEST(MapperPipeline, FusesNothingWhileLostAndGoesOnWhenTheViewReturns) {
  const std::vector<RgbdFrame>& frames = noisy_office().frames;
  MapperPipeline pipeline(small_config());
  Pose X_WC_before;
  for (int i = 0; i < 15; ++i) X_WC_before = pipeline.process(frames[i]).tracking.X_WC;
  const std::int64_t blocks_before = pipeline.num_blocks();
  for (int i = 15; i < 19; ++i) {
    const FrameResult result = pipeline.process(blank(frames[i]));
    EXPECT_EQ(result.tracking.state, TrackingState::kLost);
    EXPECT_TRUE(result.tracking.X_WC.isApprox(X_WC_before));
    EXPECT_EQ(pipeline.num_blocks(), blocks_before);
  }
  Output rest;
  for (int i = 19; i < 30; ++i) {
    const FrameResult result = pipeline.process(frames[i]);
    EXPECT_EQ(result.tracking.state, TrackingState::kTracking) << i;
    rest.path.push_back({frames[i].utime, result.tracking.X_WC});
  }
  EXPECT_LT(absolute_trajectory_error(rest.path, noisy_office().true_path).translation_m.rmse,
            0.010);
}

/// A slow pan and, a second later, a return to its beginning, between the frames seen then: what
/// the camera does meanwhile is not seen.
Output pan_and_return(bool with_color, bool covered) {
  static const SyntheticRun office = synthetic_run("office", 48, true, 5);
  std::vector<RgbdFrame> frames;
  Trajectory true_path;
  std::int64_t utime = 0;
  const auto play = [&](const RgbdFrame& frame, const Pose& X_WC) {
    frames.push_back(frame);
    frames.back().utime = utime += 33'333;
    if (!with_color) frames.back().color_rgb.release();
    true_path.push_back({frames.back().utime, X_WC});
  };
  for (int i = 0; i < 48; i += 2) play(office.frames[i], office.true_path[i].X_WC);
  for (int i = 0; covered && i < 5; ++i) play(blank(office.frames[0]), Pose::Identity());
  utime += 1'000'000;
  for (int i = 1; i < 12; i += 2) play(office.frames[i], office.true_path[i].X_WC);
  MapperPipeline::Config config = small_config();
  Output output = run(config, frames);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Pose X_W_true = office.true_path[0].X_WC.inverse() * true_path[i].X_WC;
    if (output.states[i] == TrackingState::kTracking) {
      // A centimetre and a half a voxel: drift along the way, and noise.
      EXPECT_LT((output.path[i].X_WC.translation() - X_W_true.translation()).norm(), 0.02) << i;
    }
  }
  return output;
}

class MapperPipelineReturn : public ::testing::TestWithParam<bool> {};

TEST_P(MapperPipelineReturn, KnowsAPlaceAgainAfterTheCameraWasCovered) {
  const Output output = pan_and_return(GetParam(), true);
  for (int i = 0; i < 24; ++i) EXPECT_EQ(output.states[i], TrackingState::kTracking) << i;
  for (int i = 24; i < 29; ++i) EXPECT_EQ(output.states[i], TrackingState::kLost) << i;
  EXPECT_EQ(output.states.back(), TrackingState::kTracking);
}

TEST_P(MapperPipelineReturn, KnowsAPlaceAgainAfterAJump) {
  const Output output = pan_and_return(GetParam(), false);
  EXPECT_EQ(output.states.back(), TrackingState::kTracking);
}

INSTANTIATE_TEST_SUITE_P(Color, MapperPipelineReturn, ::testing::Bool());

TEST(MapperPipeline, GivesTheSameBytesWhenItLosesItsWay) {
  expect_same(pan_and_return(true, true), pan_and_return(true, true));
}

TEST(MapperPipeline, StartsWithTheFirstFrameThatShowsSomething) {
  const std::vector<RgbdFrame>& frames = noisy_office().frames;
  const Output output =
      run(small_config(), {blank(frames[0]), blank(frames[1]), frames[2], frames[3]});
  EXPECT_THAT(output.states,
              ::testing::ElementsAre(TrackingState::kStarting, TrackingState::kStarting,
                                     TrackingState::kTracking, TrackingState::kTracking));
  EXPECT_TRUE(output.path[2].X_WC.isApprox(Pose::Identity()));
}

TEST(MapperPipeline, RefusesImagesThatAreTooSmallToTrack) {
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(320, 2), std::pair(2, 240)}) {
    RgbdFrame frame;
    frame.intrinsics = {.fx = 100.0,
                        .fy = 100.0,
                        .cx = 0.0,
                        .cy = 0.0,
                        .width = width,
                        .height = height,
                        .distortion = {}};
    frame.depth_m = cv::Mat_<float>(height, width, 1.0F);
    MapperPipeline pipeline(small_config());
    EXPECT_THAT([&] { (void)pipeline.process(frame); },
                ::testing::ThrowsMessage<std::invalid_argument>(
                    ::testing::HasSubstr("pixels are too small")));
  }
}

TEST(MapperPipeline, ARunWithoutFramesIsOneEmptyFinalSlice) {
  const Output output = run(small_config(), {});
  ASSERT_EQ(output.slices.size(), 1U);
  EXPECT_EQ(output.slices[0].kind, SliceKind::kFinal);
  EXPECT_TRUE(output.slices[0].points_W.empty());
}

TEST(MapperPipeline, TakesGivenPosesInsteadOfTracking) {
  const SyntheticRun office = synthetic_run("office", 30, false);
  MapperPipeline::Config config = small_config();
  config.given_path = office.true_path;
  config.given_path.erase(config.given_path.begin() + 10);  // its neighbours are 33 ms away
  const Output output = run(config, office.frames);
  for (std::size_t i = 0; i < office.frames.size(); ++i) {
    EXPECT_EQ(output.states[i], i == 10 ? TrackingState::kLost : TrackingState::kGiven);
    if (i == 10) continue;
    EXPECT_TRUE(output.path[i].X_WC.isApprox(office.true_path[i].X_WC, 1e-9)) << i;
  }
  // The map is then in the scene's frame, and its points are on the scene's surfaces.
  const synthetic::Scene scene = synthetic::make_scene("office");
  std::size_t points = 0;
  std::size_t off_surface = 0;
  for (const CloudSlice& slice : output.slices) {
    for (const CloudPoint& point : slice.points_W) {
      const double distance_m = scene.signed_distance({point.x, point.y, point.z});
      ++points;
      if (std::abs(distance_m) > config.volume.resolution_m) ++off_surface;
    }
  }
  EXPECT_GT(points, 5000U);
  // Beyond one voxel: thin parts and silhouettes, where a truncation band meets another surface.
  EXPECT_LT(static_cast<double>(off_surface), 0.05 * static_cast<double>(points));
}

TEST(MapperPipelineConfig, NamesTheFieldOutOfRange) {
  MapperPipeline::Config config;
  config.finest_tracking_width_px = 0;
  EXPECT_THROW(MapperPipeline{config}, std::invalid_argument);
  config = {};
  config.volume.resolution_m = -1.0;
  EXPECT_THROW(MapperPipeline{config}, std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::mapper
