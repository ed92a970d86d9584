#include <array>
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

}  // namespace
}  // namespace kintsugi
