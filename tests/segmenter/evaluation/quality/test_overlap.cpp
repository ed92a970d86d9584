// Overlap of segments with true instances: closed forms, and the definitions read out word by word.

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/messages.hpp"
#include "segmenter/evaluation/quality/overlap.hpp"

namespace kintsugi::segmenter {
namespace {

using Labels = std::vector<std::uint32_t>;

// Sums of integers divided once or twice: only the last bits may differ.
constexpr double kRounding = 1e-12;

/// Runs of equal labels.
Labels runs(const std::vector<std::pair<std::uint32_t, int>>& label_and_count) {
  Labels labels;
  for (const auto& [label, count] : label_and_count) {
    labels.insert(labels.end(), static_cast<std::size_t>(count), label);
  }
  return labels;
}

TEST(QualityOverlap, TheTruthItselfIsPerfectWhateverItsSegmentsAreCalled) {
  const auto table =
      overlap_table(runs({{1, 30}, {2, 50}, {7, 20}}), runs({{90, 30}, {4, 50}, {UINT32_MAX, 20}}));
  ASSERT_EQ(table.instances.size(), 3U);
  for (const InstanceScore& score : table.instances) EXPECT_EQ(score.best_iou, 1.0);
  EXPECT_EQ(table.instances[2].instance, 7U);
  EXPECT_EQ(table.instances[2].best_segment, UINT32_MAX);
  EXPECT_EQ(achievable_accuracy(table), 1.0);
  EXPECT_EQ(undersegmentation_error(table), 0.0);
}

TEST(QualityOverlap, HalvesOfAnInstanceHaveHalfItsIouAndLeakNowhere) {
  const auto table = overlap_table(runs({{1, 100}}), runs({{5, 50}, {3, 50}}));
  EXPECT_EQ(table.instances[0].best_iou, 0.5);
  EXPECT_EQ(table.instances[0].best_segment, 3U);
  EXPECT_EQ(achievable_accuracy(table), 1.0);
  EXPECT_EQ(undersegmentation_error(table), 0.0);
}

TEST(QualityOverlap, ACupThatMeltsIntoItsTableCountsOnceForEach) {
  // One segment over a table of 900 points and a cup of 100.
  const auto table = overlap_table(runs({{1, 900}, {2, 100}}), runs({{1, 1000}}));
  EXPECT_NEAR(table.instances[0].best_iou, 0.9, kRounding);
  EXPECT_NEAR(table.instances[1].best_iou, 0.1, kRounding);
  EXPECT_NEAR(achievable_accuracy(table), 0.9, kRounding);
  EXPECT_NEAR(undersegmentation_error(table), 0.2, kRounding);
}

TEST(QualityOverlap, PointsWithoutInstanceAreNobodys) {
  const auto table = overlap_table(runs({{1, 40}, {kNoInstance, 60}}), runs({{8, 100}}));
  EXPECT_EQ(table.num_points, 40);
  ASSERT_EQ(table.overlaps.size(), 1U);
  EXPECT_EQ(table.overlaps[0].segment_size, 40);
  EXPECT_EQ(table.instances[0].best_iou, 1.0);
}

TEST(QualityOverlap, PointsWithoutSegmentAreLost) {
  const auto table =
      overlap_table(runs({{1, 100}, {2, 10}}), runs({{kNoSegment, 25}, {6, 75}, {kNoSegment, 10}}));
  EXPECT_EQ(table.instances[0].best_iou, 0.75);
  EXPECT_EQ(table.instances[1].best_iou, 0.0);
  EXPECT_EQ(table.instances[1].num_points, 10);
  EXPECT_EQ(table.instances[1].best_segment, kNoSegment);
  EXPECT_NEAR(achievable_accuracy(table), 75.0 / 110.0, kRounding);
  EXPECT_EQ(undersegmentation_error(table), 0.0);
}

TEST(QualityOverlap, NothingScoresNothing) {
  const auto table = overlap_table(Labels{}, Labels{});
  EXPECT_TRUE(table.instances.empty());
  EXPECT_EQ(achievable_accuracy(table), 0.0);
  EXPECT_EQ(undersegmentation_error(table), 0.0);
  EXPECT_THROW(overlap_table(Labels{1}, Labels{}), std::invalid_argument);
}

/// As the definitions stand, over sets of points.
struct SlowTruth {
  std::map<std::uint32_t, std::set<int>> instances;
  std::map<std::uint32_t, std::set<int>> segments;
  double num_points = 0.0;

  SlowTruth(const Labels& of_instances, const Labels& of_segments) {
    for (int i = 0; i < static_cast<int>(of_instances.size()); ++i) {
      const auto index = static_cast<std::size_t>(i);
      if (of_instances[index] == kNoInstance) continue;
      ++num_points;
      instances[of_instances[index]].insert(i);
      if (of_segments[index] != kNoSegment) segments[of_segments[index]].insert(i);
    }
  }

  static double shared(const std::set<int>& a, const std::set<int>& b) {
    return static_cast<double>(std::ranges::count_if(a, [&](int i) { return b.contains(i); }));
  }

  double best_iou(std::uint32_t instance) const {
    double best = 0.0;
    const std::set<int>& g = instances.at(instance);
    for (const auto& [label, s] : segments) {
      std::set<int> both = g;
      both.insert(s.begin(), s.end());
      best = std::max(best, shared(g, s) / static_cast<double>(both.size()));
    }
    return best;
  }

  double achievable() const {
    double right = 0.0;
    for (const auto& [label, s] : segments) {
      double most = 0.0;
      for (const auto& [instance, g] : instances) most = std::max(most, shared(s, g));
      right += most;
    }
    return right / num_points;
  }

  double undersegmentation() const {
    double error = 0.0;
    for (const auto& [instance, g] : instances) {
      for (const auto& [label, s] : segments) {
        const double inside = shared(s, g);
        error += std::min(inside, static_cast<double>(s.size()) - inside);
      }
    }
    return error / num_points;
  }
};

TEST(QualityOverlap, RandomLabellingsScoreAsTheDefinitionsSay) {
  std::mt19937 generator(3);
  for (int trial = 0; trial < 50; ++trial) {
    const auto num_points = 1 + generator() % 200;
    const auto num_labels = 1 + generator() % 12;
    Labels instances;
    Labels segments;
    for (std::size_t i = 0; i < num_points; ++i) {
      instances.push_back(static_cast<std::uint32_t>(generator() % num_labels));  // 0 among them
      const bool follows = generator() % 3 != 0;
      segments.push_back(follows ? 3 * instances.back()
                                 : static_cast<std::uint32_t>(generator() % 6));
    }
    const SlowTruth slow(instances, segments);
    if (slow.num_points == 0.0) continue;
    const auto table = overlap_table(instances, segments);
    ASSERT_EQ(table.instances.size(), slow.instances.size());
    for (const InstanceScore& score : table.instances) {
      EXPECT_NEAR(score.best_iou, slow.best_iou(score.instance), kRounding);
      EXPECT_EQ(score.num_points, std::ssize(slow.instances.at(score.instance)));
    }
    EXPECT_NEAR(achievable_accuracy(table), slow.achievable(), kRounding);
    EXPECT_NEAR(undersegmentation_error(table), slow.undersegmentation(), kRounding);
    EXPECT_LE(undersegmentation_error(table), 2.0 * (1.0 - achievable_accuracy(table)) + kRounding);
  }
}

}  // namespace
}  // namespace kintsugi::segmenter
