#include <gtest/gtest.h>

#include "mapper/openni2_driver/formats/text_file.hpp"

namespace kintsugi::mapper {
namespace {

TEST(ParseSeconds, KeepsEveryMicrosecond) {
  EXPECT_EQ(parse_seconds("1341836537.655691"), 1341836537655691);
  EXPECT_EQ(parse_seconds("0.033333"), 33333);
  EXPECT_EQ(parse_seconds("12"), 12'000'000);
  EXPECT_EQ(parse_seconds("12."), 12'000'000);
  EXPECT_EQ(parse_seconds("12.5"), 12'500'000);
  EXPECT_EQ(parse_seconds("0007.000001"), 7'000'001);
}

TEST(ParseSeconds, RoundsWhatIsFinerThanAMicrosecond) {
  EXPECT_EQ(parse_seconds("1.0000004"), 1'000'000);
  EXPECT_EQ(parse_seconds("1.0000005"), 1'000'001);
  EXPECT_EQ(parse_seconds("1.9999999"), 2'000'000);
}

TEST(ParseSeconds, RefusesWhatIsNotDecimalSeconds) {
  for (const char* word :
       {"", ".", ".5", "-1.0", "+1", "1e3", "1.2.3", "abc", "1.0x", "nan", "9999999999999.0"}) {
    EXPECT_EQ(parse_seconds(word), std::nullopt) << word;
  }
}

TEST(ParseNumber, TakesTheWholeWordOnly) {
  EXPECT_EQ(parse_number("-0.5"), -0.5);
  EXPECT_EQ(parse_number("+2e3"), 2000.0);
  for (const char* word : {"", "1,5", "1.0f", "inf", "nan", "1e999", "--1"}) {
    EXPECT_EQ(parse_number(word), std::nullopt) << word;
  }
}

}  // namespace
}  // namespace kintsugi::mapper
