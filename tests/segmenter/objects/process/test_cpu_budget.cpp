// How long a detector may work.

#include <gtest/gtest.h>

#include "segmenter/objects/process/cpu_budget.hpp"

namespace kintsugi::segmenter {
namespace {

TEST(CpuBudget, BeginsWithNothing) {
  CpuBudget budget(0.1);
  EXPECT_FALSE(budget.has_some_after(1.0, 0.2));
  EXPECT_TRUE(budget.has_some_after(2.0, 0.0));
}

TEST(CpuBudget, SavesABurst) {
  CpuBudget budget(0.1);
  EXPECT_TRUE(budget.has_some_after(100.0, 0.0));
  EXPECT_TRUE(budget.has_some_after(0.0, 0.9));
  EXPECT_FALSE(budget.has_some_after(0.0, 0.2));  // a tenth of a second too much
  EXPECT_FALSE(budget.has_some_after(0.9, 0.0));
  EXPECT_TRUE(budget.has_some_after(0.2, 0.0));
}

TEST(CpuBudget, OwesNoMoreThanABurst) {
  CpuBudget budget(0.1);
  EXPECT_FALSE(budget.has_some_after(30.0, 30.0));  // a large map came at once
  EXPECT_FALSE(budget.has_some_after(9.9, 0.0));
  EXPECT_TRUE(budget.has_some_after(0.2, 0.0));
}

}  // namespace
}  // namespace kintsugi::segmenter
