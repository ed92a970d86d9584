// How long a detector may work.

#include <gtest/gtest.h>

#include "segmenter/objects/process/cpu_budget.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr double kMoment_s = 1e-6;

TEST(CpuBudget, BeginsWithNothing) {
  CpuBudget budget(0.1);
  EXPECT_FALSE(budget.has_some_after(1.0, 0.0));
  EXPECT_TRUE(budget.has_some_after(kMoment_s, 0.0));
}

TEST(CpuBudget, SavesABurst) {
  CpuBudget budget(0.1);
  EXPECT_TRUE(budget.has_some_after(100.0, 0.0));
  EXPECT_TRUE(budget.has_some_after(0.0, 0.8));
  EXPECT_FALSE(budget.has_some_after(0.0, 0.2));  // all is used
  EXPECT_FALSE(budget.has_some_after(0.9, 0.0));
  EXPECT_TRUE(budget.has_some_after(0.2, 0.0));
}

TEST(CpuBudget, OwesNoMoreThanABurst) {
  CpuBudget budget(0.1);
  EXPECT_FALSE(budget.has_some_after(30.0, 30.0));  // a large map came at once
  EXPECT_FALSE(budget.has_some_after(10.9, 0.0));
  EXPECT_TRUE(budget.has_some_after(0.2, 0.0));
}

// Who always has something to do uses all of the share, and at no time more.
TEST(CpuBudget, KeepsToTheShareOnAverage) {
  CpuBudget budget(0.1);
  double now_s = 0.0;
  double all_s = 0.0;
  double used_s = 0.0;
  for (int step = 0; step < 10'000; ++step) {
    const bool may_work = budget.has_some_after(0.02, used_s);
    now_s += 0.02;
    used_s = may_work ? 0.03 + 0.01 * (step % 7) : 0.0;
    all_s += used_s;
    ASSERT_LE(all_s, 0.1 * now_s + 1e-9);
  }
  EXPECT_GT(all_s, 0.1 * now_s - 0.2);
}

}  // namespace
}  // namespace kintsugi::segmenter
