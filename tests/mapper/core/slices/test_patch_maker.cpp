#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/core/slices/patch_maker.hpp"

namespace kintsugi::mapper {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr TileCoord kHere{.z = 0, .y = 0, .x = 0};
constexpr TileCoord kThere{.z = 0, .y = 0, .x = 1};

/// Tiles of one block. Each block (x, 0, 0) has a point for each of `weights`.
struct Patches : ::testing::Test {
  static ExtractedSurface surface(const std::vector<std::pair<int, std::vector<float>>>& blocks) {
    ExtractedSurface surface;
    for (const auto& [x, weights] : blocks) {
      surface.blocks.push_back(
          {make_block_coord(x, 0, 0), surface.points_W.size(), weights.size()});
      for (const float weight : weights) surface.points_W.emplace_back().weight = weight;
    }
    return surface;
  }
  static std::vector<float> weights(const CloudSlice& slice) {
    std::vector<float> weights;
    for (const CloudPoint& point : slice.points_W) weights.push_back(point.weight);
    return weights;
  }
  static CloudSlice header() {
    CloudSlice header;
    header.utime = 77;
    header.resolution_m = 0.01F;
    return header;
  }

  PatchMaker maker{TileGrid(0.08, 0.01)};
};

TEST_F(Patches, AreNumberedInTheOrderInWhichTheyGetPoints) {
  const auto first = maker.make({{{kHere}, {kThere}}}, surface({{1, {5}}}), header());
  ASSERT_EQ(first.size(), 1U) << "a patch that never had points is left out";
  EXPECT_EQ(first[0].id, 0);
  EXPECT_EQ(first[0].revision, 0);
  EXPECT_EQ(first[0].kind, SliceKind::kPatch);
  EXPECT_EQ(first[0].utime, 77);
  EXPECT_TRUE(first[0].in_volume);
  EXPECT_TRUE(first[0].ends_batch);

  const auto second = maker.make({{{kHere}, {kThere}}}, surface({{0, {6, 7}}}), header());
  ASSERT_EQ(second.size(), 2U);
  EXPECT_EQ(second[0].id, 1);
  EXPECT_FALSE(second[0].ends_batch);
  EXPECT_EQ(second[1].id, 0) << "its surface went: a revision without points";
  EXPECT_EQ(second[1].revision, 1);
  EXPECT_THAT(second[1].points_W, IsEmpty());
  EXPECT_TRUE(second[1].ends_batch);
}

TEST_F(Patches, HaveWhatLeftAndThenWhatIsInTheVolume) {
  maker.make({{{kHere}}}, surface({{0, {1, 2}}}), header());
  maker.keep(surface({{0, {3}}, {1, {4}}}));
  const auto slices = maker.make({{{kHere}}}, surface({{0, {5}}}), header());
  ASSERT_EQ(slices.size(), 1U);
  EXPECT_THAT(weights(slices[0]), ElementsAre(3, 5));
}

TEST_F(Patches, ThatHaveLeftForGoodAreOtherPatchesWhenTheVolumeComesBack) {
  maker.make({{{kHere}}}, surface({{0, {1}}}), header());
  maker.keep(surface({{0, {2}}}));
  const auto slices = maker.make({{{kHere, false}, {kHere, true}}}, surface({{0, {3}}}), header());
  ASSERT_EQ(slices.size(), 2U);
  EXPECT_FALSE(slices[0].in_volume);
  EXPECT_EQ(slices[0].id, 0);
  EXPECT_THAT(weights(slices[0]), ElementsAre(2));
  EXPECT_EQ(slices[1].id, 1);
  EXPECT_EQ(slices[1].revision, 0);
  EXPECT_THAT(weights(slices[1]), ElementsAre(3));
}

TEST_F(Patches, GoOnWhenTheirBlocksComeBack) {
  maker.make({{{kHere}}}, surface({{0, {1}}}), header());
  const int before = maker.keep(surface({{0, {2}}})).front().patch;
  maker.make({{{kHere, false}}}, {}, header());
  maker.reopen(std::vector<TileVisit>{{kHere, 0}}, header());
  EXPECT_FALSE(maker.place_of(before).has_value()) << "what was kept of it counts no more";
  const auto slices = maker.make({{{kHere}}}, surface({{0, {3}}}), header());
  ASSERT_EQ(slices.size(), 1U);
  EXPECT_EQ(slices[0].id, 0) << "the same patch";
  EXPECT_EQ(slices[0].revision, 2);
  EXPECT_TRUE(slices[0].in_volume);
  EXPECT_THAT(weights(slices[0]), ElementsAre(3));

  const int after = maker.keep(surface({{0, {4}}})).front().patch;
  EXPECT_NE(after, before);
  EXPECT_TRUE(maker.place_of(after).has_value());
  const auto last = maker.finish(header());
  EXPECT_THAT(weights(last[0]), ElementsAre(4));
  EXPECT_EQ(last[0].revision, 3);
  EXPECT_EQ(last.back().revision_sum, 3);
}

TEST_F(Patches, GoOnWhenPartOfAnOpenOneComesBack) {
  maker.make({{{kHere}}}, surface({{0, {1}}}), header());
  const int before = maker.keep(surface({{0, {2}}})).front().patch;
  maker.reopen(std::vector<TileVisit>{{kHere}}, header());
  EXPECT_FALSE(maker.place_of(before).has_value());
  const auto slices = maker.make({{{kHere}}}, surface({{0, {3}}}), header());
  EXPECT_EQ(slices.at(0).id, 0);
  EXPECT_EQ(slices.at(0).revision, 1);
  EXPECT_THAT(weights(slices[0]), ElementsAre(3)) << "not what had left, too";
}

TEST_F(Patches, AreToldApartByTheVisit) {
  for (const float weight : {1.0F, 2.0F}) {
    maker.make({{{kHere}}}, surface({{0, {weight}}}), header());
    maker.make({{{kHere, false}}}, {}, header());
  }
  maker.reopen(std::vector<TileVisit>{{kHere, 0}}, header());
  EXPECT_EQ(maker.make({{{kHere}}}, surface({{0, {5}}}), header()).at(0).id, 0);
  maker.make({{{kHere, false}}}, {}, header());
  maker.reopen(std::vector<TileVisit>{{kHere, 1}}, header());
  EXPECT_EQ(maker.make({{{kHere}}}, surface({{0, {5}}}), header()).at(0).id, 1);
}

TEST_F(Patches, EndWhereAnEarlierOneGoesOn) {
  maker.make({{{kHere}}}, surface({{0, {1}}}), header());
  maker.make({{{kHere, false}}}, {}, header());
  maker.make({{{kHere}}}, surface({{0, {2}}}), header());
  const auto ended = maker.reopen(std::vector<TileVisit>{{kHere, 0}}, header());
  ASSERT_EQ(ended.size(), 1U);
  EXPECT_EQ(ended[0].id, 1);
  EXPECT_EQ(ended[0].revision, 1);
  EXPECT_THAT(ended[0].points_W, IsEmpty());
  EXPECT_FALSE(ended[0].in_volume);
  EXPECT_TRUE(ended[0].ends_batch);
  EXPECT_EQ(maker.make({{{kHere}}}, surface({{0, {5}}}), header()).at(0).id, 0);
}

TEST_F(Patches, AreForgottenWhenTheyHaveEnded) {
  maker.make({{{kHere}}}, surface({{0, {1}}}), header());
  maker.make({{{kHere, false}}}, {}, header());
  const std::size_t num_placed = maker.num_placed();
  for (int round = 0; round < 20; ++round) {
    maker.make({{{kHere}}}, surface({{0, {2}}}), header());
    maker.reopen(std::vector<TileVisit>{{kHere, round}}, header());
    maker.reopen(std::vector<TileVisit>{{kHere}}, header());
    EXPECT_EQ(maker.make({{{kHere, false}}}, {}, header()).at(0).id, 0);
    EXPECT_EQ(maker.num_placed(), num_placed);
  }
}

TEST_F(Patches, AreForgottenWhenTheyDepartWithoutPoints) {
  for (int round = 0; round < 20; ++round) {
    maker.make({{{kHere, false}}}, {}, header());
    EXPECT_EQ(maker.num_placed(), 0U);
    maker.reopen(std::vector<TileVisit>{{kHere, 2 * round}}, header());
    EXPECT_THAT(maker.make({{{kHere, false}}}, {}, header()), IsEmpty());
  }
  maker.reopen(std::vector<TileVisit>{{kHere, 39}}, header());
  EXPECT_EQ(maker.make({{{kHere}}}, surface({{0, {1}}}), header()).at(0).id, 0);
}

TEST_F(Patches, WithVerticesButNoPointsStay) {
  maker.make({{{kHere}}}, {}, header());
  MeshPiece piece;
  piece.vertices.push_back({.x = 0.01F});
  const int patch = maker.patches_of(piece, 0.01).at(0).patch;
  maker.make({{{kHere, false}}}, {}, header());
  EXPECT_TRUE(maker.place_of(patch).has_value());
}

TEST_F(Patches, EndWithTheirLastRevisionsAndTheirSum) {
  maker.make({{{kHere}}}, surface({{0, {1}}}), header());
  maker.make({{{kHere}, {kThere}}}, surface({{0, {1}}, {1, {2}}}), header());
  maker.keep(surface({{0, {8}}, {1, {9}}, {5, {10}}}));
  const auto slices = maker.finish(header());
  ASSERT_EQ(slices.size(), 4U);
  EXPECT_THAT(weights(slices[0]), ElementsAre(8));
  EXPECT_EQ(slices[0].revision, 2);
  EXPECT_THAT(weights(slices[1]), ElementsAre(9));
  EXPECT_EQ(slices[1].revision, 1);
  EXPECT_THAT(weights(slices[2]), ElementsAre(10)) << "never sent before";
  EXPECT_TRUE(slices[2].ends_batch);
  EXPECT_FALSE(slices[2].in_volume);
  EXPECT_EQ(slices[3].kind, SliceKind::kFinal);
  EXPECT_EQ(slices[3].id, 3);
  EXPECT_THAT(slices[3].points_W, IsEmpty());
  EXPECT_EQ(slices[3].revision_sum, 3);
}

TEST_F(Patches, EndInBatchesOfRisingTimes) {
  constexpr int kTiles = 4;
  const std::vector<float> many(20'000, 1.0F);
  for (int tile = 0; tile < kTiles; ++tile) maker.keep(surface({{4 * tile, many}}));
  const auto slices = maker.finish(header());
  ASSERT_EQ(slices.size(), kTiles + 1U);
  const std::int64_t utime = header().utime;
  const std::vector<std::int64_t> later_us = {0, 0, 1, 1, 1};
  const std::vector<bool> ends = {false, true, false, true, false};
  for (std::size_t i = 0; i < slices.size(); ++i) {
    EXPECT_EQ(slices[i].utime - utime, later_us[i]) << i;
    EXPECT_EQ(slices[i].ends_batch, ends[i]) << i;
  }
  EXPECT_EQ(slices.back().kind, SliceKind::kFinal);
}

MapDeformation correction(int number, double y0, double y1, int part0 = 0, int part1 = 0) {
  std::vector<MapDeformation::Place> places = {{.part = part0}, {.part = part1}};
  places[0].X_WU.translation().y() = y0;
  places[1].X_WU.translation().y() = y1;
  return {number, places};
}

TEST_F(Patches, MoveWithTheKeyframesAtWhichTheyWereSeen) {
  maker.make({{{kHere, true, 0}, {kThere, true, 1}}}, surface({{0, {1}}, {1, {2}}}), header());
  const auto first = maker.correct(correction(1, 0.0, 0.02), header());
  ASSERT_EQ(first.size(), 1U);
  EXPECT_EQ(first[0].kind, SliceKind::kCorrection);
  EXPECT_EQ(first[0].id, 2) << "numbered like the other slices";
  EXPECT_EQ(first[0].correction, 1);
  EXPECT_TRUE(first[0].ends_batch);
  EXPECT_THAT(first[0].points_W, IsEmpty());
  ASSERT_EQ(first[0].motions.size(), 1U) << "the other one does not move";
  EXPECT_EQ(first[0].motions[0].id, 1);
  EXPECT_FLOAT_EQ(first[0].motions[0].X_WP.t_WP[1], 0.02F);

  const auto revised = maker.make({{{kHere, true, 1, correction(1, 0.0, 0.02).place(1)}}},
                                  surface({{0, {3}}}), header());
  EXPECT_EQ(revised[0].correction, 1);
  EXPECT_FLOAT_EQ(revised[0].X_WP.t_WP[1], 0.02F) << "seen again, at the later keyframe";
}

TEST_F(Patches, MoveAlsoAfterTheyHaveLeftForGood) {
  maker.make({{{kHere, true, 0}}}, surface({{0, {1}}}), header());
  maker.keep(surface({{0, {2}}}));
  maker.make({{{kHere, false, 0}}}, {}, header());
  const auto slices = maker.correct(correction(1, 0.02, 0.0), header());
  ASSERT_EQ(slices.size(), 1U);
  ASSERT_EQ(slices[0].motions.size(), 1U);
  EXPECT_EQ(slices[0].motions[0].id, 0);
}

TEST_F(Patches, MoveAlsoBeforeTheyAreSent) {
  maker.keep(surface({{0, {1}}}), {.keyframe = 0, .place = correction(1, 0.0, 0.0, 1, 1).place(0)});
  EXPECT_THAT(maker.correct(correction(1, 0.02, 0.0), header()), IsEmpty());
  const auto slices = maker.finish(header());
  ASSERT_EQ(slices.size(), 2U);
  EXPECT_FLOAT_EQ(slices[0].X_WP.t_WP[1], 0.02F);
  EXPECT_EQ(slices[0].part, 0);
}

TEST_F(Patches, AreInThePartOfTheMapOfTheirKeyframe) {
  const auto seen = [](int keyframe, int part) {
    return correction(1, 0.01, 0.02, 0, part).place(keyframe);
  };
  const auto slices = maker.make({{{kHere, true, 0, seen(0, 1)}, {kThere, true, 1, seen(1, 1)}}},
                                 surface({{0, {1}}, {1, {2}}}), header());
  EXPECT_EQ(slices[0].part, 0);
  EXPECT_EQ(slices[1].part, 1);
  const auto apart = maker.correct(correction(2, 0.03, 0.04, 0, 1), header());
  ASSERT_EQ(apart.size(), 2U) << "a correction is of one part";
  for (const int part : {0, 1}) {
    EXPECT_EQ(apart[part].part, part);
    ASSERT_EQ(apart[part].motions.size(), 1U);
    EXPECT_EQ(apart[part].motions[0].id, part);
  }
  const auto joined = maker.correct(correction(3, 0.03, 0.06, 0, 0), header());
  ASSERT_EQ(joined.size(), 1U);
  EXPECT_EQ(joined[0].part, 0);
  EXPECT_EQ(joined[0].motions[0].id, 1);
}

TEST_F(Patches, AreCorrectedWithTheLoopsOfTheirPart) {
  const LoopLink here{.later = 5, .earlier = 1};
  const LoopLink elsewhere{.later = 9, .earlier = 8};
  maker.make({{{kHere, true, 0}}}, surface({{0, {1}}}), header());
  MapDeformation::Place moved;
  moved.X_WU.translation().x() = 0.5;
  const MapDeformation deformation(1, {moved},
                                   {{.part = 0, .link = here}, {.part = 1, .link = elsewhere}});
  const auto slices = maker.correct(deformation, header());
  ASSERT_EQ(slices.size(), 1U);
  EXPECT_EQ(slices[0].loops, (std::vector{here}));
}

/// A patch of a guest, whose map is 1,000 m away from this one in U, with a point for each weight.
GuestPatch guest_patch(std::int32_t id, const SeenAt& at, const std::vector<float>& weights) {
  GuestPatch patch{.name = {.session = 8, .id = id}, .at = at, .in_volume = true};
  patch.X_UP = Eigen::Translation3d(1'000.0, 0.0, 0.0);
  for (const float weight : weights) patch.points_P.emplace_back().weight = weight;
  return patch;
}

TEST_F(Patches, OfGuestsAreNumberedWithTheOthers) {
  maker.make({{{kHere}}}, surface({{0, {1}}}), header());
  const SeenAt at{.keyframe = 1, .place = correction(1, 0.0, 0.0, 0, 3).place(1)};
  const auto taken =
      maker.take_in({guest_patch(70, at, {5, 6}), guest_patch(40, at, {7})}, header());
  ASSERT_EQ(taken.size(), 2U);
  EXPECT_EQ(taken[0].kind, SliceKind::kPatch);
  EXPECT_EQ(taken[0].id, 1);
  EXPECT_EQ(taken[1].id, 2);
  EXPECT_EQ(taken[0].keyframe, -1) << "not of this mapper's camera";
  EXPECT_EQ(taken[0].part, 3);
  EXPECT_FLOAT_EQ(taken[0].X_WP.t_WP[0], 1'000.0F);
  EXPECT_THAT(weights(taken[0]), ElementsAre(5, 6));
  EXPECT_TRUE(taken[0].in_volume);
  EXPECT_FALSE(taken[0].ends_batch);
  EXPECT_TRUE(taken[1].ends_batch);

  const auto revised = maker.take_in({guest_patch(70, at, {8})}, header());
  ASSERT_EQ(revised.size(), 1U);
  EXPECT_EQ(revised[0].id, 1);
  EXPECT_EQ(revised[0].revision, 1);
  const auto ended = maker.finish(header());
  EXPECT_EQ(ended.back().id, 3);
  EXPECT_EQ(ended.back().revision_sum, 2) << "the last one of this map, and that of the guest";
}

TEST_F(Patches, OfGuestsAreSentWithoutWhatThisMapHas) {
  PatchMaker common(TileGrid(0.08, 0.01),
                    CommonSurface::Config{.same = {}, .resolution_m = 0.01, .keeps_own = false});
  const auto at = [](float x, float weight) {
    CloudPoint p;
    p.x = x;
    p.nz = 1.0F;
    p.weight = weight;
    return p;
  };
  const auto own = [&](const std::vector<CloudPoint>& points) {
    ExtractedSurface surface;
    surface.blocks.push_back({make_block_coord(0, 0, 0), 0, points.size()});
    surface.points_W = points;
    return surface;
  };
  const auto header_at = [](std::int64_t utime) {
    CloudSlice header = Patches::header();
    header.utime = utime;
    return header;
  };
  common.make({{{kHere}}}, own({at(0.01F, 7)}), header_at(1));
  GuestPatch guest{.name = {.session = 8, .id = 70}, .at = {}, .in_volume = true};
  guest.points_P = {at(0.01F, 4), at(0.04F, 5), at(0.07F, 6)};
  const auto taken = common.take_in({guest}, header_at(2));
  ASSERT_EQ(taken.size(), 1U);
  EXPECT_THAT(weights(taken[0]), ElementsAre(5, 6));

  // A point of three is little, which waits until the end.
  const auto little =
      common.make({{{kHere}}}, own({at(0.01F, 7), at(0.04F, 7)}), header_at(2'000'000));
  ASSERT_EQ(little.size(), 1U);
  const auto more = own({at(0.041F, 7), at(0.07F, 7)});
  const auto soon = common.make({{{kHere}}}, more, header_at(2'100'000));
  EXPECT_EQ(soon.size(), 1U) << "they were looked at a tenth of a second ago";
  const auto later = common.make({{{kHere}}}, more, header_at(3'000'000));
  ASSERT_EQ(later.size(), 2U);
  EXPECT_FALSE(later[0].ends_batch);
  EXPECT_TRUE(later[1].ends_batch);
  EXPECT_EQ(later[1].id, taken[0].id);
  EXPECT_EQ(later[1].revision, 1);
  EXPECT_EQ(later[1].keyframe, -1);
  EXPECT_TRUE(later[1].in_volume);
  EXPECT_THAT(weights(later[1]), ElementsAre(4));

  common.make({{{kHere}}}, own({at(0.01F, 7), at(0.04F, 7), at(0.07F, 7)}), header_at(3'000'001));
  const auto ended = common.finish(header_at(3'000'002));
  ASSERT_EQ(ended.size(), 3U) << "this map's patch, which departs, the guest's, and the last slice";
  EXPECT_EQ(ended[1].id, taken[0].id);
  EXPECT_THAT(ended[1].points_W, ::testing::SizeIs(3)) << "this map's patch ended without points";
  EXPECT_TRUE(ended[1].ends_batch);
  EXPECT_EQ(ended.back().kind, SliceKind::kFinal);
}

TEST_F(Patches, AreSentWithoutWhatAGuestHasSeenBetter) {
  PatchMaker common(TileGrid(0.08, 0.01),
                    CommonSurface::Config{.same = {}, .resolution_m = 0.01, .keeps_own = false});
  ExtractedSurface mine = surface({{0, {5, 6}}});
  mine.points_W[0].nz = 1.0F;
  mine.points_W[1].nx = 1.0F;
  const auto batch = [](bool in_volume) { return PatchBatch{{{kHere, in_volume, 0}}}; };
  common.make(batch(true), mine, header());
  common.keep(mine);
  const auto closed = common.make(batch(false), {}, header());
  EXPECT_THAT(weights(closed.at(0)), ElementsAre(5, 6));

  GuestPatch guest{.name = {.session = 8, .id = 70}, .at = {}, .in_volume = true};
  guest.points_P.emplace_back().weight = 50;
  guest.points_P[0].nz = 1.0F;
  EXPECT_THAT(weights(common.take_in({guest}, header()).at(0)), ElementsAre(50));
  const auto ended = common.finish(header());
  ASSERT_EQ(ended.size(), 2U);
  EXPECT_EQ(ended[0].id, closed[0].id) << "also a patch that has left the volume";
  EXPECT_EQ(ended[0].revision, 2);
  EXPECT_EQ(ended[0].keyframe, 0);
  EXPECT_FALSE(ended[0].in_volume);
  EXPECT_THAT(weights(ended[0]), ElementsAre(6)) << "the normal of the other one differs";
  EXPECT_EQ(ended[1].revision_sum, 2);
}

TEST_F(Patches, OfGuestsMoveWithTheirKeyframes) {
  const SeenAt at{.keyframe = 1, .place = correction(1, 0.0, 0.0, 0, 1).place(1)};
  maker.take_in({guest_patch(70, at, {5})}, header());
  MapDeformation::Place joined;  // a quarter turn, and beside part 0
  joined.X_WU = Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitZ()) *
                Eigen::Translation3d(-1'000.0, 0.0, 0.0);
  const auto slices = maker.correct({1, {{}, joined}}, header());
  ASSERT_EQ(slices.size(), 1U);
  EXPECT_EQ(slices[0].part, 0);
  ASSERT_EQ(slices[0].motions.size(), 1U);
  const Pose X_WP = slices[0].motions[0].X_WP.pose();
  EXPECT_LT(X_WP.translation().norm(), 1e-6) << "the guest's map begins where this one does";
  EXPECT_NEAR((X_WP * Eigen::Vector3d::UnitX()).y(), 1.0, 1e-6);
}

TEST_F(Patches, OfATenthOfAVoxelStayUntilItIsMore) {
  maker.make({{{kHere, true, 0}}}, surface({{0, {1}}}), header());
  EXPECT_THAT(maker.correct(correction(1, 0.0009, 0.0), header()), IsEmpty());
  EXPECT_THAT(maker.correct(correction(2, 0.0018, 0.0), header()), ::testing::SizeIs(1))
      << "measured from where it was sent to";
}

TEST_F(Patches, TellWhichOfThemThePointsAndVerticesThatLeftAreOf) {
  maker.make({{{kHere, true, 0}, {kThere, true, 1}}}, surface({{0, {1}}, {1, {2}}}), header());
  maker.correct(correction(1, 0.01, 0.02), header());
  const auto runs = maker.keep(surface({{0, {1, 1}}, {1, {2}}}));
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs[0].num_points, 2U);
  EXPECT_FLOAT_EQ(maker.place_of(runs[0].patch)->X_WP.t_WP[1], 0.01F);
  EXPECT_FLOAT_EQ(maker.place_of(runs[1].patch)->X_WP.t_WP[1], 0.02F);

  MeshPiece piece;
  for (const float x : {0.01F, 0.07F, 0.09F, 5.0F}) piece.vertices.push_back({.x = x});
  const auto of_vertices = maker.patches_of(piece, 0.01);
  ASSERT_EQ(of_vertices.size(), 3U);
  EXPECT_EQ(of_vertices[0].num_points, 2U);
  EXPECT_EQ(of_vertices[0].patch, runs[0].patch);
  EXPECT_EQ(of_vertices[1].patch, runs[1].patch);
  EXPECT_EQ(of_vertices[2].patch, kNoPatch);
}

}  // namespace
}  // namespace kintsugi::mapper
