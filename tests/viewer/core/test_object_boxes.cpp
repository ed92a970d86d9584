#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "viewer/core/drawing/palette.hpp"
#include "viewer/core/figure/object_boxes.hpp"

namespace kintsugi::viewer {
namespace {

constexpr int kWidth = 640;
constexpr int kHeight = 480;

/// At W's origin, looking along z.
VirtualCamera camera() { return {{500, 500, 319.5, 239.5, kWidth, kHeight, {}}, Pose::Identity()}; }

DrawnObject object_at(const std::string& name, double x, double y, double z, float side_m = 0.3F) {
  DrawnObject object;
  object.name = name;
  object.X_WO.translation() << x, y, z;
  object.box_min_O.setConstant(-0.5F * side_m);
  object.box_max_O.setConstant(0.5F * side_m);
  object.is_confirmed = true;
  return object;
}

std::vector<ObjectLabel> labels_of(const std::vector<DrawnObject>& objects,
                                   const std::vector<cv::Rect>& reserved = {}) {
  return place_object_labels({kWidth, kHeight}, camera(), objects, reserved);
}

TEST(ObjectBoxes, TheNameIsAtTheTopOfTheBox) {
  const auto labels = labels_of({object_at("mug", 0.0, 0.0, 2.0)});
  ASSERT_EQ(labels.size(), 1U);
  const cv::Rect& box = labels.front().box;
  const double top = 239.5 - 500 * 0.15 / 1.85;  // of the nearer side
  EXPECT_NEAR(box.x + 0.5 * box.width, 319.5, 2.0);
  EXPECT_LE(box.br().y, top);
  EXPECT_GT(box.br().y, top - box.height);
}

TEST(ObjectBoxes, WhatIsNotSeenHasNoName) {
  EXPECT_TRUE(labels_of({object_at("behind", 0.0, 0.0, -2.0)}).empty());
  EXPECT_TRUE(labels_of({object_at("beside", 5.0, 0.0, 2.0)}).empty());
  EXPECT_TRUE(labels_of({object_at("in another part", 0.0, 0.0, 1'000.0)}).empty());
  EXPECT_EQ(labels_of({object_at("around the camera", 0.0, 0.0, 0.0, 2.0F)}).size(), 1U);
}

TEST(ObjectBoxes, NamesDoNotCoverEachOtherNorWhatIsReserved) {
  std::vector<DrawnObject> crowd;
  for (int i = 0; i < 5; ++i) crowd.push_back(object_at("chair", 0.02 * i, 0.0, 2.0 + 0.1 * i));
  const cv::Rect title = labels_of({crowd.front()}).front().box;
  const auto labels = labels_of(crowd, {title});
  ASSERT_EQ(labels.size(), crowd.size());
  for (std::size_t i = 0; i < labels.size(); ++i) {
    EXPECT_EQ((labels[i].box & title).area(), 0) << i;
    EXPECT_EQ(labels[i].box & cv::Rect(0, 0, kWidth, kHeight), labels[i].box) << i;
    for (std::size_t j = 0; j < i; ++j) EXPECT_EQ((labels[i].box & labels[j].box).area(), 0);
  }
  EXPECT_EQ(labels.front().object, 0U) << "the nearest is placed first";
}

TEST(ObjectBoxes, ALineLeadsFromANameThatIsAwayFromItsBox) {
  const std::vector<DrawnObject> alone{object_at("mug", 0.0, 0.0, 2.0)};
  EXPECT_FALSE(labels_of(alone).front().middle);
  const std::vector<DrawnObject> two{alone.front(), object_at("cup", 0.1, 0.0, 2.0)};
  const std::vector<ObjectLabel> labels = labels_of(two);
  EXPECT_FALSE(labels[0].middle);
  ASSERT_TRUE(labels[1].middle);
  EXPECT_NEAR(labels[1].middle->x, 319.5 + 500 * 0.1 / 2.0, 5.0);
  EXPECT_NEAR(labels[1].middle->y, 239.5, 5.0);
  cv::Mat3b image(kHeight, kWidth, palette::kBackground);
  draw_objects(image, camera(), two, {});
  EXPECT_EQ(image(*labels[1].middle), cv::Vec3b(palette::kObject));
}

TEST(ObjectBoxes, WithoutAFreePlaceANameIsStillWritten) {
  const std::vector<cv::Rect> everything{{0, 0, kWidth, kHeight}};
  EXPECT_EQ(labels_of({object_at("mug", 0.0, 0.0, 2.0)}, everything).size(), 1U);
}

/// Lines are blended with what is below them at their edges.
int pixels_of_objects(const cv::Mat3b& image) {
  return static_cast<int>(std::ranges::count_if(
      std::vector<cv::Vec3b>(image.begin(), image.end()), [](const cv::Vec3b& pixel) {
        return pixel[0] > palette::kObject.blue / 2 && pixel[1] > palette::kObject.green / 2;
      }));
}

TEST(ObjectBoxes, ATentativeObjectIsDashed) {
  const auto drawn = [](bool is_confirmed) {
    cv::Mat3b image(kHeight, kWidth, palette::kBackground);
    DrawnObject object = object_at("x", 0.3, 0.2, 1.5, 0.6F);
    object.is_confirmed = is_confirmed;
    draw_objects(image, camera(), std::vector{object}, {});
    return pixels_of_objects(image);
  };
  EXPECT_GT(drawn(false), 100);
  EXPECT_GT(drawn(true), 3 * drawn(false) / 2);
}

}  // namespace
}  // namespace kintsugi::viewer
