#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/signing/process_key.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi {
namespace {

using ::testing::HasSubstr;
using testing::TemporaryFolder;

/// What the command line says of these arguments; empty: it accepts them.
std::string parse(std::vector<std::string> arguments) {
  CLI::App app("a program");
  add_log_trust_flags(app);
  try {
    std::ranges::reverse(arguments);  // CLI11 takes a list from its end
    app.parse(std::move(arguments));
    return "";
  } catch (const CLI::ParseError& error) {
    return error.what();
  }
}

// In one test, because the command line of a process is parsed once.
TEST(ProcessKey, IsThatOfTheCommandLineElseThatOfTheEnvironment) {
  const TemporaryFolder folder;
  const std::string mine = folder / "mine.key";
  const std::string yours = folder / "yours.key";
  write_new_bus_key(mine);
  write_new_bus_key(yours);
  const auto tag_of = [](const std::shared_ptr<const BusKey>& key) { return key->tag({}); };

  unsetenv(kBusKeyVariable);
  EXPECT_EQ(bus_key(), nullptr);
  EXPECT_EQ(tag_of(bus_key(mine)), tag_of(BusKey::read(mine)));
  EXPECT_EQ(parse({}), "");
  EXPECT_EQ(bus_key(), nullptr);

  setenv(kBusKeyVariable, mine.c_str(), 1);
  EXPECT_EQ(tag_of(bus_key()), tag_of(BusKey::read(mine)));
  setenv(kBusKeyVariable, "/no/such.key", 1);
  EXPECT_THROW((void)bus_key(), std::runtime_error);
  EXPECT_THAT(parse({}), HasSubstr("--bus-key: bus key '/no/such.key' cannot be opened"));

  EXPECT_THAT(parse({"--bus-key", "/none/such.key"}),
              HasSubstr("'/none/such.key' cannot be opened"));
  EXPECT_EQ(parse({"--bus-key", yours}), "");
  EXPECT_EQ(tag_of(bus_key()), tag_of(BusKey::read(yours)));
  EXPECT_EQ(tag_of(log_trust().key), tag_of(BusKey::read(yours)));
  EXPECT_FALSE(log_trust().trusts_all);
  EXPECT_EQ(parse({"--trust-log", "--bus-key", yours}), "");
  EXPECT_TRUE(log_trust().trusts_all);

  EXPECT_EQ(parse({"--bus-key", ""}), "");  // none, whatever the environment says
  EXPECT_EQ(bus_key(), nullptr);
  unsetenv(kBusKeyVariable);
}

}  // namespace
}  // namespace kintsugi
