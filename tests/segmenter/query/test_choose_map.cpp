#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segmenter/query/choose_map.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::size_t chosen(const std::vector<MapIdentity>& maps, std::int64_t session,
                   const std::string& name) {
  SegmentQuery query;
  query.map_session = session;
  query.map_name = name;
  return choose_map(maps, query);
}

std::string refusal(const std::vector<MapIdentity>& maps, std::int64_t session,
                    const std::string& name) {
  try {
    return "chosen: " + std::to_string(chosen(maps, session, name));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

TEST(ChooseMap, TakesTheNewestOfOneName) {
  EXPECT_EQ(chosen({{5, "office"}}, 0, ""), 0U);
  EXPECT_EQ(chosen({{5, "office"}, {9, "office"}, {7, "office"}}, 0, ""), 1U);
}

TEST(ChooseMap, TakesTheOneThatIsNamed) {
  const std::vector<MapIdentity> maps{{5, "office"}, {6, "hall"}, {7, "office"}};
  EXPECT_EQ(chosen(maps, 0, "office"), 2U);
  EXPECT_EQ(chosen(maps, 0, "hall"), 1U);
  EXPECT_EQ(chosen(maps, 5, ""), 0U);
  EXPECT_EQ(chosen(maps, 5, "office"), 0U);
}

TEST(ChooseMap, SaysWhichMapsThereAre) {
  const std::vector<MapIdentity> maps{{5, "office"}, {6, "hall"}};
  EXPECT_THAT(refusal(maps, 0, ""), AllOf(HasSubstr("name one"), HasSubstr("'office' of session 5"),
                                          HasSubstr("'hall' of session 6")));
  EXPECT_THAT(refusal(maps, 0, "attic"), AllOf(HasSubstr("no map 'attic'"), HasSubstr("'hall'")));
  EXPECT_THAT(refusal(maps, 8, ""), AllOf(HasSubstr("session 8"), HasSubstr("'office'")));
  EXPECT_THAT(refusal(maps, 5, "hall"), HasSubstr("no map of session 5"));
  EXPECT_EQ(refusal({}, 0, ""), "no map is kept yet");
}

}  // namespace
}  // namespace kintsugi::segmenter
