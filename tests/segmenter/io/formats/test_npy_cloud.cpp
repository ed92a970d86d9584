#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segmenter/io/formats/npy_cloud.hpp"
#include "tests/segmenter/io/formats/example_clouds.hpp"
#include "tests/segmenter/io/formats/expect_example.hpp"
#include "tests/segmenter/io/formats/hostile_bytes.hpp"
#include "tests/support/allocation_limit.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::AllOf;
using testing::bytes_of;
using ::testing::ElementsAre;
using testing::error_of;
using ::testing::HasSubstr;
using testing::names_of;
using testing::npy_header;
using testing::value;

std::string error_in(const std::string& bytes) {
  return error_of([&] { parse_npy_cloud(bytes, "a.npy"); });
}

TEST(NpyCloud, ReadsDoublesWithColours) {
  const PointTable table = parse_npy_cloud(testing::npy_cloud(), "a.npy");
  EXPECT_THAT(names_of(table), ElementsAre("x", "y", "z", "red", "green", "blue"));
  testing::expect_example(table);
}

TEST(NpyCloud, ReadsBothOrdersAndByteOrders) {
  // Points (1, 2, 3) and (4, 5, 6).
  std::string fortran = npy_header("<f4", "2, 3", true);
  for (const float v : {1.0F, 4.0F, 2.0F, 5.0F, 3.0F, 6.0F}) fortran += bytes_of(v);
  std::string big = npy_header(">i2", "2, 3");
  for (int v = 1; v <= 6; ++v) big += std::string(1, '\0') + static_cast<char>(v);
  std::string grid = npy_header("|u1", "1, 2, 3");  // as H x W x 3
  for (int v = 1; v <= 6; ++v) grid += static_cast<char>(v);
  for (const std::string& bytes : {fortran, big, grid}) {
    const PointTable table = parse_npy_cloud(bytes, "a.npy");
    ASSERT_EQ(table.size(), 2U);
    EXPECT_EQ(value(table, 0, "y"), 2.0);
    EXPECT_EQ(value(table, 1, "x"), 4.0);
    EXPECT_EQ(value(table, 1, "z"), 6.0);
  }
  EXPECT_EQ(parse_npy_cloud(fortran, "a").fields()[0].type, ScalarType::kFloat32);
  EXPECT_EQ(parse_npy_cloud(big, "a").fields()[0].type, ScalarType::kFloat64);
}

TEST(NpyCloud, TellsNormalsFromColours) {
  std::string normals = npy_header("<f4", "2, 6");
  for (const float v : {0.0F, 0.0F, 0.0F, 0.6F, 0.0F, -0.8F, 1.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F}) {
    normals += bytes_of(v);  // the second has none
  }
  EXPECT_THAT(names_of(parse_npy_cloud(normals, "a")),
              ElementsAre("x", "y", "z", "nx", "ny", "nz"));
  std::string fractions = npy_header("<f4", "1, 6");
  for (const float v : {0.0F, 0.0F, 0.0F, 0.5F, 0.25F, 1.0F}) fractions += bytes_of(v);
  const PointTable table = parse_npy_cloud(fractions, "a");
  EXPECT_EQ(value(table, 0, "green"), 0.25);
}

TEST(NpyCloud, NamesWhatIsWrong) {
  EXPECT_THAT(error_in(npy_header("<f8", "2, 2") + std::string(32, '\0')),
              AllOf(HasSubstr("a.npy: NPY header: its shape is ( 2 2 )"), HasSubstr("N x 3")));
  EXPECT_THAT(error_in(npy_header("<f8", "3,") + std::string(24, '\0')), HasSubstr("N x 3"));
  EXPECT_THAT(error_in(npy_header("<c16", "1, 3")), HasSubstr("its type is ''<c16'', expected"));
  EXPECT_THAT(error_in(npy_header("<f8", "2, 3") + std::string(24, '\0')),
              HasSubstr("24 bytes a row, and 24 bytes follow"));
  EXPECT_THAT(error_in(npy_header("<f8", "x, 3")), HasSubstr("its shape has 'x'"));
  EXPECT_THAT(error_in("\x93NUMPY\x01"), HasSubstr("the file ends inside it"));
}

TEST(NpyCloud, TakesNoMemoryForPointsThatCannotBeThere) {
  for (const char* shape : {"4000000000, 3", "18446744073709551615, 3", "4294967296, 4294967296, 3",
                            "3000000000, 3000000000, 3000000000, 3"}) {
    const std::string bytes = npy_header("<f8", shape);
    EXPECT_LT(kintsugi::testing::allocated_by(
                  [&] { EXPECT_THAT(error_in(bytes), HasSubstr("0 bytes follow")); }),
              16'384U);  // the shape and the reason
  }
}

TEST(NpyCloud, SurvivesHostileBytes) {
  testing::expect_only_clean_errors(
      testing::npy_cloud(), [](const std::string& bytes) { parse_npy_cloud(bytes, "damaged"); });
}

}  // namespace
}  // namespace kintsugi::segmenter
