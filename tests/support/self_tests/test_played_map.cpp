#include <gmock/gmock.h>

#include "lcmtypes/codec/codec.hpp"
#include "tests/support/message_equality.hpp"
#include "tests/support/played_map.hpp"

namespace kintsugi::testing {
namespace {

const PlayedMap& small_map() {
  static const PlayedMap map(
      {.session = 7, .map_name = "played", .num_points = 30'000, .slice_points = 8'000});
  return map;
}

TEST(PlayedMap, IsASessionWithOneFinalSliceAtItsEnd) {
  const PlayedMap& map = small_map();
  std::size_t num_points = 0;
  std::int64_t utime = 0;
  ASSERT_GE(map.num_slices(), 2);
  for (std::int32_t id = 0; id < map.num_slices(); ++id) {
    const CloudSlice slice = map.slice(id);
    EXPECT_EQ(slice.id, id);
    EXPECT_EQ(slice.session, 7);
    EXPECT_EQ(slice.map_name, "played");
    EXPECT_EQ(slice.kind == SliceKind::kFinal, id + 1 == map.num_slices());
    EXPECT_GT(slice.utime, utime);
    utime = slice.utime;
    num_points += slice.points_W.size();
    EXPECT_GE(num_chunks(slice, kDefaultMaxChunkBytes), 1) << "not fit to be published";
    if (slice.kind != SliceKind::kFinal) {
      EXPECT_GE(slice.points_W.size(), 8'000U);
    }
  }
  EXPECT_GE(num_points, 30'000U);
}

TEST(PlayedMap, TakesEveryOtherCorrectionBack) {
  const CloudSlice published = small_map().slice(1);
  const CloudSlice moved = small_map().slice(1, 1);
  CloudSlice taken_back = small_map().slice(1, 2);
  EXPECT_EQ(moved.revision, 1);
  EXPECT_NEAR(moved.points_W[0].x - published.points_W[0].x, 0.01, 1e-6);
  taken_back.revision = 0;
  EXPECT_EQ(taken_back, published);
}

TEST(PlayedMap, IsTheSameForTheSameSeed) {
  const PlayedMap again(
      {.session = 7, .map_name = "played", .num_points = 30'000, .slice_points = 8'000});
  EXPECT_EQ(again.slice(0), small_map().slice(0));
}

}  // namespace
}  // namespace kintsugi::testing
