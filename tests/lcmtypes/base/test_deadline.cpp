#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "lcmtypes/base/deadline.hpp"

namespace kintsugi {
namespace {

using Seconds = std::chrono::duration<double>;

Seconds left_of(double timeout_s) {
  const auto deadline = deadline_after(Seconds(timeout_s));
  return deadline - std::chrono::steady_clock::now();
}

TEST(Deadline, IsAfterTheTimeout) {
  EXPECT_LE(left_of(0.0), Seconds(0.0));
  EXPECT_LE(left_of(1000.0), Seconds(1000.0));
  EXPECT_GT(left_of(1000.0), Seconds(900.0));
}

TEST(Deadline, OfAnEndlessTimeoutDoesNotComeSoon) {
  for (const double timeout_s : {1e10, 1e300, std::numeric_limits<double>::infinity()}) {
    EXPECT_GT(left_of(timeout_s), std::chrono::days(300));
  }
}

TEST(Deadline, RefusesATimeoutThatIsNegativeOrNoNumber) {
  EXPECT_THROW((void)left_of(-1e-9), std::invalid_argument);
  EXPECT_THROW((void)left_of(std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi
