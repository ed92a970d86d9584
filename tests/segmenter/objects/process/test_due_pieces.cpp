// When pieces of a map are tried again.

#include <cstdint>
#include <set>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/objects/process/due_pieces.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(DuePieces, AreTriedAgainOnlyWhenSomethingHasChanged) {
  DuePieces pieces;
  std::set<std::int32_t> labelled{1};
  std::vector<std::int32_t> tried;
  const auto take = [&](std::int32_t piece) {
    tried.push_back(piece);
    return labelled.contains(piece);
  };
  const auto tried_now = [&] {
    tried.clear();
    pieces.take_each(take);
    return tried;
  };
  for (const std::int32_t piece : {3, 1, 2}) pieces.add(piece);
  EXPECT_THAT(tried_now(), ElementsAre(1, 2, 3));
  EXPECT_TRUE(pieces.empty());
  EXPECT_THAT(tried_now(), IsEmpty());
  pieces.add(2);  // its points are others
  EXPECT_FALSE(pieces.empty());
  EXPECT_THAT(tried_now(), ElementsAre(2));
  labelled.insert(2);
  pieces.add(2);
  EXPECT_EQ(pieces.take_each(take), 1U);
  pieces.try_all();
  EXPECT_THAT(tried_now(), ElementsAre(3));
  pieces.try_all();
  pieces.clear();
  EXPECT_THAT(tried_now(), IsEmpty());
}

}  // namespace
}  // namespace kintsugi::segmenter
