// The built program, as a shell sees it: exit codes and messages. No device, no bus.

#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include "mapper/process/option_table.hpp"
#include "mapper/process/options.hpp"

namespace {

using ::testing::HasSubstr;

struct Outcome {
  int exit_code = -1;
  std::string text;  ///< stdout and stderr
};

Outcome run_mapper(const std::string& flags) {
  const std::filesystem::path here = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const std::string program = here.parent_path() / "bin" / "kintsugi-mapper";
  Outcome outcome;
  FILE* pipe = popen(("'" + program + "' " + flags + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return outcome;
  std::array<char, 4096> buffer{};
  for (std::size_t n = 0; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    outcome.text.append(buffer.data(), n);
  }
  outcome.exit_code = WEXITSTATUS(pclose(pipe));
  return outcome;
}

TEST(Mapper, HelpListsTheFlags) {
  const Outcome outcome = run_mapper("--help");
  EXPECT_EQ(outcome.exit_code, 0);
  kintsugi::mapper::Options options;
  for (const auto& group : kintsugi::mapper::option_table(options)) {
    EXPECT_THAT(outcome.text, HasSubstr(group.title));
    for (const auto& option : group.options) EXPECT_THAT(outcome.text, HasSubstr(option.flag()));
  }
  for (const char* flag : {"--config", "--print-config", "--list-devices"}) {
    EXPECT_THAT(outcome.text, HasSubstr(flag));
  }
}

TEST(Mapper, PrintsItsConfiguration) {
  const Outcome outcome = run_mapper("--volume-size 3 --print-config");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.text, HasSubstr("volume-size=3"));
}

TEST(Mapper, RefusesBadFlagsWithAMessage) {
  for (const auto& [flags, message] :
       {std::pair{"--no-such-flag", "--no-such-flag"}, std::pair{"--volume-size big", "big"},
        std::pair{"--volume-size -4", "--volume-size is -4"}, std::pair{"--max-frames -1", "is -1"},
        std::pair{"--trajectory /no/such/file", "/no/such/file: No such file"},
        std::pair{"--config /no/such/file", "/no/such/file"}}) {
    const Outcome outcome = run_mapper(flags);
    EXPECT_NE(outcome.exit_code, 0) << flags;
    EXPECT_THAT(outcome.text, HasSubstr(message)) << flags;
  }
}

TEST(Mapper, RefusesADeviceThatIsNotThere) {
  const Outcome outcome = run_mapper("--device folder:///no/such/folder --lcm-url memq://");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.text, HasSubstr("/no/such/folder"));
}

}  // namespace
