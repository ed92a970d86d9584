#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include "mapper/core/frame/surface_pyramid.hpp"
#include "mapper/core/kernels/instruction_set.hpp"
#include "mapper/core/registration/observability.hpp"
#include "mapper/core/registration/photometric.hpp"
#include "tests/mapper/core/box_room.hpp"

namespace kintsugi::mapper {
namespace {

using Eigen::Vector3d;

constexpr double kWall_m = 1.5;  // the plane z = kWall_m in W

/// Smooth, and varies in every direction.
double paint(const Vector3d& p_W) {
  return 0.5 + 0.15 * std::sin(9.0 * p_W.x()) + 0.15 * std::cos(7.0 * p_W.y() + 4.0 * p_W.x());
}

struct Picture {
  SurfaceMap surface;
  IntensityMap intensity;
  operator PhotometricImage() const { return {surface, intensity}; }
};

/// The painted wall, seen from X_WC: exact but for the gradients, which are differences.
Picture picture_at(const Pose& X_WC, double gain = 1.0, double bias = 0.0) {
  const Intrinsics camera = testing::test_camera(160, 120);
  cv::Mat_<float> depth_m(camera.height, camera.width);
  cv::Mat_<float> value(depth_m.size());
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Vector3d ray_C((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1.0);
      const Vector3d ray_W = X_WC.linear() * ray_C;
      const double z = (kWall_m - X_WC.translation().z()) / ray_W.z();
      depth_m(v, u) = static_cast<float>(z);
      value(v, u) = static_cast<float>(gain * paint(X_WC.translation() + z * ray_W) + bias);
    }
  }
  IntensityMap intensity{value, cv::Mat_<float>(value.size(), 0.0F),
                         cv::Mat_<float>(value.size(), 0.0F)};
  for (int v = 1; v + 1 < value.rows; ++v) {
    for (int u = 1; u + 1 < value.cols; ++u) {
      intensity.gradient_u(v, u) = 0.5F * (value(v, u + 1) - value(v, u - 1));
      intensity.gradient_v(v, u) = 0.5F * (value(v + 1, u) - value(v - 1, u));
    }
  }
  return {surface_from_depth(depth_m, camera), intensity};
}

Vector6d some_twist(double scale) {
  Vector6d xi;
  xi << 0.010, -0.006, 0.004, 0.003, -0.004, 0.006;
  return scale * xi;
}

PhotometricEquations linearize_at(const Picture& frame, const Picture& reference, const Pose& X_KC,
                                  const std::optional<Exposure>& exposure = Exposure()) {
  return linearize_photometric(frame, reference, X_KC, Pose::Identity(), exposure, {});
}

Pose align(const Picture& frame, const Picture& reference) {
  Pose X_KC = Pose::Identity();
  std::optional<Exposure> exposure;
  for (int step = 0; step < 15; ++step) {
    const PhotometricEquations equations = linearize_at(frame, reference, X_KC, exposure);
    exposure = equations.exposure;
    X_KC = se3_retract(equations.information.A.ldlt().solve(equations.b)) * X_KC;
  }
  return X_KC;
}

TEST(Photometric, GradientIsThatOfFiniteDifferences) {
  const Picture reference = picture_at(Pose::Identity());
  const Pose X_KC_true = se3_retract(some_twist(1.0));
  const Picture frame = picture_at(X_KC_true);
  // All residuals inside Huber's limit, so that the error is the sum of squares; its minimum over
  // the bias is what is left after elimination.
  PhotometricConfig config;
  config.huber_sigmas = 1e3;
  const auto at = [&](const Pose& X_KC) {
    return linearize_photometric(frame, reference, X_KC, Pose::Identity(), Exposure(), config);
  };
  const auto error = [&](const Pose& X_KC) {
    const PhotometricEquations equations = at(X_KC);
    const double mean = equations.mean_residual;
    const auto pixels = static_cast<double>(equations.pixels);
    return 0.5 * pixels * (equations.rms * equations.rms - mean * mean) /
           (config.sigma * config.sigma);
  };
  const Pose X_KC = se3_retract(some_twist(0.3));
  const PhotometricEquations equations = at(X_KC);
  for (int k = 0; k < 6; ++k) {
    constexpr double kStep = 1e-3;  // a tenth of a pixel
    const Vector6d step = kStep * Vector6d::Unit(k);
    const double slope =
        (error(se3_retract(step) * X_KC) - error(se3_retract(-step) * X_KC)) / (2.0 * kStep);
    // Pixels that enter and leave at the border, and gradients from differences: 2 %.
    EXPECT_NEAR(-equations.b(k), slope, 0.02 * equations.b.norm()) << "direction " << k;
  }
}

// Bilinear interpolation of a picture with waves of 60 pixels: 1/1000 of its contrast.
constexpr double kAligned_m = 1e-4;

TEST(Photometric, AlignsToATenthOfAMillimetre) {
  const Pose X_KC = se3_retract(some_twist(1.0));
  const Pose found = align(picture_at(X_KC), picture_at(Pose::Identity()));
  EXPECT_LT(testing::distance_m(found, X_KC), kAligned_m);
  EXPECT_LT(testing::angle_rad(found, X_KC), kAligned_m);
}

TEST(Photometric, ExposureMakesNoDifference) {
  const Pose X_KC = se3_retract(some_twist(1.0));
  const Picture reference = picture_at(Pose::Identity());
  const Pose found = align(picture_at(X_KC, 0.7, 0.1), reference);
  EXPECT_LT(testing::distance_m(found, X_KC), kAligned_m);
  const PhotometricEquations equations =
      linearize_at(picture_at(X_KC, 0.7, 0.1), reference, X_KC, std::nullopt);
  constexpr double kInterpolation = 2e-3;  // flattens the waves by 1/1000
  EXPECT_NEAR(equations.exposure.gain, 1.0 / 0.7, kInterpolation);
  EXPECT_NEAR(equations.exposure.bias, -0.1 / 0.7, kInterpolation);
}

TEST(Photometric, AUniformWallInformsAboutNothing) {
  Picture frame = picture_at(Pose::Identity());
  frame.intensity = {cv::Mat_<float>(120, 160, 0.6F), cv::Mat_<float>(120, 160, 0.0F),
                     cv::Mat_<float>(120, 160, 0.0F)};
  const PhotometricEquations equations = linearize_at(frame, frame, Pose::Identity());
  EXPECT_EQ(equations.information.A.norm(), 0.0);
  EXPECT_EQ(equations.b.norm(), 0.0);
  EXPECT_EQ(equations.exposure.gain, 1.0);
}

TEST(Photometric, NoiseInformsAboutNothing) {
  Picture pictures[2] = {picture_at(Pose::Identity()), picture_at(Pose::Identity())};
  cv::RNG random(3);
  for (Picture& picture : pictures) {
    random.fill(picture.intensity.gradient_u, cv::RNG::NORMAL, 0.0, 0.01);
    random.fill(picture.intensity.gradient_v, cv::RNG::NORMAL, 0.0, 0.01);
  }
  const PhotometricEquations equations = linearize_at(pictures[0], pictures[1], Pose::Identity());
  const ObservableSplit split =
      split_observable(equations.information, Matrix6d::Identity(), ObservabilityConfig());
  EXPECT_EQ(split.determined.cols(), 0);
}

TEST(Photometric, WhatTheReferenceDidNotSeeTakesNoPart) {
  const Picture reference = picture_at(Pose::Identity());
  Picture frame = picture_at(Pose::Identity());
  const auto all = linearize_at(frame, reference, Pose::Identity()).pixels;
  frame.surface.depth_m(cv::Rect(0, 0, 80, 120)).setTo(0.8F);  // somebody walks in
  frame.surface.depth_m(cv::Rect(80, 0, 10, 120)).setTo(std::numeric_limits<float>::quiet_NaN());
  const auto seen = linearize_at(frame, reference, Pose::Identity()).pixels;
  EXPECT_NEAR(static_cast<double>(seen) / static_cast<double>(all), 70.0 / 160.0, 0.02);
}

/// The sums of the definition, pixel by pixel in double precision.
PhotometricEquations slow_linearization(const Picture& frame, const Picture& reference,
                                        const Pose& X_VC, const Pose& X_KV,
                                        const Exposure& exposure,
                                        const PhotometricConfig& config = {}) {
  const Intrinsics& camera = frame.surface.intrinsics;  // of both
  const auto mixed = [](const cv::Mat_<float>& image, double x, double y) {
    const int u = static_cast<int>(x);
    const int v = static_cast<int>(y);
    return (v + 1 - y) * ((u + 1 - x) * image(v, u) + (x - u) * image(v, u + 1)) +
           (y - v) * ((u + 1 - x) * image(v + 1, u) + (x - u) * image(v + 1, u + 1));
  };
  const auto row_of = [&](const Eigen::Matrix3d& R_VA, const Vector3d& p_A, double gradient_u,
                          double gradient_v, const Vector3d& p_V) {
    const double du = gradient_u * camera.fx / p_A.z();
    const double dv = gradient_v * camera.fy / p_A.z();
    const Vector3d a = R_VA * Vector3d(du, dv, -(du * p_A.x() + dv * p_A.y()) / p_A.z());
    Vector6d row;
    row << a, p_V.cross(a);
    return row;
  };
  PhotometricEquations sum;
  Vector6d rows = Vector6d::Zero();
  double weights = 0.0;
  double residuals = 0.0;
  double squares = 0.0;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Vector3d p_C = frame.surface.point(v, u).cast<double>();
      if (std::isnan(p_C.z())) continue;
      const Vector3d p_V = X_VC * p_C;
      const Vector3d p_K = X_KV * p_V;
      if (p_K.z() <= 0.0) continue;
      const double x = camera.fx * p_K.x() / p_K.z() + camera.cx;
      const double y = camera.fy * p_K.y() / p_K.z() + camera.cy;
      if (x < 1.0 || y < 1.0 || x >= camera.width - 2.0 || y >= camera.height - 2.0) continue;
      const double depth_m = reference.surface.depth_m(static_cast<int>(std::lround(y)),
                                                       static_cast<int>(std::lround(x)));
      const double allowed_m = std::max(config.depth_sigmas * frame.surface.noise.sigma_m(p_K.z()),
                                        config.min_depth_step_m);
      if (std::isnan(depth_m) || std::abs(depth_m - p_K.z()) >= allowed_m) continue;
      const double seen = mixed(reference.intensity.value, x, y);
      const double residual = seen - exposure.gain * frame.intensity.value(v, u) - exposure.bias;
      const double limit = config.huber_sigmas * config.sigma;
      const double weight =
          std::min(1.0, limit / std::abs(residual)) / (config.sigma * config.sigma);
      const Vector6d row =
          row_of(X_KV.linear().transpose(), p_K, mixed(reference.intensity.gradient_u, x, y),
                 mixed(reference.intensity.gradient_v, x, y), p_V);
      const Vector6d other =
          row_of(X_VC.linear(), p_C, exposure.gain * frame.intensity.gradient_u(v, u),
                 exposure.gain * frame.intensity.gradient_v(v, u), p_V);
      sum.information.A += weight * row * row.transpose();
      sum.information.C += 0.5 * weight * (row * other.transpose() + other * row.transpose());
      sum.b -= weight * residual * row;
      rows += weight * row;
      weights += weight;
      residuals += weight * residual;
      squares += residual * residual;
      ++sum.pixels;
    }
  }
  sum.information.A -= rows * rows.transpose() / weights;
  sum.information.C -= rows * rows.transpose() / weights;
  sum.mean_residual = residuals / weights;
  sum.b += rows * sum.mean_residual;
  sum.rms = std::sqrt(squares / static_cast<double>(sum.pixels));
  return sum;
}

/// Two pictures that differ in pose, exposure and what is seen, and where V is.
struct TwoPictures {
  Pose X_KV = se3_retract(some_twist(2.0));
  Pose X_VC = se3_retract(some_twist(-1.2));
  Picture reference = picture_at(Pose::Identity());
  Picture frame = picture_at(se3_retract(some_twist(1.0)), 0.9, 0.05);
  Exposure exposure{.gain = 1.05, .bias = -0.04};

  TwoPictures() {
    frame.surface.depth_m(cv::Rect(20, 10, 37, 30)).setTo(0.8F);
    reference.surface.depth_m(cv::Rect(90, 40, 11, 50))
        .setTo(std::numeric_limits<float>::quiet_NaN());
    frame.intensity.value(cv::Rect(60, 70, 30, 30)).setTo(0.9F);  // beyond Huber's limit
  }
};

TEST(Photometric, SumsAreThoseOfTheDefinition) {
  const TwoPictures two;
  const PhotometricEquations fast =
      linearize_photometric(two.frame, two.reference, two.X_VC, two.X_KV, two.exposure, {});
  const PhotometricEquations slow =
      slow_linearization(two.frame, two.reference, two.X_VC, two.X_KV, two.exposure);
  ASSERT_GT(slow.pixels, 10'000);
  EXPECT_NEAR(static_cast<double>(fast.pixels), static_cast<double>(slow.pixels), 3.0);
  constexpr double kShare = 1e-3;  // three pixels at a border of these, and single precision
  EXPECT_LT((fast.information.A - slow.information.A).norm(), kShare * slow.information.A.norm());
  EXPECT_LT((fast.information.C - slow.information.C).norm(), kShare * slow.information.C.norm());
  EXPECT_LT((fast.b - slow.b).norm(), kShare * slow.b.norm());
  EXPECT_NEAR(fast.mean_residual, slow.mean_residual, kShare * slow.rms);
  EXPECT_NEAR(fast.rms, slow.rms, kShare * slow.rms);
}

void expect_same_bits(const PhotometricEquations& a, const PhotometricEquations& b) {
  EXPECT_EQ(a.information.A, b.information.A);
  EXPECT_EQ(a.information.C, b.information.C);
  EXPECT_EQ(a.b, b.b);
  EXPECT_EQ(a.exposure.gain, b.exposure.gain);
  EXPECT_EQ(a.exposure.bias, b.exposure.bias);
  EXPECT_EQ(a.rms, b.rms);
  EXPECT_EQ(a.mean_residual, b.mean_residual);
  EXPECT_EQ(a.pixels, b.pixels);
}

TEST(Photometric, GivesTheSameBitsWithEveryInstructionSet) {
  const TwoPictures two;
  const auto with = [&](InstructionSet set) {
    return linearize_photometric(two.frame, two.reference, two.X_VC, two.X_KV, two.exposure, {},
                                 kernels_for(set));
  };
  const PhotometricEquations portable = with(InstructionSet::kPortable);
  for (const InstructionSet set : kInstructionSets) {
    if (!is_supported(set)) continue;
    SCOPED_TRACE(name_of(set));
    expect_same_bits(with(set), portable);
  }
}

TEST(Photometric, GivesTheSameBitsWhateverTheThreads) {
  const TwoPictures two;
  const auto with_threads = [&](int threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return linearize_photometric(two.frame, two.reference, two.X_VC, two.X_KV, two.exposure, {});
  };
  expect_same_bits(with_threads(4), with_threads(1));
}

TEST(PhotometricConfig, NamesTheFieldOutOfRange) {
  PhotometricConfig config;
  config.sigma = 0.0;
  EXPECT_THROW(config.validate(), std::invalid_argument);
}

TEST(Intensity, PyramidStartsAtTheAskedSize) {
  cv::Mat_<cv::Vec3b> color(48, 64);
  for (int v = 0; v < 48; ++v) {
    for (int u = 0; u < 64; ++u) color(v, u) = cv::Vec3b::all(static_cast<std::uint8_t>(2 * u));
  }
  const IntensityPyramid pyramid = intensity_pyramid(color, {32, 24}, 3);
  ASSERT_EQ(pyramid.size(), 3U);
  EXPECT_EQ(pyramid[2].value.size(), cv::Size(8, 6));
  // A ramp of 2 / 255 a pixel is one of 4 / 255 at half the size.
  EXPECT_NEAR(pyramid[0].gradient_u(5, 5), 4.0 / 255.0, 1e-6);
  EXPECT_NEAR(pyramid[0].gradient_v(5, 5), 0.0, 1e-6);
  EXPECT_NEAR(pyramid[0].value(5, 5), 21.0 / 255.0, 1e-6);
  EXPECT_THROW(intensity_pyramid(color, {30, 24}, 1), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::mapper
