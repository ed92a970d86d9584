// Maps of one place are put one on the other; maps of other places are refused.

#include <vector>

#include <gmock/gmock.h>

#include "segmenter/objects/maps/align_maps.hpp"
#include "tests/segmenter/objects/toy_room.hpp"

namespace kintsugi::segmenter {
namespace {

using testing::furnished_room;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::observe;
using testing::ToyRoom;
using testing::walk_through;

void expect_aligned(const AlignmentResult& result, const Pose& X_AB) {
  ASSERT_TRUE(result.alignment) << result.refusal;
  EXPECT_THAT(result.refusal, IsEmpty());
  const Pose error = X_AB.inverse(Eigen::Isometry) * result.alignment->X_AB;
  EXPECT_LT(error.translation().norm(), 0.01);
  EXPECT_LT(Eigen::AngleAxisd(error.linear()).angle(), 0.003);
  EXPECT_LT(result.alignment->rms_m, 0.01);
  EXPECT_LT(result.alignment->sigma_m, 0.01);
  EXPECT_GT(result.alignment->agreement, 0.8);
}

TEST(AlignMaps, OfTheSameBeginning) {
  const ToyRoom room = furnished_room();
  const ObservedMap map = observe(room, walk_through(room));
  expect_aligned(align_maps(map, map), Pose::Identity());
}

TEST(AlignMaps, ThatBeginAnywhereInAnotherLightWithThingsChanged) {
  const ToyRoom room = furnished_room();
  ToyRoom later = room;
  later.boxes[3].center_S.x() -= 0.4;
  later.boxes.push_back({.center_S = {1.6, 1.2, 0.85}, .size_m = {0.2, 0.3, 0.2}});
  const ObservedMap before = observe(room, walk_through(room));
  for (const double phase_rad : {0.7, 4.1}) {
    const std::vector<Pose> path = walk_through(later, phase_rad, 26);
    ObservedMap after = observe(later, path);
    testing::relight(after, 0.7, 0.8, 1.1);
    const Pose X_AB = path.front().inverse(Eigen::Isometry) * walk_through(room).front();
    expect_aligned(align_maps(before, after), X_AB);
    expect_aligned(align_maps(after, before), X_AB.inverse(Eigen::Isometry));
  }
}

TEST(AlignMaps, OfWhichOneIsAPartOfTheOther) {
  const ToyRoom room = furnished_room();
  std::vector<Pose> path = walk_through(room, 1.0);
  path.resize(14);
  const AlignmentResult result = align_maps(observe(room, path), observe(room, walk_through(room)));
  expect_aligned(result, walk_through(room).front().inverse(Eigen::Isometry) * path.front());
}

TEST(AlignMaps, WithoutViewsByShapeAlone) {
  const ToyRoom room = furnished_room();
  ObservedMap before = observe(room, walk_through(room));
  ObservedMap after = observe(room, walk_through(room, 2.0));
  before.views.clear();
  after.views.clear();
  expect_aligned(
      align_maps(before, after),
      walk_through(room, 2.0).front().inverse(Eigen::Isometry) * walk_through(room).front());
}

TEST(AlignMaps, OfOtherRoomsAreRefused) {
  const ToyRoom room = furnished_room();
  ToyRoom other;
  other.size_m = {5.5, 2.6, 2.6};
  other.boxes = {{.center_S = {2.7, 1.3, 0.45}, .size_m = {2.0, 1.0, 0.9}},
                 {.center_S = {5.2, 0.5, 1.0}, .size_m = {0.6, 1.0, 2.0}}};
  const AlignmentResult result =
      align_maps(observe(room, walk_through(room)), observe(other, walk_through(other, 1.0)));
  EXPECT_FALSE(result.alignment);
  EXPECT_THAT(result.refusal, HasSubstr("the maps do not fit"));
}

TEST(AlignMaps, ThatFitInTwoWaysAreRefused) {
  ToyRoom bare;  // the same from both sides
  for (Eigen::Vector3i& color : bare.colors) color = {200, 200, 200};
  const AlignmentResult result =
      align_maps(observe(bare, walk_through(bare)), observe(bare, walk_through(bare, 1.0)));
  EXPECT_FALSE(result.alignment);
  EXPECT_THAT(result.refusal, HasSubstr("two places"));
  // With walls of different colours there is one way.
  bare.colors[0] = {200, 60, 60};
  bare.colors[1] = {60, 160, 60};
  expect_aligned(
      align_maps(observe(bare, walk_through(bare)), observe(bare, walk_through(bare, 1.0))),
      walk_through(bare, 1.0).front().inverse(Eigen::Isometry) * walk_through(bare).front());
}

TEST(AlignMaps, WithoutSurfaceAreRefused) {
  const ToyRoom room = furnished_room();
  ObservedMap empty;
  empty.resolution_m = 0.02F;
  EXPECT_FALSE(align_maps(empty, observe(room, walk_through(room))).alignment);
  EXPECT_FALSE(align_maps(observe(room, walk_through(room)), empty).alignment);
}

}  // namespace
}  // namespace kintsugi::segmenter
