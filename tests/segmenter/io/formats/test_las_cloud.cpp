#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segmenter/io/formats/las_cloud.hpp"
#include "tests/segmenter/io/formats/example_clouds.hpp"
#include "tests/segmenter/io/formats/expect_example.hpp"
#include "tests/segmenter/io/formats/hostile_bytes.hpp"
#include "tests/support/allocation_limit.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::las_cloud;
using testing::put;
using testing::value;

std::string error_in(const std::string& bytes) {
  return testing::error_of([&] { parse_las_cloud(bytes, "a.las"); });
}

TEST(LasCloud, ReadsEveryPointFormat) {
  for (unsigned format = 0; format <= 10; ++format) {
    const PointTable table = parse_las_cloud(las_cloud(format), "a.las");
    testing::expect_example(table);
    EXPECT_EQ(table.find("red").has_value(), testing::kLasColorOffset.at(format) > 0) << format;
    EXPECT_EQ(table.find("gps_time").has_value(), format != 0 && format != 2) << format;
    EXPECT_EQ(table.find("nir").has_value(), format == 8 || format == 10) << format;
    EXPECT_EQ(value(table, 1, "intensity"), 1234);
    EXPECT_EQ(value(table, 1, "classification"), 6);
  }
}

TEST(LasCloud, TakesColoursOfEightBitsAsTheyAre) {
  std::string bytes = las_cloud(2);
  for (std::size_t point = 0; point < 3; ++point) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const std::size_t at = 227 + point * 28 + 20 + 2 * channel;
      put(bytes, at, static_cast<std::uint16_t>(100 + channel));
    }
  }
  EXPECT_EQ(value(parse_las_cloud(bytes, "a.las"), 0, "blue"), 102);
}

TEST(LasCloud, NamesWhatIsWrong) {
  std::string compressed = las_cloud(3);
  put(compressed, 104, std::uint8_t{0x83});
  EXPECT_THAT(error_in(compressed),
              AllOf(HasSubstr("a.las: byte 104"), HasSubstr("compressed (LAZ)")));
  std::string unknown = las_cloud(3);
  put(unknown, 104, std::uint8_t{11});
  EXPECT_THAT(error_in(unknown), HasSubstr("point format 11, expected 0 to 10"));
  std::string small = las_cloud(3);
  put(small, 105, std::uint16_t{20});
  EXPECT_THAT(error_in(small), HasSubstr("points of 20 bytes, expected at least 34"));
  EXPECT_THAT(error_in("LASF"), HasSubstr("the file ends inside the LAS header"));
  EXPECT_THAT(error_in("LAS"), HasSubstr("not a LAS file"));
}

TEST(LasCloud, TakesNoMemoryForPointsThatCannotBeThere) {
  std::string many = las_cloud(0);
  put(many, 107, std::uint32_t{4'000'000'000});
  std::string many_64 = las_cloud(6);
  put(many_64, 247, std::uint64_t{1} << 63U);
  std::string far = las_cloud(0);
  put(far, 96, std::uint32_t{4'000'000'000});
  for (const std::string& bytes : {many, many_64, far}) {
    const auto refuse = [&] { EXPECT_THAT(error_in(bytes), HasSubstr("bytes follow")); };
    EXPECT_LT(kintsugi::testing::allocated_by(refuse), 16'384U);  // header and reason
  }
}

TEST(LasCloud, SurvivesHostileBytes) {
  for (const unsigned format : {3U, 7U}) {
    testing::expect_only_clean_errors(
        las_cloud(format), [](const std::string& bytes) { parse_las_cloud(bytes, "damaged"); });
  }
}

}  // namespace
}  // namespace kintsugi::segmenter
