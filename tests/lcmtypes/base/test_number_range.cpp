#include <gmock/gmock.h>

#include "lcmtypes/base/number_range.hpp"

namespace kintsugi {
namespace {

using ::testing::HasSubstr;

TEST(NumberRange, TakesOnlyNumbersWithinItsBounds) {
  double share = 0.5;
  CLI::App app;
  app.add_option("--share", share)->check(number_range(0.001, 1.0));
  const auto error_of = [&app](const std::string& text) -> std::string {
    try {
      app.parse("--share " + text);
      return "";
    } catch (const CLI::ParseError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(error_of("1"), "");
  EXPECT_EQ(share, 1.0);
  EXPECT_THAT(error_of("nan"), HasSubstr("'nan' is no number"));
  EXPECT_THAT(error_of("1.1"), HasSubstr("not in range"));
  EXPECT_THAT(error_of("inf"), HasSubstr("not in range"));
  EXPECT_NE(error_of("much"), "");
  EXPECT_THAT(app.help(), HasSubstr("in [0.001 - 1]"));
}

TEST(FiniteNumber, IsNeitherInfiniteNorNaN) {
  double angle = 0.0;
  CLI::App app;
  app.add_option("--angle", angle)->check(finite_number());
  EXPECT_NO_THROW(app.parse("--angle -1e300"));
  EXPECT_EQ(angle, -1e300);
  for (const char* const text : {"nan", "inf", "-inf", "much"}) {
    EXPECT_THROW(app.parse(std::string("--angle ") + text), CLI::ParseError) << text;
  }
}

}  // namespace
}  // namespace kintsugi
