#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segmenter/io/formats/text_cloud.hpp"
#include "tests/segmenter/io/formats/expect_example.hpp"
#include "tests/segmenter/io/formats/hostile_bytes.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::names_of;
using testing::value;

PointTable parse(const std::string& text) { return parse_text_cloud(text, "a.txt"); }

std::string error_in(const std::string& text) {
  return testing::error_of([&] { parse(text); });
}

const std::string kExample =
    "691000.125 5334000.5 512.75 255 0 1\n691000.25 5334001.5 512.875 10 20 30\n"
    "691000.375 5334002.5 -1 0 0 0\n";

TEST(TextCloud, ReadsColumnsBetweenBlanksTabsCommasAndSemicolons) {
  for (const char* separator : {" ", "  ", "\t", ",", ", ", ";"}) {
    for (const char* end : {"\n", "\r\n", " \n"}) {
      std::string text;
      for (const char c : kExample) {
        if (c == ' ') {
          text += separator;
        } else if (c == '\n') {
          text += end;
        } else {
          text += c;
        }
      }
      testing::expect_example(parse(text));
      testing::expect_example(parse("# a comment\n\n// another\n" + text));
    }
  }
  testing::expect_example(parse("\xEF\xBB\xBF" + kExample));  // byte order mark
  testing::expect_example(parse(kExample.substr(0, kExample.size() - 1)));
}

TEST(TextCloud, ReadsTheCountOfPts) {
  testing::expect_example(parse("3\n" + kExample));
  EXPECT_EQ(parse("1\n1 2 3\n2\n4 5 6\n7 8 9\n").size(), 3U);  // two scans
  EXPECT_THAT(error_in("4\n" + kExample), HasSubstr("line 1: tells 4 points, but 3 lines"));
  EXPECT_THAT(error_in("2\n" + kExample), HasSubstr("line 1: tells 2 points, but 3 lines"));
  EXPECT_THAT(error_in("1 2 3\n5\n"), HasSubstr("line 2: one number, expected 3"));
}

TEST(TextCloud, GuessesColumnsByTheirValues) {
  EXPECT_THAT(names_of(parse("1 2 3\n")), ElementsAre("x", "y", "z"));
  EXPECT_THAT(names_of(parse("1 2 3 -700\n")), ElementsAre("x", "y", "z", "intensity"));
  EXPECT_THAT(names_of(parse("1 2 3 -700 1 255 0\n")),
              ElementsAre("x", "y", "z", "intensity", "red", "green", "blue"));
  EXPECT_THAT(names_of(parse("1 2 3 1 255 0 0.6 0 -0.8\n")),
              ElementsAre("x", "y", "z", "red", "green", "blue", "nx", "ny", "nz"));
  EXPECT_THAT(names_of(parse("1 2 3 0.6 0 -0.8 1 255 0\n")),
              ElementsAre("x", "y", "z", "nx", "ny", "nz", "red", "green", "blue"));
  EXPECT_THAT(names_of(parse("1 2 3 7 8\n")), ElementsAre("x", "y", "z", "intensity", "scalar_2"));
  EXPECT_THAT(names_of(parse("1 2 3 700 800 900\n")),
              ElementsAre("x", "y", "z", "scalar_1", "scalar_2", "scalar_3"));
}

TEST(TextCloud, ReadsNamesOfColumns) {
  const PointTable csv =
      parse("Point Source,X,Y,Z,\"R\",G,B,Label\n7,1,2,3,10,20,30,4\n8,1,2,,0,0,255,5\n");
  EXPECT_THAT(names_of(csv),
              ElementsAre("Point_Source", "x", "y", "z", "red", "green", "blue", "Label"));
  EXPECT_EQ(value(csv, 1, "blue"), 255);
  EXPECT_TRUE(std::isnan(value(csv, 1, "z")));
  EXPECT_EQ(value(csv, 1, "Label"), 5);
  // CloudCompare begins with a comment and a count.
  EXPECT_THAT(names_of(parse("//X Y Z R G B Nx Ny Nz\n1\n1 2 3 4 5 6 0 0 1\n")),
              ElementsAre("x", "y", "z", "red", "green", "blue", "nx", "ny", "nz"));
  EXPECT_THAT(names_of(parse("x y z a a\n1 2 3 4 5\n")), ElementsAre("x", "y", "z", "a", "a_2"));
}

TEST(TextCloud, ReadsAnEmptyLastPlaceWhereAColumnIs) {
  const PointTable csv = parse("x,y,z,label\n1,2,3,4\n5,6,7,\n8,9,10,11,\n");
  EXPECT_TRUE(std::isnan(value(csv, 1, "label")));
  EXPECT_EQ(value(csv, 2, "label"), 11);
  EXPECT_TRUE(std::isnan(value(parse("x;y;z;label;\n1;2;3;;\n"), 0, "label")));
  EXPECT_TRUE(std::isnan(value(parse("1,2,3\n4,5,\n"), 1, "z")));
  EXPECT_THAT(names_of(parse("1,2,3,\n4,5,6,\n")), ElementsAre("x", "y", "z"));
  EXPECT_THAT(error_in("1,2,3,4\n5,6,\n"), HasSubstr("line 2: 2 numbers, expected 4"));
}

TEST(TextCloud, LeavesCommentsBehindNumbersOut) {
  EXPECT_EQ(value(parse("2 # points\n1 2 3 # first\n4 5 6\t// x, y; z\n"), 1, "z"), 6);
  EXPECT_EQ(value(parse("1,2,3 # x,y,z\n4,5,6,  // last\n"), 1, "z"), 6);
  EXPECT_THAT(names_of(parse("Point #,x,y,z\n1,2,3,4\n")), ElementsAre("Point_", "x", "y", "z"));
  EXPECT_THAT(error_in("1 2 3#4\n"), HasSubstr("'3#4' is not a number"));
}

TEST(TextCloud, ReadsNumbersInQuotes) {
  const PointTable csv = parse("\"x\",\"y\",\"z\"\n\"1\",\"2.5\", \" 3 \"\n4,\"\",5\n");
  EXPECT_EQ(value(csv, 0, "y"), 2.5);
  EXPECT_EQ(value(csv, 0, "z"), 3);
  EXPECT_TRUE(std::isnan(value(csv, 1, "y")));
  EXPECT_EQ(value(parse("\"1\" \"2\" \"3\"\n"), 0, "x"), 1);
  EXPECT_THAT(error_in("1,2,3\n4,5,\"tree\"\n"), HasSubstr("'tree' is not a number"));
}

TEST(TextCloud, NamesLineAndExpectation) {
  EXPECT_THAT(error_in(""), HasSubstr("a.txt: line 0: no line of numbers"));
  EXPECT_THAT(error_in("1 2\n"), HasSubstr("line 1: 2 numbers, expected x y z"));
  EXPECT_THAT(error_in("1 2 3\n4 5\n"), HasSubstr("line 2: 2 numbers, expected 3"));
  EXPECT_THAT(error_in("1 2 3\n4 5 six\n"), HasSubstr("line 2: 'six' is not a number"));
  EXPECT_THAT(error_in("solid a\n"), HasSubstr("line 1: begins with 'solid'"));
  EXPECT_THAT(error_in("x y z\n1 2 3 4\n"),
              HasSubstr("line 2: 4 numbers, expected 3, as line 1 names columns"));
  EXPECT_THAT(error_in("lat lon height\n1 2 3\n"), HasSubstr("with x, y and z"));
}

TEST(TextCloud, SurvivesHostileBytes) {
  for (const std::string& whole : {"3\n" + kExample, std::string("a,x,y,z\n1,2,3,4\n5,6,7,8\n")}) {
    testing::expect_only_clean_errors(whole, [](const std::string& bytes) { parse(bytes); });
  }
}

}  // namespace
}  // namespace kintsugi::segmenter
