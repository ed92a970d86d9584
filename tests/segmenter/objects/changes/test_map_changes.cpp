// What has come, gone and moved in a room of boxes.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "segmenter/objects/changes/change_files.hpp"
#include "segmenter/objects/changes/map_changes.hpp"
#include "tests/segmenter/objects/toy_room.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter {
namespace {

using testing::Box;
using ::testing::ElementsAre;
using testing::furnished_room;
using ::testing::IsEmpty;
using testing::observe;
using testing::ToyRoom;
using testing::walk_through;

/// Of a room that is walked through twice, on other paths.
struct Twice {
  std::vector<Pose> path_before;
  std::vector<Pose> path_after;
  ObservedMap before;
  ObservedMap after;
  Pose X_AB;

  Twice(const ToyRoom& was, const ToyRoom& is)
      : path_before(walk_through(was)),
        path_after(walk_through(is, 0.5, 28)),
        before(observe(was, path_before)),
        after(observe(is, path_after)),
        X_AB(path_after.front().inverse(Eigen::Isometry) * path_before.front()) {}

  [[nodiscard]] MapChanges changes() const { return find_changes(before, after, X_AB); }
  /// A place of the room in AFTER's W.
  [[nodiscard]] Eigen::Vector3d in_after(const Eigen::Vector3d& p_S) const {
    return path_after.front().inverse(Eigen::Isometry) * p_S;
  }
};

Eigen::Vector3d center_of(const MapChange& change) {
  Eigen::AlignedBox3d box;
  for (const CloudPoint& p : change.points()) box.extend(Eigen::Vector3d(p.x, p.y, p.z));
  return box.center();
}

const Box kOnTable{.center_S = {1.6, 1.2, 0.9}, .size_m = {0.3, 0.2, 0.3}, .color = {40, 160, 60}};
const Box kOnBench{.center_S = {2.7, 2.75, 0.6}, .size_m = {0.24, 0.3, 0.2}};

TEST(MapChanges, OfAnUnchangedRoomThereAreNone) {
  const ToyRoom room = furnished_room();
  const MapChanges result = Twice(room, room).changes();
  EXPECT_THAT(result.changes, IsEmpty());
}

TEST(MapChanges, ErrorsOfTheAlignmentUpToAVoxelAreNone) {
  const ToyRoom room = furnished_room();
  Twice twice(room, room);
  for (const Eigen::Vector3d& shift :
       {Eigen::Vector3d(0.02, 0, 0), Eigen::Vector3d(0, -0.02, 0), Eigen::Vector3d(0, 0, 0.02)}) {
    Pose X_AB = twice.X_AB;
    X_AB.pretranslate(shift);
    EXPECT_THAT(find_changes(twice.before, twice.after, X_AB).changes, IsEmpty())
        << shift.transpose();
  }
}

/// The farther along the room, the higher is the map, by up to 7 cm.
void bend(ObservedMap& map, const Pose& X_SW) {
  const Eigen::Vector3f up_W = X_SW.linear().transpose().col(2).cast<float>();
  for (CloudPoint& p : map.points_W) {
    const double x_m = (X_SW * Eigen::Vector3d(p.x, p.y, p.z)).x();
    const auto higher_m = static_cast<float>(0.07 * x_m / 4.0);
    p.x += higher_m * up_W.x();
    p.y += higher_m * up_W.y();
    p.z += higher_m * up_W.z();
  }
}

/// One part of the room was mapped with a third of the exposure of the other.
void darken_a_part(ObservedMap& map, const Pose& X_SW) {
  for (CloudPoint& p : map.points_W) {
    if ((X_SW * Eigen::Vector3d(p.x, p.y, p.z)).x() > 1.4) continue;
    for (std::uint8_t* const channel : {&p.red, &p.green, &p.blue}) *channel /= 3;
  }
}

TEST(MapChanges, WhatABentMapIsOffAllOverIsNone) {
  const ToyRoom was = furnished_room();
  Twice twice(was, was);
  bend(twice.before, twice.path_before.front());
  EXPECT_THAT(twice.changes().changes, IsEmpty());
  ToyRoom is = was;
  is.boxes.push_back(kOnTable);
  twice = Twice(was, is);
  bend(twice.before, twice.path_before.front());
  const MapChanges result = twice.changes();
  ASSERT_EQ(result.changes.size(), 1U)
      << "what is larger than the maps' errors is told all the same";
  EXPECT_THAT(result.changes[0].after_segments, ElementsAre(11));
}

TEST(MapChanges, ExposureThatWasSetAnewIsNone) {
  const ToyRoom room = furnished_room();
  Twice twice(room, room);
  darken_a_part(twice.before, twice.path_before.front());
  EXPECT_THAT(twice.changes().changes, IsEmpty());
}

TEST(MapChanges, AThingThatCame) {
  const ToyRoom was = furnished_room();
  ToyRoom is = was;
  is.boxes.push_back(kOnTable);
  const Twice twice(was, is);
  const MapChanges result = twice.changes();
  ASSERT_EQ(result.changes.size(), 1U);
  const MapChange& change = result.changes[0];
  EXPECT_EQ(change.kind, ChangeKind::kNew);
  EXPECT_EQ(change.id, 1);
  EXPECT_THAT(change.after_segments, ElementsAre(11));
  EXPECT_THAT(change.before_segments, IsEmpty());
  EXPECT_THAT(change.before, IsEmpty());
  EXPECT_LT((center_of(change) - twice.in_after(kOnTable.center_S)).norm(), 0.03);
  EXPECT_GT(change.score, 0.5);
}

TEST(MapChanges, AThingThatWent) {
  ToyRoom was = furnished_room();
  const ToyRoom is = was;
  was.boxes.push_back(kOnTable);
  const Twice twice(was, is);
  const MapChanges result = twice.changes();
  ASSERT_EQ(result.changes.size(), 1U);
  EXPECT_EQ(result.changes[0].kind, ChangeKind::kGone);
  EXPECT_THAT(result.changes[0].before_segments, ElementsAre(11));
  EXPECT_THAT(result.changes[0].after, IsEmpty());
  EXPECT_LT((center_of(result.changes[0]) - twice.in_after(kOnTable.center_S)).norm(), 0.03);
}

TEST(MapChanges, AThingOfOneSegmentWithWhatItStandsOn) {
  ToyRoom was = furnished_room();
  const ToyRoom is = was;
  was.boxes.push_back(kOnTable);
  was.boxes.back().color = was.boxes[0].color;
  Twice twice(was, is);
  std::ranges::replace(twice.before.segment_ids, 11U, 7U);  // that of the table
  const MapChanges result = twice.changes();
  ASSERT_EQ(result.changes.size(), 1U);
  EXPECT_EQ(result.changes[0].kind, ChangeKind::kGone);
  EXPECT_LT((center_of(result.changes[0]) - twice.in_after(kOnTable.center_S)).norm(), 0.05);
}

TEST(MapChanges, AThingThatMoved) {
  ToyRoom was = furnished_room();
  ToyRoom is = was;
  was.boxes.push_back(kOnBench);
  Box moved = kOnBench;
  moved.center_S = {1.2, 1.2, 0.85};
  moved.yaw_rad = 0.6;
  is.boxes.push_back(moved);
  Twice twice(was, is);
  testing::relight(twice.after, 0.8, 0.9, 1.0);
  const MapChanges result = twice.changes();
  ASSERT_EQ(result.changes.size(), 1U);
  const MapChange& change = result.changes[0];
  EXPECT_EQ(change.kind, ChangeKind::kMoved);
  EXPECT_THAT(change.before_segments, ElementsAre(11));
  EXPECT_THAT(change.after_segments, ElementsAre(11));
  const Eigen::Vector3d now = change.X_after_before * twice.in_after(kOnBench.center_S);
  EXPECT_LT((now - twice.in_after(moved.center_S)).norm(), 0.02);
}

TEST(MapChanges, TwoThingsThatAreNotAlikeHaveNotMoved) {
  ToyRoom was = furnished_room();
  ToyRoom is = was;
  was.boxes.push_back(kOnBench);
  is.boxes.push_back(kOnTable);
  const MapChanges result = Twice(was, is).changes();
  ASSERT_EQ(result.changes.size(), 2U);
  EXPECT_NE(result.changes[0].kind, ChangeKind::kMoved);
  EXPECT_NE(result.changes[1].kind, ChangeKind::kMoved);
}

TEST(MapChanges, WhatWasNotLookedAtIsNotSeenThisTime) {
  ToyRoom was = furnished_room();
  const ToyRoom is = was;
  was.boxes.push_back(kOnTable);
  Twice twice(was, is);
  twice.after.views.clear();  // nobody looked through the place
  const MapChanges unseen = twice.changes();
  EXPECT_THAT(unseen.changes, IsEmpty());
  EXPECT_GT(unseen.not_seen_again, 200);
}

TEST(MapChanges, WhatStandsBehindAnotherThingIsNotGone) {
  ToyRoom was = furnished_room();
  ToyRoom is = was;
  was.boxes.push_back(kOnBench);
  is.boxes.push_back({.center_S = {2.8, 2.4, 1.2}, .size_m = {2.0, 0.1, 2.4}});  // a screen
  const MapChanges result = Twice(was, is).changes();
  ASSERT_EQ(result.changes.size(), 1U);
  EXPECT_EQ(result.changes[0].kind, ChangeKind::kNew);
  EXPECT_GT(result.not_seen_again, 200);
}

TEST(MapChanges, WhatStoodWhereAnotherThingStandsIsGone) {
  ToyRoom was = furnished_room();
  ToyRoom is = was;
  was.boxes.push_back(kOnTable);
  Box large{.center_S = {1.6, 1.2, 1.0}, .size_m = {0.6, 0.5, 0.5}, .color = {60, 60, 200}};
  is.boxes.push_back(large);
  const MapChanges result = Twice(was, is).changes();
  ASSERT_EQ(result.changes.size(), 2U);
  EXPECT_EQ(result.changes[0].kind, ChangeKind::kNew);
  EXPECT_EQ(result.changes[1].kind, ChangeKind::kGone);
  EXPECT_THAT(result.changes[1].before_segments, ElementsAre(11));
}

/// What the only change says of a box that is elsewhere now.
void expect_moved(const Box& from, const Box& to) {
  ToyRoom was = furnished_room();
  ToyRoom is = was;
  was.boxes.push_back(from);
  is.boxes.push_back(to);
  Twice twice(was, is);
  testing::relight(twice.after, 0.8, 0.9, 1.0);
  const MapChanges result = twice.changes();
  ASSERT_EQ(result.changes.size(), 1U);
  const MapChange& change = result.changes[0];
  ASSERT_EQ(change.kind, ChangeKind::kMoved);
  EXPECT_THAT(change.before_segments, ElementsAre(11));
  EXPECT_THAT(change.after_segments, ElementsAre(11));
  const Pose X_AS = twice.path_after.front().inverse(Eigen::Isometry);
  const Pose X = X_AS * to.X_SB() * from.X_SB().inverse(Eigen::Isometry) * X_AS.inverse();
  const Eigen::Vector3d middle = twice.in_after(from.center_S);
  EXPECT_LT((change.X_after_before * middle - X * middle).norm(), 0.01);
  const Eigen::Matrix3d turn = change.X_after_before.linear().transpose() * X.linear();
  EXPECT_LT(Eigen::AngleAxisd(turn).angle(), 0.05);
  EXPECT_GT(change.score, 0.9);
}

TEST(MapChanges, AThingThatWasTurnedWhereItStands) {
  Box turned = kOnTable;
  turned.yaw_rad = 0.4;
  expect_moved(kOnTable, turned);
}

TEST(MapChanges, AThingThatWasPushedByLessThanItsSize) {
  Box pushed = kOnTable;
  pushed.center_S.x() -= 0.12;
  expect_moved(kOnTable, pushed);
}

TEST(MapChanges, AThingAsFlatAsTheErrorOfTheMaps) {
  // Nothing is looked through: its colour alone tells where it lay, and where it lies.
  const Box flat{.center_S = {1.3, 1.2, 0.76}, .size_m = {0.4, 0.24, 0.02}, .color = {20, 20, 60}};
  Box turned = flat;
  turned.yaw_rad = 0.7;
  expect_moved(flat, turned);
}

TEST(MapChanges, AShadowIsNone) {
  const ToyRoom room = furnished_room();
  Twice twice(room, room);
  for (CloudPoint& point : twice.after.points_W) {
    if (point.x < 0.0F) continue;  // the half of the room to the right of the first camera
    for (auto* const channel : {&point.red, &point.green, &point.blue}) {
      *channel = static_cast<std::uint8_t>(0.85 * *channel);
    }
  }
  EXPECT_THAT(twice.changes().changes, IsEmpty());
}

TEST(MapChanges, AThingOfAnotherColorAtTheSamePlaceIsAnother) {
  ToyRoom was = furnished_room();
  ToyRoom is = was;
  was.boxes.push_back(kOnTable);
  is.boxes.push_back(kOnTable);
  is.boxes.back().color = {200, 30, 160};
  const MapChanges result = Twice(was, is).changes();
  ASSERT_EQ(result.changes.size(), 2U);
  EXPECT_NE(result.changes[0].kind, result.changes[1].kind);
  EXPECT_NE(result.changes[0].kind, ChangeKind::kMoved);
  EXPECT_NE(result.changes[1].kind, ChangeKind::kMoved);
}

TEST(MapChanges, APartOfALargerThingThatCameHasNotMoved) {
  ToyRoom was = furnished_room();
  ToyRoom is = was;
  was.boxes.push_back({.center_S = {1.6, 1.2, 0.81}, .size_m = {0.2, 0.12, 0.12}});
  is.boxes.push_back({.center_S = {2.7, 2.75, 0.8}, .size_m = {0.7, 0.4, 0.6}});  // of its colour
  const MapChanges result = Twice(was, is).changes();
  ASSERT_EQ(result.changes.size(), 2U);
  EXPECT_NE(result.changes[0].kind, ChangeKind::kMoved);
  EXPECT_NE(result.changes[1].kind, ChangeKind::kMoved);
}

TEST(ChangeFiles, SayWhatWasFound) {
  ToyRoom was = furnished_room();
  ToyRoom is = was;
  was.boxes.push_back(kOnBench);
  is.boxes.push_back(kOnTable);
  const Twice twice(was, is);
  MapDifference difference;
  difference.before = "a";
  difference.after = "caf\xe9.map";  // not UTF-8
  difference.after_session = std::int64_t{1} << 62;
  difference.alignment.X_AB = twice.X_AB;
  difference.changes = twice.changes();
  const kintsugi::testing::TemporaryFolder temporary;
  const std::filesystem::path folder = temporary / "new" / "folder";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "change_9.ply") << "of an earlier run";
  std::ofstream(folder / "change_notes.ply") << "of the user";
  write_changes(difference, twice.after, folder);
  std::ifstream file(folder / "changes.json");
  const auto json = nlohmann::json::parse(file);
  EXPECT_EQ(json["before"], "a");
  EXPECT_THAT(json["after"].get<std::string>(), ::testing::EndsWith(".map"));
  EXPECT_EQ(json["after_session"], difference.after_session);
  EXPECT_EQ(json["X_AB"].size(), 12U);
  EXPECT_EQ(json["X_AB"][3], twice.X_AB.translation().x());
  ASSERT_EQ(json["changes"].size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& change = json["changes"][i];
    EXPECT_EQ(change["id"], i + 1);
    const MapChange& expected = difference.changes.changes[i];
    EXPECT_EQ(change["points"], expected.points().size());
    EXPECT_FALSE(change.contains("X_after_before"));
    EXPECT_TRUE(std::filesystem::exists(folder / ("change_" + std::to_string(i + 1) + ".ply")));
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "change_9.ply"));
  EXPECT_TRUE(std::filesystem::exists(folder / "change_notes.ply"));
  EXPECT_GT(std::filesystem::file_size(folder / "changes.png"), 10'000U);
}

}  // namespace
}  // namespace kintsugi::segmenter
