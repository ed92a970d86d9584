#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "mapper/core/registration/twist.hpp"
#include "mapper/core/tracking/noise_estimator.hpp"
#include "tests/mapper/core/box_room.hpp"

namespace kintsugi::mapper {
namespace {

constexpr int kFrames = 200;

/// An exact room, and noisy frames of it from another pose.
class Camera {
 public:
  Camera()
      : model_V_(testing::render_room(testing::looking_at_the_crate(), camera())),
        exact_C_(testing::render_room(testing::looking_at_the_crate() * X_VC_, camera())) {}

  SurfaceMap frame(const DepthNoise& noise) {
    SurfaceMap frame_C = exact_C_;
    frame_C.depth_m = exact_C_.depth_m.clone();
    for (int v = 0; v < frame_C.depth_m.rows; ++v) {
      for (int u = 0; u < frame_C.depth_m.cols; ++u) {
        float& depth_m = frame_C.depth_m(v, u);
        depth_m += static_cast<float>(random_.gaussian(noise.sigma_m(depth_m)));
      }
    }
    return frame_C;
  }
  /// Replaces a share of the depths by others that are wrong by this much.
  void spoil(SurfaceMap& frame_C, double share, double by_m) {
    for (int v = 0; v < frame_C.depth_m.rows; ++v) {
      for (int u = 0; u < frame_C.depth_m.cols; ++u) {
        if (random_.uniform(0.0, 1.0) < share) {
          frame_C.depth_m(v, u) += static_cast<float>(random_.uniform(-by_m, by_m));
        }
      }
    }
  }
  void show(const SurfaceMap& frame_C, NoiseEstimator& estimator) const {
    estimator.add(frame_C, model_V_, X_VC_);
  }

 private:
  static Intrinsics camera() { return testing::test_camera(160, 120); }
  static Pose motion() {
    Vector6d xi;
    xi << 0.05, -0.03, 0.04, 0.02, -0.03, 0.02;
    return se3_retract(xi);
  }

  const Pose X_VC_ = motion();
  SurfaceMap model_V_;
  SurfaceMap exact_C_;
  cv::RNG random_{8};
};

void expect_deviation(const DepthNoise& noise, const DepthNoise& truth, double tolerance) {
  for (const double z_m : {2.0, 2.5, 3.0}) {  // most of the room is there
    EXPECT_NEAR(noise.sigma_m(z_m), truth.sigma_m(z_m), tolerance * truth.sigma_m(z_m)) << z_m;
  }
}

// The start counts like three images, at every depth.
constexpr double kFit = 0.1;

TEST(NoiseEstimator, LearnsALargerNoiseThanTheStart) {
  for (const DepthNoise& truth : {DepthNoise{.base_m = 0.002, .share = 0.0, .growth_per_m = 0.0045},
                                  DepthNoise{.base_m = 0.0, .share = 0.015, .growth_per_m = 0.0}}) {
    Camera camera;
    NoiseEstimator estimator{DepthNoise()};
    for (int i = 0; i < kFrames; ++i) camera.show(camera.frame(truth), estimator);
    expect_deviation(estimator.noise(), truth, kFit);
  }
}

TEST(NoiseEstimator, IsTheStartBeforeTheFirstFrame) {
  const DepthNoise start{.base_m = 0.005, .share = 0.015, .growth_per_m = 0.0};
  expect_deviation(NoiseEstimator(start).noise(), start, 1e-9);
}

TEST(NoiseEstimator, DoesNotGoBelowTheStart) {
  const DepthNoise exact{.base_m = 0.0, .share = 0.0, .growth_per_m = 0.0};
  for (const DepthNoise& start :
       {DepthNoise(), DepthNoise{.base_m = 0.005, .share = 0.015, .growth_per_m = 0.0}}) {
    Camera camera;
    NoiseEstimator estimator{start};
    for (int i = 0; i < kFrames; ++i) camera.show(camera.frame(exact), estimator);
    expect_deviation(estimator.noise(), start, 1e-3);
  }
}

TEST(NoiseEstimator, TakesNoNoticeOfPairsOfDifferentSurfaces) {
  const DepthNoise truth;
  const auto learned = [&](double share) {
    Camera camera;
    NoiseEstimator estimator{truth};
    for (int i = 0; i < kFrames; ++i) {
      SurfaceMap frame_C = camera.frame(truth);
      camera.spoil(frame_C, share, 1.0);
      camera.show(frame_C, estimator);
    }
    return estimator.noise();
  };
  // Of errors that are spread over two metres few are small enough to count: 1 to 2 % of all.
  expect_deviation(learned(0.2), learned(0.0), 0.05);
  expect_deviation(learned(0.0), truth, kFit);
}

TEST(NoiseEstimator, TakesNoNoticeOfInvalidPixels) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const DepthNoise truth{.base_m = 0.0, .share = 0.01, .growth_per_m = 0.0};
  Camera camera;
  NoiseEstimator estimator{DepthNoise()};
  for (int i = 0; i < kFrames; ++i) {
    SurfaceMap frame_C = camera.frame(truth);
    frame_C.depth_m.rowRange(0, 20).setTo(nan);
    frame_C.depth_m.rowRange(20, 40).setTo(0.0F);
    camera.show(frame_C, estimator);
  }
  expect_deviation(estimator.noise(), truth, kFit);
}

TEST(NoiseEstimator, FollowsACameraThatBecomesNoisier) {
  const DepthNoise before{.base_m = 0.0, .share = 0.006, .growth_per_m = 0.0};
  const DepthNoise after{.base_m = 0.0, .share = 0.012, .growth_per_m = 0.0};
  Camera camera;
  NoiseEstimator estimator{DepthNoise()};
  for (int i = 0; i < kFrames; ++i) camera.show(camera.frame(before), estimator);
  const double before_m = estimator.noise().sigma_m(2.5);
  for (int i = 0; i < 3 * kFrames; ++i) camera.show(camera.frame(after), estimator);
  EXPECT_GT(estimator.noise().sigma_m(2.5), before_m);
  expect_deviation(estimator.noise(), after, 0.15);
}

}  // namespace
}  // namespace kintsugi::mapper
