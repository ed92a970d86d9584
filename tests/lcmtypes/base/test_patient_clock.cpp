#include <gtest/gtest.h>

#include "lcmtypes/base/patient_clock.hpp"

namespace kintsugi {
namespace {

TEST(PatientClock, RunsLikeTheSteadyClockWhileItIsRead) {
  double steady_s = 1'000.0;
  PatientClock clock([&] { return steady_s; });
  EXPECT_EQ(clock.now_s(), 0.0);
  for (int i = 0; i < 100; ++i) {
    steady_s += 0.25;
    EXPECT_DOUBLE_EQ(clock.now_s(), steady_s - 1'000.0);
  }
}

TEST(PatientClock, CountsAStopOfAnyLengthAsHalfASecond) {
  double steady_s = 0.0;
  PatientClock clock([&] { return steady_s; });
  steady_s = 3'600.0;
  EXPECT_DOUBLE_EQ(clock.now_s(), PatientClock::kMaxStep_s);
  steady_s += 0.1;
  EXPECT_NEAR(clock.now_s(), PatientClock::kMaxStep_s + 0.1,
              1e-9);  // after adding 3600 to a double
}

TEST(PatientClock, NeverGoesBack) {
  PatientClock clock;
  double last_s = 0.0;
  for (int i = 0; i < 1'000; ++i) {
    const double now_s = clock.now_s();
    EXPECT_GE(now_s, last_s);
    last_s = now_s;
  }
}

}  // namespace
}  // namespace kintsugi
