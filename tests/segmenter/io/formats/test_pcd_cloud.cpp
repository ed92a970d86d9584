#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segmenter/io/formats/pcd_cloud.hpp"
#include "tests/segmenter/io/formats/example_clouds.hpp"
#include "tests/segmenter/io/formats/expect_example.hpp"
#include "tests/segmenter/io/formats/hostile_bytes.hpp"
#include "tests/support/allocation_limit.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::names_of;
using testing::pcd_header;
using testing::value;

std::string error_in(const std::string& bytes) {
  return testing::error_of([&] { parse_pcd_cloud(bytes, "a.pcd"); });
}

const std::string kXyz = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n";

TEST(PcdCloud, ReadsBinaryAndCompressed) {
  for (const std::string& bytes : {testing::pcd_binary(), testing::pcd_compressed()}) {
    const PointTable table = parse_pcd_cloud(bytes, "a.pcd");
    EXPECT_THAT(names_of(table),
                ElementsAre("x", "y", "z", "red", "green", "blue", "pair_0", "pair_1"));
    testing::expect_example(table);
    EXPECT_EQ(value(table, 2, "pair_0"), -5.0);
    EXPECT_EQ(value(table, 2, "pair_1"), 7.0);
    EXPECT_THAT(table.comments, ElementsAre("VIEWPOINT 0 0 0 1 0 0 0"));
  }
}

TEST(PcdCloud, ReadsAsciiWithNormalsAndPackedColours) {
  // 0xFF0A14 as unsigned, and the float with these bits, as the Point Cloud Library writes it.
  const std::string fields = " normal_x normal_y normal_z ";
  const PointTable as_number =
      parse_pcd_cloud("VERSION .7\nFIELDS x y z" + fields +
                          "rgb\nSIZE 8 4 4 4 4 4 4\nTYPE F F F F F F U\n"
                          "WIDTH 1\nHEIGHT 1\nDATA ascii\n1.5 2 nan 0 0 1 16714260\n\n",
                      "a.pcd");
  EXPECT_THAT(names_of(as_number),
              ElementsAre("x", "y", "z", "nx", "ny", "nz", "red", "green", "blue"));
  EXPECT_EQ(value(as_number, 0, "x"), 1.5);
  EXPECT_TRUE(std::isnan(value(as_number, 0, "z")));
  EXPECT_EQ(value(as_number, 0, "nz"), 1.0);
  EXPECT_EQ(value(as_number, 0, "red"), 255);
  EXPECT_EQ(value(as_number, 0, "green"), 10);
  EXPECT_EQ(value(as_number, 0, "blue"), 20);
  const PointTable as_float = parse_pcd_cloud(
      "FIELDS x y z rgba\nSIZE 4 4 4 4\nTYPE F F F F\nPOINTS 1\nDATA ascii\r\n"
      "1 2 3 2.3421670e-38\r\n",
      "a.pcd");
  EXPECT_EQ(value(as_float, 0, "red"), 255);
  EXPECT_EQ(value(as_float, 0, "alpha"), 0);
}

TEST(PcdCloud, Reads64BitIntegers) {
  const PointTable table =
      parse_pcd_cloud("FIELDS x y z t\nSIZE 4 4 4 8\nTYPE F F F U\nPOINTS 1\nDATA binary\n" +
                          std::string(12, '\0') + testing::bytes_of(std::uint64_t{1} << 40U),
                      "a.pcd");
  EXPECT_EQ(value(table, 0, "t"), 1099511627776.0);
}

TEST(PcdCloud, NamesWhatIsWrong) {
  EXPECT_THAT(error_in("FIELDS x\n"), HasSubstr("line 2: the file ends inside the PCD header"));
  EXPECT_THAT(error_in("FIELDS x\nFIELDS y\n"), HasSubstr("line 2: 'FIELDS' a second time"));
  EXPECT_THAT(error_in(kXyz + "DATA ascii\n"), HasSubstr("no 'WIDTH'"));
  EXPECT_THAT(error_in(kXyz + "POINTS 1\nDATA text\n"), HasSubstr("line 5: DATA is 'text'"));
  EXPECT_THAT(error_in(kXyz + "POINTS many\nDATA ascii\n"), HasSubstr("'many', expected a number"));
  EXPECT_THAT(error_in("FIELDS x y\nSIZE 4\nTYPE F F\nPOINTS 1\nDATA ascii\n"),
              HasSubstr("line 2: 1 entries, expected 2"));
  EXPECT_THAT(error_in("FIELDS x\nSIZE 3\nTYPE F\nPOINTS 1\nDATA ascii\n"),
              HasSubstr("line 3: field 'x' has type 'F' of 3 bytes"));
  EXPECT_THAT(error_in("FIELDS x x\nSIZE 4 4\nTYPE F F\nPOINTS 1\nDATA ascii\n"),
              HasSubstr("column 'x' a second time"));
  EXPECT_THAT(error_in(kXyz + "POINTS 1\nDATA ascii\n1 2\n"),
              HasSubstr("line 6: fewer numbers than the header declares"));
  EXPECT_THAT(error_in(kXyz + "POINTS 1\nDATA ascii\n1 2 3 4\n"), HasSubstr("more numbers"));
  EXPECT_THAT(error_in(kXyz + "POINTS 1\nDATA ascii\n1 2 z\n"), HasSubstr("'z' is not a number"));
  EXPECT_THAT(error_in("FIELDS x label\nSIZE 4 1\nTYPE F U\nPOINTS 1\nDATA ascii\n1 256\n"),
              HasSubstr("line 6: '256', expected a whole number of type uchar"));
  EXPECT_THAT(error_in(kXyz + "POINTS 2\nDATA ascii\n1 2 3\n"),
              HasSubstr("claims 2 points, but 1 lines follow"));
  // The last bytes of the compressed data are missing.
  std::string cut_off = testing::pcd_compressed();
  const std::size_t header_bytes = pcd_header("binary_compressed").size();
  testing::put(cut_off, header_bytes,
               static_cast<std::uint32_t>(cut_off.size() - header_bytes - 11));
  EXPECT_THAT(error_in(cut_off), HasSubstr("the compressed data are damaged"));
}

TEST(PcdCloud, TakesNoMemoryForPointsThatCannotBeThere) {
  const std::string compressed_claim = pcd_header("binary_compressed", "100000000") +
                                       testing::bytes_of(std::uint32_t{1}) +
                                       testing::bytes_of(std::uint32_t{4'000'000'000}) + "x";
  const std::string short_data = pcd_header("binary", "4294967295") + std::string(36, '\0');
  for (const std::string& bytes : {compressed_claim, short_data}) {
    const auto refuse = [&] { EXPECT_THAT(error_in(bytes), HasSubstr("bytes follow")); };
    EXPECT_LT(kintsugi::testing::allocated_by(refuse), 16'384U);  // header and reason
  }
}

TEST(PcdCloud, SurvivesHostileBytes) {
  for (const std::string& whole : {testing::pcd_binary(), testing::pcd_compressed(),
                                   kXyz + "COUNT 1 1 1\nPOINTS 2\nDATA ascii\n1 2 3\n4 5 6\n"}) {
    testing::expect_only_clean_errors(
        whole, [](const std::string& bytes) { parse_pcd_cloud(bytes, "damaged"); });
  }
}

}  // namespace
}  // namespace kintsugi::segmenter
