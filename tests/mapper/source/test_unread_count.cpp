#include <cstdio>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/source/openni2/unread_count.hpp"

namespace kintsugi::mapper {
namespace {

using testing::HasSubstr;
using testing::Optional;

UnreadImages images(int depth, int color) {
  UnreadImages result{.depth = depth, .color = color, .last_reason = {}};
  std::snprintf(result.last_reason, sizeof(result.last_reason), "%d.png: is empty", depth + color);
  return result;
}

TEST(UnreadCount, TellsOfTheFirstImageOnly) {
  UnreadCount count;
  EXPECT_FALSE(count.update(images(0, 0)));
  EXPECT_THAT(count.update(images(1, 0)), Optional(HasSubstr("1.png: is empty")));
  EXPECT_FALSE(count.update(images(1, 0)));
  EXPECT_FALSE(count.update(images(1, 4)));
  EXPECT_EQ(count.total(), 5);
}

TEST(UnreadCount, ExplainsGapsByDepthImagesOnce) {
  UnreadCount count;
  count.update(images(3, 2));
  EXPECT_EQ(count.explain_gap(0), 0);
  EXPECT_EQ(count.explain_gap(2), 2);
  EXPECT_EQ(count.explain_gap(5), 1) << "the other four came too fast";
  EXPECT_EQ(count.explain_gap(1), 0);
}

TEST(UnreadCount, GoesOnWhenTheDeviceCountsAnew) {
  UnreadCount count;
  count.update(images(2, 0));
  count.device_closed();
  count.update(images(1, 1));
  EXPECT_EQ(count.total(), 4);
}

TEST(UnreadCount, SumsUpAtTheEnd) {
  UnreadCount count;
  EXPECT_EQ(count.summary(), "");
  count.update(images(1, 0));
  EXPECT_THAT(count.summary(), HasSubstr("1 image of the recording was"));
  count.update(images(1, 1));
  EXPECT_THAT(count.summary(), HasSubstr("2 images of the recording were"));
}

}  // namespace
}  // namespace kintsugi::mapper
