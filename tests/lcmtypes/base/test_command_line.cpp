#include <cstdint>
#include <regex>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/base/atomic_file.hpp"
#include "lcmtypes/base/command_line.hpp"
#include "lcmtypes/base/version.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class CommandLine : public ::testing::Test {
 protected:
  CommandLine() {
    app_.add_option("--max-range", max_range_m_);
    app_.add_option_group("Edges")->add_option("--scale", scale_);
    app_.add_flag("--print-config")->configurable(false);
    add_version_flag(app_);
    add_config_flag(app_, "read options from this file");
  }

  /// What is wrong with a configuration file that has this text; empty: nothing.
  std::string error_of(const std::string& text) {
    AtomicFile file(folder_.path() / "camera.toml");
    file.stream() << text;
    file.commit();
    try {
      app_.parse("--config " + (folder_.path() / "camera.toml").string());
    } catch (const CLI::ConfigError& error) {
      return error.what();
    }
    return "";
  }

  testing::TemporaryFolder folder_;
  CLI::App app_{"A program", "/usr/bin/kintsugi-tool"};
  double max_range_m_ = 0.0;
  double scale_ = 0.0;
};

TEST_F(CommandLine, VersionIsThatOfTheProject) {
  EXPECT_TRUE(std::regex_match(version(), std::regex(R"(\d+\.\d+\.\d+)"))) << version();
  try {
    app_.parse("--version");
    FAIL() << "not the end";
  } catch (const CLI::CallForVersion& end) {
    EXPECT_EQ(end.what(), std::string("kintsugi-tool ") + version());
    EXPECT_EQ(end.get_exit_code(), 0);
  }
}

TEST_F(CommandLine, KeysOfAFileAreOptionsOfTheProgramAndOfItsGroups) {
  EXPECT_EQ(error_of("# far\nmax-range = 3\nscale=0.5\n"), "");
  EXPECT_EQ(max_range_m_, 3.0);
  EXPECT_EQ(scale_, 0.5);
}

TEST_F(CommandLine, UnknownKeysAreNamedWithTheFileAndWhatIsSpeltAlike) {
  const std::string error = error_of("max_rnge=3\nscal=5\ncolor=1\n");
  EXPECT_THAT(error, HasSubstr("camera.toml: unknown key 'max_rnge' (did you mean 'max-range'?), "
                               "unknown key 'scal' (did you mean 'scale'?), unknown key 'color'"));
  EXPECT_THAT(error, Not(HasSubstr("'color' (")));
  EXPECT_EQ(max_range_m_, 0.0);
}

TEST_F(CommandLine, WhatIsPrintedCanBeReadBack) {
  std::vector<std::uint32_t> ids;
  app_.add_option("--highlight", ids)->delimiter(',')->check(CLI::Range(1U, 9U));
  EXPECT_EQ(error_of(app_.config_to_str(true, true)), "");
  EXPECT_TRUE(ids.empty());
}

TEST_F(CommandLine, AnUnderscoreIsNotADashAndThatIsTold) {
  EXPECT_THAT(error_of("max_range=3\n"), HasSubstr("'max_range' (did you mean 'max-range'?)"));
}

TEST_F(CommandLine, WhatOnlyTheCommandLineMaySayIsUnknownInAFile) {
  EXPECT_THAT(error_of("print-config=true\n"), HasSubstr("unknown key 'print-config'"));
  EXPECT_THAT(error_of("[mapper]\nmax-range=3\n"), HasSubstr("unknown key 'mapper.max-range'"));
}

}  // namespace
}  // namespace kintsugi
