#include <gtest/gtest.h>

#include "segmenter/output/map_stem.hpp"

namespace kintsugi::segmenter {
namespace {

TEST(MapStem, NamesOtherMapsThanThePlainOne) {
  EXPECT_EQ(map_stem("map", "map"), "segments");
  EXPECT_EQ(map_stem("office-2_b", "map"), "segments_office-2_b");
  EXPECT_EQ(session_stem(map_stem("map", "map"), 5), "segments_5");
  EXPECT_EQ(session_stem(map_stem("office", "map"), 5), "segments_office_5");
}

TEST(MapStem, IsAFileNameInItsFolderWhateverTheNameIs) {
  EXPECT_EQ(map_stem("../../etc/passwd", "map"), "segments_%2E%2E%2F%2E%2E%2Fetc%2Fpasswd");
  EXPECT_EQ(map_stem(std::string("a\0b", 3), "map"), "segments_a%00b");
  EXPECT_EQ(map_stem("\xC3\xA4", "map"), "segments_%C3%A4");
  EXPECT_NE(map_stem("a%2Fb", "map"), map_stem("a/b", "map"));
}

TEST(MapStem, KeepsLongNamesApart) {
  const std::string same(1000, 'x');
  const std::string a = map_stem(same + "a", "map");
  const std::string b = map_stem(same + "b", "map");
  EXPECT_NE(a, b);
  EXPECT_LT(a.size(), 150U);
}

}  // namespace
}  // namespace kintsugi::segmenter
