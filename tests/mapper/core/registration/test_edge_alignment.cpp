#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "mapper/core/registration/edge_alignment.hpp"
#include "mapper/core/registration/observability.hpp"
#include "tests/mapper/core/box_room.hpp"

namespace kintsugi::mapper {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Vector6d twist(double x, double y, double z, double a, double b, double c) {
  Vector6d xi;
  xi << x, y, z, a, b, c;
  return xi;
}

// --- Outlines given by hand ---

constexpr int kRows = 0;
constexpr int kColumns = 1;

/// Pixels of outlines of a frame, each with an outline of the model at some distance from it.
class Outlines {
 public:
  /// @param axis where the outlines are
  Outlines(int axis, const std::vector<float>& distances_px)
      : axis_(axis), camera_(testing::test_camera()) {
    lines_of(edges_C_).resize(240);
    lines_of(edges_V_).resize(240);
    for (const float distance_px : distances_px) {
      const std::size_t line_C = 30 + 20 * pairs_.size();
      const EdgePixel frame{
          .position_px = 200.0F, .slope = -0.25F, .depth_m = kDepth_m, .ends = true};
      const Vector2d seen = projection(X_VC_, line_C);
      const std::ptrdiff_t line_V = std::lround(seen[1 - axis]);
      const EdgePixel model{.position_px = static_cast<float>(seen[axis]) + distance_px,
                            .slope = 0.4F,
                            .depth_m = kDepth_m,
                            .ends = true};
      lines_of(edges_C_)[line_C].push_back(frame);
      lines_of(edges_V_)[line_V].push_back(model);
      pairs_.push_back({line_C, line_V, model.position_px});
    }
  }

  EdgeEquations equations() const {
    const SurfaceMap surface(camera_);
    return linearize_edges(edges_C_, surface, edges_V_, surface, X_VC_, {});
  }
  /// Of a pair, with the slope of the model's outline or of the frame's.
  double residual_px(std::size_t pair, const Vector6d& xi, double slope = kSlope_V) const {
    const auto& [line_C, line_V, position_px] = pairs_[pair];
    const Vector2d seen = projection(se3_retract(xi) * X_VC_, line_C);
    return position_px + slope * (seen[1 - axis_] - static_cast<double>(line_V)) - seen[axis_];
  }
  std::size_t size() const { return pairs_.size(); }
  EdgePixel& model(std::size_t pair) { return lines_of(edges_V_)[pairs_[pair].line_V].front(); }

  static constexpr double kSlope_C = -0.25F;
  static constexpr double kSlope_V = 0.4F;

 private:
  static constexpr float kDepth_m = 1.5F;

  struct Pair {
    std::size_t line_C;
    std::ptrdiff_t line_V;
    double position_px;
  };

  std::vector<std::vector<EdgePixel>>& lines_of(DepthEdges& edges) const {
    return axis_ == kRows ? edges.rows : edges.columns;
  }
  Vector2d projection(const Pose& X_VC, std::size_t line_C) const {
    Vector2d pixel;
    pixel[axis_] = 200.0;
    pixel[1 - axis_] = static_cast<double>(line_C);
    const Vector3d ray_C((pixel.x() - camera_.cx) / camera_.fx,
                         (pixel.y() - camera_.cy) / camera_.fy, 1.0);
    const Vector3d p = X_VC * (kDepth_m * ray_C);
    return {camera_.fx * p.x() / p.z() + camera_.cx, camera_.fy * p.y() / p.z() + camera_.cy};
  }

  int axis_;
  Intrinsics camera_;
  Pose X_VC_ = se3_retract(twist(0.01, -0.02, 0.015, 0.01, -0.015, 0.02));
  DepthEdges edges_C_;
  DepthEdges edges_V_;
  std::vector<Pair> pairs_;
};

/// Of the residuals of five pairs.
double deviation_px(const Outlines& outlines) {
  std::vector<double> amounts_px;
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    amounts_px.push_back(std::abs(outlines.residual_px(i, Vector6d::Zero())));
  }
  std::sort(amounts_px.begin(), amounts_px.end());
  return std::max(EdgeAlignmentConfig().min_sigma_px, 1.4826 * amounts_px[2]);
}

/// One residual beyond Huber's limit, and two at the least deviation.
std::vector<std::vector<float>> distances_px() {
  return {{0.8F, -0.5F, 0.6F, 5.0F, -0.7F}, {0.05F, -0.1F, 0.02F, 0.6F, -1.0F}};
}

Vector6d numeric_gradient(const std::function<double(const Vector6d&)>& function) {
  constexpr double kStep = 1e-6;
  Vector6d gradient;
  for (int k = 0; k < 6; ++k) {
    const Vector6d step = kStep * Vector6d::Unit(k);
    gradient(k) = (function(step) - function(-step)) / (2.0 * kStep);
  }
  return gradient;
}

double huber(double sigmas) {
  const double limit = EdgeAlignmentConfig().huber_sigmas;
  return std::abs(sigmas) < limit ? 0.5 * sigmas * sigmas
                                  : limit * (std::abs(sigmas) - 0.5 * limit);
}

class EdgeLinearization : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Lines, EdgeLinearization, ::testing::Values(kRows, kColumns),
                         [](const auto& info) {
                           return info.param == kRows ? "InRows" : "InColumns";
                         });

// The code computes in single precision: positions of 200 pixels to 2e-5, of residuals of
// a tenth of a pixel.
constexpr double kFloat = 1e-3;

TEST_P(EdgeLinearization, HasTheGradientOfTheRobustError) {
  for (const std::vector<float>& distances : distances_px()) {
    const Outlines outlines(GetParam(), distances);
    const double sigma_px = deviation_px(outlines);
    const auto error = [&](const Vector6d& xi) {
      double sum = 0.0;
      for (std::size_t i = 0; i < outlines.size(); ++i) {
        sum += huber(outlines.residual_px(i, xi) / sigma_px);
      }
      return sum;
    };
    const EdgeEquations equations = outlines.equations();
    ASSERT_EQ(equations.pairs, 5);
    const Vector6d gradient = numeric_gradient(error);
    EXPECT_LT((equations.b + gradient).norm(), kFloat * gradient.norm()) << sigma_px;
  }
}

TEST_P(EdgeLinearization, HasTheSquaresOfTheGradientsOfTheResiduals) {
  for (const std::vector<float>& distances : distances_px()) {
    const Outlines outlines(GetParam(), distances);
    const double sigma_px = deviation_px(outlines);
    const double limit_px = EdgeAlignmentConfig().huber_sigmas * sigma_px;
    Matrix6d A = Matrix6d::Zero();
    Matrix6d C = Matrix6d::Zero();
    for (std::size_t i = 0; i < outlines.size(); ++i) {
      const auto jacobian = [&](double slope) {
        return numeric_gradient(
            [&](const Vector6d& xi) { return outlines.residual_px(i, xi, slope); });
      };
      const Vector6d of_model = jacobian(Outlines::kSlope_V);
      const Vector6d of_frame = jacobian(Outlines::kSlope_C);
      const double residual_px = std::abs(outlines.residual_px(i, Vector6d::Zero()));
      const double weight = std::min(1.0, limit_px / residual_px) / (sigma_px * sigma_px);
      const Matrix6d one_way = 0.5 * weight * of_model * of_frame.transpose();
      A += weight * of_model * of_model.transpose();
      C += one_way + one_way.transpose();
    }
    const Information information = outlines.equations().information;
    EXPECT_LT((information.A - A).norm(), kFloat * A.norm()) << sigma_px;
    EXPECT_LT((information.C - C).norm(), kFloat * C.norm()) << sigma_px;
  }
}

TEST_P(EdgeLinearization, PairsOutlinesOfTheSameSideAndAsDeepThatAreNear) {
  EXPECT_EQ(Outlines(GetParam(), {7.5F}).equations().pairs, 1);
  EXPECT_EQ(Outlines(GetParam(), {8.5F}).equations().pairs, 0);
  Outlines other_side(GetParam(), {0.0F});
  other_side.model(0).ends = false;
  EXPECT_EQ(other_side.equations().pairs, 0);
  EXPECT_EQ(other_side.equations().information.A.norm(), 0.0);
  Outlines other_depth(GetParam(), {0.0F});
  // 5 % of 1.5 m and four deviations of 3.9 mm: 9 cm.
  other_depth.model(0).depth_m = 1.58F;
  EXPECT_EQ(other_depth.equations().pairs, 1);
  other_depth.model(0).depth_m = 1.65F;
  EXPECT_EQ(other_depth.equations().pairs, 0);
}

TEST(EdgeInformation, OfAnOutlineIsTheSameInImagesOfAllSizes) {
  // In an image of four times as many pixels the outline has twice as many.
  const auto information_of = [](double outline_px, std::size_t num_pixels) {
    const Information each{outline_px * Matrix6d::Identity(), outline_px * Matrix6d::Identity()};
    return weight_of_edges(num_pixels) * independent(each, num_pixels).A(0, 0);
  };
  EXPECT_NEAR(information_of(100, 19'200), information_of(200, 76'800), 1e-9);
}

TEST(EdgeAlignmentConfig, NamesTheFieldOutOfRange) {
  EdgeAlignmentConfig config;
  config.min_sigma_px = 0.0;
  EXPECT_THROW(config.validate(), std::invalid_argument);
  config = {};
  config.max_depth_share = 1.5;
  EXPECT_THROW(config.validate(), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::mapper
