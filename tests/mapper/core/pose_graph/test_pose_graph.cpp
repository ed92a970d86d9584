// The optimised poses of graphs whose optimum is known in closed form.

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/core/pose_graph/pose_graph.hpp"

namespace kintsugi::mapper {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Lt;

constexpr double kSigma_m = 0.01;
constexpr double kSigma_rad = 0.01;

Matrix6d information(double sigma_m = kSigma_m, double sigma_rad = kSigma_rad) {
  Vector6d diagonal;
  diagonal << Eigen::Vector3d::Constant(1.0 / (sigma_m * sigma_m)),
      Eigen::Vector3d::Constant(1.0 / (sigma_rad * sigma_rad));
  return diagonal.asDiagonal();
}

Pose shifted(double x, double y = 0.0, double z = 0.0) {
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(x, y, z);
  return pose;
}
Pose turned(double angle_rad, const Eigen::Vector3d& axis = Eigen::Vector3d::UnitZ()) {
  return Pose(Eigen::AngleAxisd(angle_rad, axis));
}

PoseEdge edge(int from, int to, const Pose& X_FT, bool is_loop = false) {
  return {from, to, X_FT, information(), is_loop};
}

/// Nodes one after the other, all with the same step between them.
PoseGraph chain(int num_edges, const Pose& step) {
  PoseGraph graph;
  graph.X_WN.push_back(Pose::Identity());
  for (int i = 0; i < num_edges; ++i) {
    graph.X_WN.push_back(graph.X_WN.back() * step);
    graph.edges.push_back(edge(i, i + 1, step));
  }
  return graph;
}

TEST(PoseGraph, AChainWithoutLoopsStaysWhereItIs) {
  PoseGraph graph = chain(20, shifted(0.3, 0.1) * turned(0.2, {0.6, 0.0, 0.8}));
  const OptimizedPoses optimized = optimize(graph);
  EXPECT_TRUE(optimized.converged);
  for (std::size_t i = 0; i < graph.X_WN.size(); ++i) {
    EXPECT_LT(pose_error(graph.X_WN[i], optimized.X_WN[i]).norm(), 1e-9) << i;
  }
  EXPECT_THAT(optimized.error_sigmas, Each(Lt(1e-6)));
  EXPECT_THAT(optimized.contradicted, IsEmpty());
}

// The error of the loop, 1 mm, is divided equally among ten edges and the loop itself.
TEST(PoseGraph, ALoopDividesItsErrorEqually) {
  PoseGraph graph = chain(10, shifted(1.0));
  graph.edges.push_back(edge(0, 10, shifted(9.999), true));
  const OptimizedPoses optimized = optimize(graph);
  for (int i = 0; i <= 10; ++i) {
    EXPECT_NEAR(optimized.X_WN[i].translation().x(), i - i * 0.001 / 11.0, 1e-8) << i;
    EXPECT_LT(optimized.X_WN[i].translation().tail<2>().norm(), 1e-9);
  }
  EXPECT_NEAR(optimized.error_sigmas.front(), 0.001 / 11.0 / kSigma_m, 1e-6);
}

TEST(PoseGraph, AnEdgeTakesAsMuchOfTheErrorAsItsVariance) {
  PoseGraph graph = chain(2, shifted(1.0));
  graph.edges[1].information = information(3 * kSigma_m);  // nine times the variance
  graph.edges.push_back(edge(0, 2, shifted(2.0011), true));
  const OptimizedPoses optimized = optimize(graph);
  EXPECT_NEAR(optimized.X_WN[1].translation().x(), 1.0 + 0.0001, 1e-8);
  EXPECT_NEAR(optimized.X_WN[2].translation().x(), 2.0 + 0.0010, 1e-8);
}

TEST(PoseGraph, AngularErrorsAreDividedToo) {
  PoseGraph graph = chain(9, turned(0.3));
  graph.edges.push_back(edge(0, 9, turned(2.702), true));
  const OptimizedPoses optimized = optimize(graph);
  for (int i = 0; i <= 9; ++i) {
    const Vector6d error = pose_error(turned(0.3 * i + 0.0002 * i), optimized.X_WN[i]);
    EXPECT_LT(error.norm(), 1e-7) << i;
  }
}

// In a corridor the registration does not know how far the camera moved along it.
TEST(PoseGraph, WhatAnEdgeDoesNotKnowItTakesAlone) {
  PoseGraph graph = chain(4, shifted(1.0));
  graph.edges[2].information(0, 0) = 0.0;
  graph.edges.push_back(edge(0, 4, shifted(4.5), true));
  const OptimizedPoses optimized = optimize(graph);
  const std::array<double, 5> expected = {0.0, 1.0, 2.0, 3.5, 4.5};
  for (int i = 0; i <= 4; ++i) {
    EXPECT_NEAR(optimized.X_WN[i].translation().x(), expected[i], 1e-6) << i;
  }
  EXPECT_THAT(optimized.contradicted, IsEmpty());
}

// With nothing against it but a chain of n edges, a loop that is wrong by R moves the end by d with
// d (R - d) = n sigma^2 (c^2 + ((R - d) / sigma)^-2 ...), for R far above sigma: d (R - d) = n
// sigma^2 c^2, where c is the scale of the loss.
TEST(PoseGraph, AFalseLoopPullsWithABoundedForceAndIsReported) {
  constexpr int kNum = 100;
  constexpr double kWrong_m = 2.0;
  PoseGraph graph = chain(kNum, shifted(0.2));
  graph.edges.push_back(edge(0, kNum, shifted(0.2 * kNum - kWrong_m), true));
  const PoseGraphConfig config;
  const OptimizedPoses optimized = optimize(graph, config);
  const double moved_m = 0.2 * kNum - optimized.X_WN[kNum].translation().x();
  const double n_sigma2_c2 = kNum * std::pow(kSigma_m * config.loop_scale_sigmas, 2);
  const double expected_m = kWrong_m / 2 - std::sqrt(kWrong_m * kWrong_m / 4 - n_sigma2_c2);
  EXPECT_NEAR(moved_m, expected_m, 0.01 * expected_m);
  EXPECT_LT(moved_m, kSigma_m * std::sqrt(kNum)) << "the standard deviation of the chain itself";
  EXPECT_THAT(optimized.contradicted, ElementsAre(kNum));
}

/// Two rounds on a circle of 5 m, measured with noise; the second round is as uncertain as the
/// noise made it.
class TwoRounds : public ::testing::Test {
 protected:
  static constexpr int kPerRound = 60;
  std::vector<Pose> truth_;
  PoseGraph graph_;

  TwoRounds() {
    std::mt19937 random(3);
    std::normal_distribution<double> noise;
    const auto measured = [&](const Pose& X_FT) {
      Eigen::Vector3d axis(noise(random), noise(random), noise(random));
      const double angle_rad = 0.2 * kSigma_rad * axis.norm();
      return X_FT *
             shifted(kSigma_m * noise(random), kSigma_m * noise(random), kSigma_m * noise(random)) *
             turned(angle_rad, axis.normalized());
    };
    for (int i = 0; i < 2 * kPerRound; ++i) {
      truth_.push_back(turned(2 * M_PI * i / kPerRound) * shifted(5.0));
    }
    graph_.X_WN.push_back(truth_.front());
    for (int i = 0; i + 1 < 2 * kPerRound; ++i) {
      const Pose X_FT = measured(truth_[i].inverse() * truth_[i + 1]);
      graph_.edges.push_back({i, i + 1, X_FT, information(kSigma_m, 0.2 * kSigma_rad), false});
      graph_.X_WN.push_back(graph_.X_WN.back() * X_FT);
    }
    for (int i = 0; i < kPerRound; i += 4) {
      const Pose X_FT = measured(truth_[i].inverse() * truth_[i + kPerRound]);
      graph_.edges.push_back(
          {i, i + kPerRound, X_FT, information(kSigma_m, 0.2 * kSigma_rad), true});
    }
  }
  double rms_m(const std::vector<Pose>& X_WN) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < truth_.size(); ++i) {
      sum += (X_WN[i].translation() - truth_[i].translation()).squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(truth_.size()));
  }
};

TEST_F(TwoRounds, LoopsTakeTheDriftAway) {
  const OptimizedPoses optimized = optimize(graph_);
  EXPECT_TRUE(optimized.converged);
  EXPECT_LT(rms_m(optimized.X_WN), 0.6 * rms_m(graph_.X_WN));
  EXPECT_THAT(optimized.contradicted, IsEmpty());
}

TEST_F(TwoRounds, AFalseLoopAmongRightOnesDoesLittleHarmAndIsTheOnlyOneReported) {
  const OptimizedPoses right = optimize(graph_);
  graph_.edges.push_back({10, 40, Pose::Identity(), information(), true});  // 10 m apart
  const OptimizedPoses optimized = optimize(graph_);
  EXPECT_THAT(optimized.contradicted, ElementsAre(static_cast<int>(graph_.edges.size()) - 1));
  for (std::size_t i = 0; i < truth_.size(); ++i) {
    const double moved_m = (optimized.X_WN[i].translation() - right.X_WN[i].translation()).norm();
    EXPECT_LT(moved_m, 0.02) << i;
  }
}

TEST_F(TwoRounds, TheSameGraphGivesTheSameBits) {
  const OptimizedPoses first = optimize(graph_);
  const OptimizedPoses second = optimize(graph_);
  for (std::size_t i = 0; i < truth_.size(); ++i) {
    EXPECT_EQ(first.X_WN[i].matrix(), second.X_WN[i].matrix()) << i;
  }
}

TEST_F(TwoRounds, TheFirstNodeNeverMoves) {
  EXPECT_EQ(optimize(graph_).X_WN.front().matrix(), graph_.X_WN.front().matrix());
}

TEST_F(TwoRounds, FixedNodesNeverMoveAndTheOthersDo) {
  graph_.fixed = {3};
  const OptimizedPoses optimized = optimize(graph_);
  EXPECT_EQ(optimized.X_WN[3].matrix(), graph_.X_WN[3].matrix());
  EXPECT_FALSE(optimized.X_WN.front().isApprox(graph_.X_WN.front(), 1e-6));
}

TEST_F(TwoRounds, TooFewIterationsAreSaid) {
  const OptimizedPoses optimized = optimize(graph_, {.max_iterations = 1});
  EXPECT_FALSE(optimized.converged);
  EXPECT_EQ(optimized.num_iterations, 1);
}

TEST(PoseGraph, NothingIsOptimisedAtOnce) { EXPECT_TRUE(optimize({}).X_WN.empty()); }

TEST(PoseGraph, RefusesEdgesThatCannotBe) {
  const auto refused = [](auto change) {
    PoseGraph graph = chain(3, shifted(1.0));
    change(graph);
    try {
      optimize(graph);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_THAT(refused([](PoseGraph& g) { g.edges[1].to = 4; }), HasSubstr("edge 1 is at node 4"));
  EXPECT_THAT(refused([](PoseGraph& g) { g.edges[1].from = -1; }), HasSubstr("node -1"));
  EXPECT_THAT(refused([](PoseGraph& g) { g.edges[2].to = 2; }), HasSubstr("to itself"));
  EXPECT_THAT(refused([](PoseGraph& g) { g.edges[0].information(0, 1) = 5.0; }),
              HasSubstr("symmetric"));
  EXPECT_THAT(refused([](PoseGraph& g) { g.edges[0].information(3, 3) = -1.0; }),
              HasSubstr("eigenvalue"));
  EXPECT_THAT(refused([](PoseGraph& g) { g.edges[0].X_FT.translation().x() = NAN; }),
              HasSubstr("edge 0 has a pose"));
  EXPECT_THAT(refused([](PoseGraph& g) { g.X_WN[2].translation().x() = INFINITY; }),
              HasSubstr("node 2"));
  EXPECT_THAT(refused([](PoseGraph& g) { g.fixed = {0, 7}; }), HasSubstr("fixed is at node 7"));
}

}  // namespace
}  // namespace kintsugi::mapper
