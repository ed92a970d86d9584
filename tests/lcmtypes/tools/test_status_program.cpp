// kintsugi-status as a program: which options go together.

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/child_program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi {
namespace {

using ::testing::HasSubstr;
using testing::TemporaryFolder;

/// What the program says when it refuses these arguments.
std::string refusal(std::vector<std::string> arguments) {
  const TemporaryFolder folder;
  const std::string output = folder / "output.txt";
  // Where a change let it run, the test would not end.
  arguments.insert(arguments.end(), {"--lcm-url", "foo://"});
  EXPECT_GE(testing::ChildProgram(KINTSUGI_STATUS, std::move(arguments), output).wait(), 100);
  std::ostringstream text;
  text << std::ifstream(output).rdbuf();
  return text.str();
}

TEST(StatusProgram, RefusesOptionsThatWouldDoNothing) {
  EXPECT_THAT(refusal({"--timeout", "1"}), HasSubstr("--timeout requires"));
  EXPECT_THAT(refusal({"--viewer"}), HasSubstr("--viewer requires --until-finished"));
  EXPECT_THAT(refusal({"--detector", "--once"}), HasSubstr("--detector requires"));
  EXPECT_THAT(refusal({"--lingering"}), HasSubstr("--lingering requires --until-ready"));
  EXPECT_THAT(refusal({"--log-every", "1"}), HasSubstr("--log-every requires --log"));
  EXPECT_THAT(refusal({"--until-ready", "mapper", "--log", "a.csv"}), HasSubstr("excludes"));
  EXPECT_THAT(refusal({"--until-ready", "mapper", "--until-finished"}), HasSubstr("excludes"));
}

TEST(StatusProgram, TakesTheOptionsOfScripts) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--until-finished", "--viewer", "--timeout", "60", "--log",
                                 "a.csv", "--log-every=1"},
        {"--until-ready", "mapper", "--lingering", "--timeout", "5"},
        {"--once", "--timeout", "5"},
        {"--log", "a.csv"}}) {
    std::vector<std::string> with_bus = arguments;
    with_bus.insert(with_bus.end(), {"--lcm-url", "foo://"});
    EXPECT_EQ(testing::ChildProgram(KINTSUGI_STATUS, std::move(with_bus), "/dev/null").wait(), 1)
        << "the bus cannot be opened";
  }
}

}  // namespace
}  // namespace kintsugi
