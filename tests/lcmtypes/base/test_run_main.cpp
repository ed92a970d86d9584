#include <array>
#include <iostream>
#include <stdexcept>

#include <gtest/gtest.h>

#include "lcmtypes/base/run_main.hpp"

namespace kintsugi {
namespace {

constexpr std::array<const char*, 2> kArguments{"/usr/bin/kintsugi-tool", nullptr};

TEST(RunMain, ReturnsTheExitCodeOfTheProgram) {
  EXPECT_EQ(run_main(kArguments.data(), [] { return 3; }), 3);
}

TEST(RunMain, WritesAnExceptionWithTheProgramsNameToStderr) {
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(run_main(kArguments.data(), []() -> int { throw std::runtime_error("no file x"); }), 1);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "kintsugi-tool: no file x\n");
}

TEST(RunMain, FailsWhereTheOutputIsNotWritten) {
  ::testing::internal::CaptureStderr();
  const int exit_code = run_main(kArguments.data(), [] {
    std::cout.setstate(std::ios::badbit);  // as on a full disk
    return 0;
  });
  std::cout.clear();
  EXPECT_EQ(exit_code, 1);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(),
            "kintsugi-tool: standard output cannot be written\n");
}

}  // namespace
}  // namespace kintsugi
