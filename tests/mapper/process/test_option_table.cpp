// The table of options: every row is a flag, and --resume heeds the decision in it.

#include <cmath>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/process/option_table.hpp"
#include "mapper/process/options.hpp"
#include "mapper/session/resumption.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::mapper {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

static_assert(std::is_constructible_v<MapperOption, const char*, bool*, OnResume, const char*>);
static_assert(!std::is_constructible_v<MapperOption, const char*, bool*, const char*>,
              "a row without a decision for --resume must not compile");

Options default_options() {
  const char* const argv[] = {"kintsugi-mapper"};
  return std::get<Options>(parse_options(1, argv));
}

std::vector<MapperOption> rows_of(Options& options) {
  std::vector<MapperOption> rows;
  for (const OptionGroup& group : option_table(options)) {
    rows.insert(rows.end(), group.options.begin(), group.options.end());
  }
  return rows;
}

void change(const OptionValue& value) {
  const auto change_one = [](auto* v) {
    if constexpr (std::is_same_v<decltype(v), std::string*>) {
      *v += "x";
    } else if constexpr (std::is_same_v<decltype(v), bool*>) {
      *v = !*v;
    } else {
      *v += 1;
    }
  };
  std::visit(change_one, value);
}

TEST(OptionTable, ResumeRefusesAnotherValueOfEachOptionThatMustMatchAndOfNoOther) {
  const kintsugi::testing::TemporaryFolder folder;
  SessionStore::Config config;
  config.path = folder / "run.lcm";
  SessionStore(config).begin_session(7, mapping_options(default_options()));
  config.resume = true;
  Options counted = default_options();
  const std::size_t num_rows = rows_of(counted).size();
  ASSERT_GT(num_rows, 20U);
  for (std::size_t i = 0; i < num_rows; ++i) {
    Options options = default_options();
    const MapperOption row = rows_of(options).at(i);
    change(row.value());
    SessionStore store(config);
    const auto resume = [&] { Resumption(store, {.options = mapping_options(options)}); };
    if (row.on_resume() == OnResume::kMustMatch) {
      EXPECT_THAT(resume, ThrowsMessage<std::runtime_error>(
                              HasSubstr(row.flag() + " is '" + row.value_text() + "', was '")));
    } else {
      EXPECT_NO_THROW(resume()) << row.flag();
    }
  }
}

TEST(OptionTable, ChecksTheBoundsOfNumbersAndRefusesNan) {
  double value = 2.0;
  const MapperOption option("--gain", &value, OnResume::kMayDiffer, "how much", "dB", {0, 10});
  EXPECT_NO_THROW(option.check_bounds());
  EXPECT_EQ(option.help(), "how much, dB [0, 10]");
  for (const double wrong : {-0.1, 10.1, std::nan("")}) {
    value = wrong;
    EXPECT_THAT([&] { option.check_bounds(); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("must be within [0, 10]")));
  }
}

}  // namespace
}  // namespace kintsugi::mapper
