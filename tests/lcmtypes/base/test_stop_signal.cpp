#include <csignal>

#include <gtest/gtest.h>

#include "lcmtypes/base/stop_signal.hpp"

namespace kintsugi {
namespace {

TEST(StopSignal, SetsFlagsThatCanBePolled) {
  install_stop_signals();
  EXPECT_FALSE(stop_requested());
  EXPECT_FALSE(take_write_request());
  std::raise(SIGUSR1);
  EXPECT_TRUE(take_write_request());
  EXPECT_FALSE(take_write_request());
  EXPECT_FALSE(stop_requested());
  std::raise(SIGTERM);
  EXPECT_TRUE(stop_requested());
}

TEST(StopSignalDeathTest, TheSecondOneEndsTheProcess) {
  EXPECT_EXIT(
      {
        install_stop_signals();
        std::raise(SIGINT);
        std::raise(SIGINT);
      },
      ::testing::KilledBySignal(SIGINT), "");
}

}  // namespace
}  // namespace kintsugi
