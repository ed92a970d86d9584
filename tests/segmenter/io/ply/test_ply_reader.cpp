#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <random>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segmenter/io/ply/ply_reader.hpp"
#include "tests/support/allocation_limit.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

template <typename T>
std::string bytes_of(T value, bool big_endian = false) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  if (big_endian) {
    std::reverse(bytes.begin(), bytes.end());
  }
  return bytes;
}

std::string error_of(const std::string& bytes) {
  try {
    parse_ply(bytes, "cloud.ply");
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";

std::string ascii_header(const std::string& declarations) {
  return "ply\nformat ascii 1.0\n" + declarations + "end_header\n";
}

std::string binary_header(const std::string& declarations) {
  return "ply\nformat binary_little_endian 1.0\n" + declarations + "end_header\n";
}

// Two vertices with every property we use, one we do not, an element before and faces after.
std::string full_binary_cloud(bool big_endian) {
  std::string bytes = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                      "_endian 1.0\ncomment made by a test\nobj_info nothing\n"
                      "element camera 1\nproperty double focal\n"
                      "element vertex 2\nproperty double x\nproperty double y\nproperty double z\n"
                      "property float nx\nproperty float ny\nproperty float nz\n"
                      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                      "property list uchar short tags\nproperty ushort slice_id\n"
                      "property float weight\nproperty uint segment_id\n"
                      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const auto put = [&](auto value) { bytes += bytes_of(value, big_endian); };
  put(525.0);
  for (int i = 0; i < 2; ++i) {
    put(1.5 + i), put(-2.25), put(1024.125);
    put(0.0F), put(0.0F), put(-1.0F);
    put(std::uint8_t(10)), put(std::uint8_t(20)), put(std::uint8_t(30 + i));
    put(std::uint8_t(i));
    if (i == 1) {
      put(std::int16_t(-7));
    }
    put(std::uint16_t(40000)), put(3.5F), put(std::uint32_t(4000000000U));
  }
  put(std::uint8_t(3)), put(std::int32_t(0)), put(std::int32_t(1)), put(std::int32_t(0));
  return bytes;
}

void expect_full_cloud(const PlyCloud& cloud) {
  ASSERT_EQ(cloud.points_W.size(), 2U);
  EXPECT_TRUE(cloud.has_normals);
  const CloudPoint expected{2.5F, -2.25F, 1024.125F, 0.0F, 0.0F, -1.0F, 10, 20, 31, 0, 3.5F};
  EXPECT_EQ(cloud.points_W[1], expected);
  EXPECT_EQ(cloud.slice_ids, (std::vector<std::int32_t>{40000, 40000}));
  EXPECT_EQ(cloud.segment_ids, (std::vector<std::uint32_t>{4000000000U, 4000000000U}));
}

TEST(PlyReader, ReadsBinaryOfBothByteOrders) {
  expect_full_cloud(parse_ply(full_binary_cloud(false), "little"));
  expect_full_cloud(parse_ply(full_binary_cloud(true), "big"));
}

TEST(PlyReader, ReadsAsciiWithLfAndCrlf) {
  std::string bytes = ascii_header(
      "element vertex 2\n" + kXyz +
      "property float nx\nproperty float ny\nproperty float nz\nproperty list uchar int tags\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty int slice_id\n"
      "property uint segment_id\nproperty double weight\n"
      "element face 1\nproperty list uchar int vertex_indices\n");
  bytes +=
      "1 2 3 0 0 1 0 9 9 9 1 1 1\n"
      "  2.5\t-2.25 1.024125e3 0 0 -1 2 5 6 10 20 31 40000 4000000000 +3.5 \n\n3 0 1 0\n";
  std::string crlf;
  for (const char c : bytes) {
    crlf += c == '\n' ? "\r\n" : std::string(1, c);
  }
  for (const std::string& text : {bytes, crlf}) {
    PlyCloud cloud = parse_ply(text, "ascii");
    cloud.slice_ids[0] = 40000;
    cloud.segment_ids[0] = 4000000000U;
    expect_full_cloud(cloud);
  }
}

TEST(PlyReader, ReadsColoursGivenAsFractions) {
  const auto header = ascii_header("element vertex 1\n" + kXyz +
                                   "property float red\nproperty float green\n"
                                   "property double blue\n");
  const PlyCloud cloud = parse_ply(header + "0 0 0 0 0.5 1\n", "fractions");
  EXPECT_EQ(cloud.points_W[0].red, 0);
  EXPECT_EQ(cloud.points_W[0].green, 128);
  EXPECT_EQ(cloud.points_W[0].blue, 255);
  EXPECT_FALSE(cloud.has_normals);
  EXPECT_THAT(error_of(header + "0 0 0 0 0 1.5\n"), HasSubstr("vertex 0: property 'blue' is 1.5"));
  EXPECT_THAT(error_of(header + "0 0 0 nan 0 1\n"), HasSubstr("expected 0 to 1"));
}

TEST(PlyReader, KeepsValuesThatAreNotFiniteForTheDoorToJudge) {
  const PlyCloud cloud =
      parse_ply(ascii_header("element vertex 3\nproperty double x\nproperty double y\n"
                             "property double z\n") +
                    "nan 0 0\n1e300 -1e999 1e-999\n-inf 0 0\n",
                "odd");
  EXPECT_TRUE(std::isnan(cloud.points_W[0].x));
  EXPECT_EQ(cloud.points_W[1].x, HUGE_VALF);
  EXPECT_EQ(cloud.points_W[1].y, -HUGE_VALF);
  EXPECT_EQ(cloud.points_W[1].z, 0.0F);
  EXPECT_EQ(cloud.points_W[2].x, -HUGE_VALF);
}

TEST(PlyReader, ReadsInstancesAndWhatTheCommentsSay) {
  const PlyCloud cloud =
      parse_ply(ascii_header("comment instance 7 object  a cup\ncomment\n"
                             "element vertex 1\n" +
                             kXyz + "property ushort instance_id\ncomment  last \t\n") +
                    "1 2 3 7\n",
                "cloud.ply");
  EXPECT_THAT(cloud.instance_ids, ::testing::ElementsAre(7));
  EXPECT_THAT(cloud.comments, ::testing::ElementsAre("instance 7 object  a cup", "", "last"));
  EXPECT_THAT(error_of(ascii_header("element vertex 1\n" + kXyz + "property float instance_id\n") +
                       "1 2 3 7\n"),
              HasSubstr("'instance_id' of type float, expected an integer type"));
}

TEST(PlyReader, ReadsACloudWithoutVertices) {
  EXPECT_TRUE(parse_ply(ascii_header("element vertex 0\n" + kXyz), "none").points_W.empty());
}

TEST(PlyReader, NamesLineAndExpectationOfABadHeader) {
  const std::string start = "ply\nformat ascii 1.0\n";
  EXPECT_THAT(error_of(""), AllOf(HasSubstr("cloud.ply: line 1"), HasSubstr("not a PLY file")));
  EXPECT_THAT(error_of("\x89PNG\r\n\x1a\n"), HasSubstr("not a PLY file"));
  EXPECT_THAT(error_of("ply\nformat ascii 2.0\n"), HasSubstr("line 2: expected 'format ascii"));
  EXPECT_THAT(error_of("ply\nformat binary 1.0\n"), HasSubstr("unknown format 'binary'"));
  EXPECT_THAT(error_of(start + "element vertex 1\n" + kXyz), HasSubstr("expected 'end_header'"));
  EXPECT_THAT(error_of(start + "element vertex -1\n"), HasSubstr("is '-1', expected a number"));
  EXPECT_THAT(error_of(start + "element vertex 12abc\n"), HasSubstr("expected a number"));
  EXPECT_THAT(error_of(start + "element vertex 99999999999999999999\n"),
              HasSubstr("expected a number"));
  EXPECT_THAT(error_of(start + "element vertex\n"), HasSubstr("expected 'element NAME COUNT'"));
  EXPECT_THAT(error_of(start + "property float x\n"), HasSubstr("before the first element"));
  EXPECT_THAT(error_of(start + "element vertex 1\nproperty quad x\n"),
              HasSubstr("line 4: unknown type 'quad', expected char"));
  EXPECT_THAT(error_of(start + "element vertex 1\n" + kXyz + "property float y\n"),
              HasSubstr("line 7: property 'y' of element 'vertex' is declared a second time"));
  EXPECT_THAT(error_of(start + "element vertex 1\nelement vertex 1\n"),
              HasSubstr("element 'vertex' is declared a second time"));
  EXPECT_THAT(error_of(start + "element f 1\nproperty list float int v\n"),
              HasSubstr("must have an integer type"));
  EXPECT_THAT(error_of(start + "elephant vertex 1\n"), HasSubstr("unknown keyword 'elephant'"));
}

TEST(PlyReader, NamesMissingAndUnusableProperties) {
  const auto error_with = [](const std::string& properties) {
    return error_of(ascii_header("element vertex 1\n" + properties) + "0 0 0 0 0 0\n");
  };
  EXPECT_THAT(error_of(ascii_header("element face 0\nproperty list uchar int v\n")),
              HasSubstr("no element 'vertex'"));
  EXPECT_THAT(error_with("property float x\nproperty float z\n"), HasSubstr("lacks property 'y'"));
  EXPECT_THAT(error_with("property int x\nproperty int y\nproperty int z\n"),
              HasSubstr("'x' of type int, expected float or double"));
  EXPECT_THAT(error_with(kXyz + "property float nx\n"), HasSubstr("lacks property 'ny' 'nz'"));
  EXPECT_THAT(error_with(kXyz + "property uint red\nproperty uint green\nproperty uint blue\n"),
              HasSubstr("expected uchar, or float"));
  EXPECT_THAT(error_with(kXyz + "property float slice_id\n"), HasSubstr("an integer type"));
  EXPECT_THAT(error_with(kXyz + "property list uchar int weight\n"), HasSubstr("a scalar"));
}

TEST(PlyReader, BelievesNoCountThatTheFileCannotHold) {
  const std::string row(12, '\0');
  const auto claims = [&](const std::string& count) {
    return binary_header("element vertex " + count + "\n" + kXyz) + row;
  };
  EXPECT_EQ(parse_ply(claims("1"), "one").points_W.size(), 1U);
  EXPECT_THAT(error_of(claims("2")), AllOf(HasSubstr("line 3: claims 2 rows of element 'vertex'"),
                                           HasSubstr("holds 12 bytes from byte 115")));
  EXPECT_THAT(error_of(claims("9223372036854775807")), HasSubstr("claims 9223372036854775807"));
  EXPECT_THAT(error_of(claims("0")), HasSubstr("12 bytes more than the header declares"));
  EXPECT_THAT(error_of(ascii_header("element vertex 1000000000\n" + kXyz) + "0 0 0\n"),
              HasSubstr("claims 1000000000 rows"));
  EXPECT_THAT(error_of(binary_header("element vertex 1\n" + kXyz +
                                     "element face 1000000000\nproperty list uint int v\n") +
                       row),
              HasSubstr("claims 1000000000 rows of element 'face'"));
}

TEST(PlyReader, NamesThePlaceOfBadData) {
  const auto ascii = ascii_header("element vertex 2\n" + kXyz);
  EXPECT_THAT(error_of(ascii + "0.00 0 0\n1 1\n"),
              AllOf(HasSubstr("line 9, row 1 of element 'vertex'"),
                    HasSubstr("the line ends before property 'z'")));
  EXPECT_THAT(error_of(ascii + "0 0 zero\n1 1 1\n"), HasSubstr("'z' is not a number"));
  EXPECT_THAT(error_of(ascii + "0 0 0 0\n1 1 1\n"), HasSubstr("more values than the header"));
  EXPECT_THAT(error_of(ascii + "0.00 0 0\n\n\n\n\n"), HasSubstr("the file ends here"));
  EXPECT_THAT(error_of(ascii + "0 0 0\n1 1 1\n2 2 2\n"), HasSubstr("6 bytes more"));
  const auto ids = ascii_header("element vertex 1\n" + kXyz + "property int slice_id\n");
  EXPECT_THAT(error_of(ids + "0 0 0 -3\n"), HasSubstr("vertex 0: property 'slice_id' is -3"));
  EXPECT_THAT(error_of(ids + "0 0 0 1.5\n"), HasSubstr("expected a whole number"));
  EXPECT_THAT(error_of(binary_header("element face 1\nproperty list int double v\n") +
                       bytes_of(std::int32_t{-1})),
              HasSubstr("list 'v' claims -1 entries, expected 0 to the 0"));
}

// A binary file would hold other numbers, and a list of another length than follows.
TEST(PlyReader, RefusesAsciiListsThatDoNotFitTheirTypes) {
  const auto error_with = [](const std::string& types, const std::string& face) {
    return error_of(ascii_header("element vertex 1\n" + kXyz + "element face 1\nproperty list " +
                                 types + " corners\n") +
                    "0 0 0\n" + face + "\n");
  };
  std::string corners;
  for (int i = 0; i < 300; ++i) corners += " 0";
  EXPECT_EQ(error_with("ushort int", "300" + corners), "no error");
  EXPECT_THAT(error_with("uchar int", "300" + corners),
              AllOf(HasSubstr("row 0 of element 'face': property 'corners' has '300'"),
                    HasSubstr("expected a whole number of type uchar")));
  EXPECT_THAT(error_with("uchar int", "1.5 0 0"), HasSubstr("has '1.5'"));
  EXPECT_THAT(error_with("uchar uchar", "3 0 1999 1"), HasSubstr("has '1999'"));
  EXPECT_THAT(error_with("uchar uchar", "3 0 1 -5"), HasSubstr("has '-5'"));
}

TEST(PlyReader, NamesAFileItCannotRead) {
  EXPECT_THROW(read_ply("no/such/cloud.ply"), std::runtime_error);
  EXPECT_THROW(read_ply("/"), std::runtime_error);
}

TEST(PlyReader, RefusesEveryTruncation) {
  for (const std::string& whole :
       {full_binary_cloud(false), full_binary_cloud(true),
        ascii_header("element vertex 2\n" + kXyz + "element face 1\nproperty list uchar int v\n") +
            "1 2 3\n4 5 6\n3 0 1 0"}) {
    ASSERT_NO_THROW(parse_ply(whole, "whole"));
    for (std::size_t length = 0; length < whole.size(); ++length) {
      EXPECT_THROW(parse_ply(whole.substr(0, length), "cut"), std::runtime_error) << length;
    }
  }
}

TEST(PlyReader, TakesNoMemoryForPointsThatCannotBeThere) {
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    for (const char* list : {"", "property list uint double v\n"}) {
      const std::string bytes = std::string("ply\nformat ") + format +
                                " 1.0\nelement vertex 2000000000\n" + kXyz + list + "end_header\n";
      const auto refuse = [&] {
        EXPECT_THAT(error_of(bytes), HasSubstr("claims 2000000000 rows"));
      };
      EXPECT_LT(kintsugi::testing::allocated_by(refuse), 16'384U) << format;  // header and reason
    }
  }
}

// Nothing but a clean error may come of damaged bytes; the sanitizers watch.
TEST(PlyReader, SurvivesRandomDamage) {
  std::mt19937 random(20240117);
  const std::string ascii =
      ascii_header("element vertex 2\n" + kXyz + "element face 1\nproperty list uchar int v\n") +
      "1 2 3\n4 5 6\n3 0 1 0\n";
  for (const std::string& whole : {full_binary_cloud(false), full_binary_cloud(true), ascii}) {
    int num_refused = 0;
    for (int round = 0; round < 5000; ++round) {
      std::string damaged = whole;
      for (int i = 0; i <= round % 4; ++i) {
        damaged[random() % damaged.size()] = static_cast<char>(random());
      }
      try {
        const PlyCloud cloud = parse_ply(damaged, "damaged");
        EXPECT_LE(cloud.points_W.size(), damaged.size());
      } catch (const std::runtime_error&) {
        ++num_refused;
      }
    }
    EXPECT_GT(num_refused, 1000);  // most of the bytes are header
  }
}

}  // namespace
}  // namespace kintsugi::segmenter
