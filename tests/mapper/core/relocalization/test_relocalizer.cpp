#include <cmath>

#include <gtest/gtest.h>

#include "lcmtypes/trajectory.hpp"
#include "mapper/core/fusion/integrator.hpp"
#include "mapper/core/fusion/raycaster.hpp"
#include "mapper/core/relocalization/relocalizer.hpp"
#include "tests/mapper/core/synthetic_frames.hpp"

namespace kintsugi::mapper {
namespace {

using testing::synthetic_run;
using testing::SyntheticRun;

TrackingInput input_from(const RgbdFrame& frame, bool with_color = true) {
  TrackingInput input{
      frame.utime, pyramid_from_depth(frame.depth_m, frame.intrinsics, 0, 3, 6.0F), {}};
  if (with_color) input.color_rgb = frame.color_rgb;
  return input;
}

TsdfVolume::Config volume_config() {
  TsdfVolume::Config config;
  config.region = RegionShape::kCube;
  config.resolution_m = 0.015;
  return config;
}

/// The office seen along a part of its path, every fourth frame, at known poses.
class OfficeMap {
 public:
  explicit OfficeMap(bool with_color, double voxel_m = Model().voxel_m)
      : voxel_m_(voxel_m), volume_(volume_config(), office().true_path.front().X_WC.translation()) {
    for (std::size_t i = 0; i < kSeen; i += 2) {
      const Pose& X_WC = office().true_path[i].X_WC;
      integrator_.integrate(office().frames[i], X_WC, volume_);
      relocalizer.remember(input_from(office().frames[i], with_color), seen_from(X_WC));
    }
  }

  /// The map is made of every other frame.
  static const SyntheticRun& office() {
    static const SyntheticRun run = synthetic_run("office", 40, true, 4);
    return run;
  }
  static constexpr std::size_t kSeen = 40;

  Model seen_from(const Pose& X_WV) const {
    return {
        pyramid_from_surface(raycaster_.raycast(volume_, X_WV, office().frames[0].intrinsics), 3),
        X_WV, voxel_m_};
  }
  std::optional<TrackingResult> find(const TrackingInput& frame,
                                     const Relocalizer::PlaceOf& place_of = {}) {
    return relocalizer.find(
        frame, tracker, [&](const Pose& X_WV) { return seen_from(X_WV); }, place_of);
  }
  /// Calls find() as often as there can be candidates.
  std::optional<TrackingResult> find_at_last(const TrackingInput& frame,
                                             const Relocalizer::PlaceOf& place_of = {}) {
    for (int i = 0; i < 9; ++i) {
      if (auto found = find(frame, place_of)) return found;
    }
    return std::nullopt;
  }

  Relocalizer relocalizer{Relocalizer::Config{}};
  Tracker tracker{Tracker::Config{}};

 private:
  const double voxel_m_;  ///< by which residuals are judged
  TsdfVolume volume_;
  Integrator integrator_{Integrator::Config{}};
  Raycaster raycaster_{Raycaster::Config{}};
};

/// Noise of a single frame and a map of 15 mm voxels leave a few millimetres; a wrong place is off
/// by far more.
constexpr double kFound_m = 0.01;
constexpr double kFound_rad = 0.01;

class RelocalizerWithAndWithoutColor : public ::testing::TestWithParam<bool> {};

TEST_P(RelocalizerWithAndWithoutColor, FindsPlacesSeenBeforeWithinACentimetre) {
  OfficeMap map(GetParam());
  for (std::size_t i = 1; i < OfficeMap::kSeen; i += 8) {  // between the frames of the map
    const auto found = map.find_at_last(input_from(OfficeMap::office().frames[i], GetParam()));
    ASSERT_TRUE(found) << i;
    EXPECT_EQ(found->state, TrackingState::kTracking);
    EXPECT_FALSE(found->loss_reason);
    const Pose X_difference = OfficeMap::office().true_path[i].X_WC.inverse() * found->X_WC;
    EXPECT_LT(X_difference.translation().norm(), kFound_m) << i;
    EXPECT_LT(rotation_angle_rad(X_difference), kFound_rad) << i;
  }
}

TEST_P(RelocalizerWithAndWithoutColor, RefusesAPlaceNeverSeen) {
  OfficeMap map(GetParam());
  const SyntheticRun elsewhere = synthetic_run("loop", 2, true, 40);
  for (const RgbdFrame& frame : elsewhere.frames) {
    EXPECT_FALSE(map.find_at_last(input_from(frame, GetParam())));
  }
}

TEST_P(RelocalizerWithAndWithoutColor, RefusesTheMirrorImage) {
  OfficeMap map(GetParam());
  for (std::size_t i = 1; i < OfficeMap::kSeen; i += 20) {
    const RgbdFrame& frame = OfficeMap::office().frames[i];
    RgbdFrame mirrored = frame;
    mirrored.depth_m.release();  // not into the frame itself
    mirrored.color_rgb.release();
    cv::flip(frame.depth_m, mirrored.depth_m, 1);
    cv::flip(frame.color_rgb, mirrored.color_rgb, 1);
    EXPECT_FALSE(map.find_at_last(input_from(mirrored, GetParam()))) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Color, RelocalizerWithAndWithoutColor, ::testing::Bool());

TEST(Relocalizer, TellsPlacesOfTheSameShapeApartByTheirColor) {
  OfficeMap map(true);
  RgbdFrame repainted = OfficeMap::office().frames[1];
  ASSERT_TRUE(map.find_at_last(input_from(repainted)));
  cv::Mat upside_down;
  cv::flip(repainted.color_rgb, upside_down, 0);
  repainted.color_rgb = upside_down;
  EXPECT_FALSE(map.find_at_last(input_from(repainted)));
}

TEST(Relocalizer, GivesTheSamePosesForTheSameFrames) {
  const auto poses = [] {
    OfficeMap map(true);
    std::vector<Pose> X_WC;
    for (std::size_t i = 1; i < OfficeMap::kSeen; i += 8) {
      const auto found = map.find(input_from(OfficeMap::office().frames[i]));
      X_WC.push_back(found ? found->X_WC : Pose::Identity());
    }
    return X_WC;
  };
  const std::vector<Pose> once = poses();
  const std::vector<Pose> again = poses();
  for (std::size_t i = 0; i < once.size(); ++i) EXPECT_EQ(once[i].matrix(), again[i].matrix());
}

/// Registration with the keyframes' own surfaces, because the volume is empty.
std::optional<TrackingResult> find_without_volume(OfficeMap& map, const RgbdFrame& frame) {
  const Tracker tracker{Tracker::Config{}};
  const Raycaster raycaster{Raycaster::Config{}};
  const TsdfVolume empty(volume_config());
  const auto nothing = [&](const Pose& X_WV) {
    return Model{pyramid_from_surface(raycaster.raycast(empty, X_WV, frame.intrinsics), 3), X_WV};
  };
  for (int i = 0; i < 9; ++i) {
    if (auto found = map.relocalizer.find(input_from(frame), tracker, nothing)) return found;
  }
  return std::nullopt;
}

TEST(Relocalizer, FindsAPlaceThatTheVolumeHasLeft) {
  OfficeMap map(true);
  const auto found = find_without_volume(map, OfficeMap::office().frames[9]);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->found_by_keyframe);
  const Pose& X_WC_true = OfficeMap::office().true_path[9].X_WC;
  EXPECT_LT((found->X_WC.translation() - X_WC_true.translation()).norm(), kFound_m);
}

TEST(Relocalizer, JudgesWhatTheVolumeHasLeftByTheVoxelsOfTheMap) {
  OfficeMap map(true, 0.02);
  const auto found = find_without_volume(map, OfficeMap::office().frames[9]);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->quality.voxel_m, 0.02) << "limits of residuals are multiples of it";
}

// Objects of one kind look alike anywhere: features alone do not identify a place.
TEST(Relocalizer, RefusesAPlaceThatLooksTheSameAndHasAnotherShape) {
  OfficeMap map(true);
  RgbdFrame frame = OfficeMap::office().frames[9];
  frame.depth_m = frame.depth_m.clone();
  const int width = frame.depth_m.cols;
  cv::Mat farther = frame.depth_m.colRange(width - width / 7, width);
  farther += 0.2;  // 13 % of the overlap lies behind what the keyframe saw
  EXPECT_FALSE(find_without_volume(map, frame));
}

TEST(Relocalizer, FindsNothingWithoutKeyframes) {
  Relocalizer relocalizer{Relocalizer::Config{}};
  const Tracker tracker{Tracker::Config{}};
  EXPECT_FALSE(relocalizer.find(input_from(OfficeMap::office().frames[0]), tracker,
                                [](const Pose&) { return Model{}; }));
}

/// The camera was tracked in another part of the map, which was joined with this one.
TEST(Relocalizer, MeasuresHowFarTheCameraCanHaveGotInTheCorrectedMap) {
  OfficeMap map(true);
  const RgbdFrame& frame = OfficeMap::office().frames[1];
  Pose X_joined(Eigen::Translation3d(1'000.0, 0.0, 0.0));
  map.tracker.start_at(X_joined * OfficeMap::office().true_path[1].X_WC, input_from(frame), 1.0);
  EXPECT_FALSE(map.find_at_last(input_from(frame))) << "a kilometre away";
  EXPECT_TRUE(map.find_at_last(
      input_from(frame), [&](int /*keyframe*/) { return Relocalizer::Place{.motion = X_joined}; }));
}

/// 3 m from where it was a moment before, as in the next room of a building: that tracking drifts
/// so far takes a way of 150 m.
TEST(Relocalizer, RefusesAPlaceFartherAwayThanTrackingDriftsOnTheWay) {
  OfficeMap map(true);
  const RgbdFrame& frame = OfficeMap::office().frames[1];
  const Pose X_away(Eigen::Translation3d(3.0, 0.0, 0.0));
  map.tracker.start_at(X_away * OfficeMap::office().true_path[1].X_WC, input_from(frame), 1.0);
  const auto found_after = [&](double way_m) {
    return map.find_at_last(input_from(frame),
                            [&](int /*keyframe*/) { return Relocalizer::Place{.way_m = way_m}; });
  };
  EXPECT_FALSE(found_after(100.0));
  EXPECT_TRUE(found_after(200.0));
}

/// The other keyframes are in other rooms, which the camera cannot have reached.
TEST(Relocalizer, TriesAtOnceWhatTheCameraCanHaveReached) {
  OfficeMap map(false);  // without features
  const RgbdFrame& frame = OfficeMap::office().frames[1];
  const Pose& X_WC = OfficeMap::office().true_path[1].X_WC;
  map.tracker.start_at(X_WC, input_from(frame, false), 1.0);
  const Pose X_away(Eigen::Translation3d(10.0, 0.0, 0.0));
  int num_near = 0;
  for (int only = 0; only < map.relocalizer.num_keyframes(); ++only) {
    const double distance_m =
        (map.relocalizer.keyframes()[only].X_WC.translation() - X_WC.translation()).norm();
    if (distance_m > 0.2) continue;
    ++num_near;
    EXPECT_TRUE(map.find(input_from(frame, false), [&](int number) {
      return Relocalizer::Place{.motion = number == only ? Pose::Identity() : X_away};
    })) << only;
  }
  EXPECT_GT(num_near, 1);
}

/// On the way back tracking has drifted by 0.3 m, and so has what the volume has of the place.
TEST(Relocalizer, LeavesTheCameraInTheVolumeThatCoversThePlace) {
  OfficeMap map(true);
  map.relocalizer.keyframes().release_if([](const Keyframe&) { return true; });
  const Pose X_UN(Eigen::Translation3d(0.3, 0.0, 0.0));  // N: as the keyframes were tracked
  const auto seen_in_volume = [&](const Pose& X_UV) {
    Model model = map.seen_from(X_UN.inverse() * X_UV);
    model.X_WV = X_UV;
    return model;
  };
  const auto place_of = [&](int /*keyframe*/) { return Relocalizer::Place{.motion = X_UN}; };
  std::optional<TrackingResult> found;
  for (int i = 0; i < 9 && !found; ++i) {
    found = map.relocalizer.find(input_from(OfficeMap::office().frames[9]), map.tracker,
                                 seen_in_volume, place_of);
  }
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->found_by_keyframe) << "the pose is not in its frame";
  const Pose X_UC_true = X_UN * OfficeMap::office().true_path[9].X_WC;
  EXPECT_LT((found->X_WC.translation() - X_UC_true.translation()).norm(), kFound_m);
}

}  // namespace
}  // namespace kintsugi::mapper
