#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segmenter/evaluation/objects/change_scores.hpp"
#include "segmenter/evaluation/objects/detection_scores.hpp"
#include "segmenter/evaluation/objects/objects_report.hpp"
#include "segmenter/evaluation/objects/pose_error.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::HasSubstr;

Pose at(double x, double y, double z) {
  Pose X = Pose::Identity();
  X.translation() = Eigen::Vector3d(x, y, z);
  return X;
}

Pose turned(double degrees, const Eigen::Vector3d& axis) {
  return Pose(Eigen::AngleAxisd(degrees * std::numbers::pi / 180.0, axis));
}

const Eigen::Vector3d kX = Eigen::Vector3d::UnitX();
const Eigen::Vector3d kZ = Eigen::Vector3d::UnitZ();

TEST(PoseError, IsModuloTheSymmetry) {
  const Pose X_WG = at(1, 2, 3) * turned(20, kX);
  const auto degrees = [&](const Pose& turn, const std::vector<SymmetryAxis>& axes) {
    return pose_error(X_WG * turn, X_WG, {.centre_G = Eigen::Vector3d::Zero(), .axes = axes})
        .rotation_deg;
  };
  EXPECT_NEAR(degrees(turned(30, kZ), {}), 30, 1e-6);
  EXPECT_NEAR(degrees(turned(170, kZ), {{kZ, 2}}), 10, 1e-6);
  EXPECT_NEAR(degrees(turned(100, kZ), {{kZ, 4}}), 10, 1e-6);
  EXPECT_NEAR(degrees(turned(100, kZ), {{kZ, 0}}), 0, 1e-5);
  EXPECT_NEAR(degrees(turned(100, kZ) * turned(7, kX), {{kZ, 0}}), 7, 1e-6);
  // A box of three different sides: upside down is about x, and with z also about y.
  EXPECT_NEAR(degrees(turned(180, Eigen::Vector3d::UnitY()), {{kX, 2}, {kZ, 2}}), 0, 1e-5);
  EXPECT_NEAR(degrees(turned(175, kX), {{kX, 2}, {kZ, 0}}), 5, 1e-5);  // a rod
  EXPECT_NEAR(degrees(turned(123, kX), {{kX, 0}, {kZ, 0}}), 0, 1e-5);  // a ball
}

TEST(PoseError, TranslationIsOfTheCentre) {
  const Symmetry mug{.centre_G = {0.1, 0, 0}, .axes = {}};
  const PoseError error = pose_error(turned(180, kZ), Pose::Identity(), mug);
  EXPECT_NEAR(error.translation_m, 0.2, 1e-12);
  EXPECT_NEAR(error.rotation_deg, 180, 1e-6);
  EXPECT_NEAR(pose_error(at(0, 0.03, 0.04), Pose::Identity(), mug).translation_m, 0.05, 1e-12);
}

/// A square patch of n x n points, 1 cm apart.
std::vector<CloudPoint> patch(double x, double y, int n) {
  std::vector<CloudPoint> points;
  for (int i = 0; i < n * n; ++i) {
    CloudPoint p;
    p.x = static_cast<float>(x + 0.01 * (i % n));
    p.y = static_cast<float>(y + 0.01 * static_cast<int>(i / n));
    points.push_back(p);
  }
  return points;
}

void add(Truth& truth, std::uint32_t id, const std::vector<CloudPoint>& points) {
  truth.points_W.insert(truth.points_W.end(), points.begin(), points.end());
  truth.instance_ids.insert(truth.instance_ids.end(), points.size(), id);
}

TrueObject object(const std::string& key, const std::string& kind) {
  TrueObject object;
  object.key = object.model = key;
  object.kind = kind;
  return object;
}

constexpr int kSide = 25;  // of objects: 625 points

/// BEFORE's map frame is 1 m aside. Instance 1 is a table that stays, 2 goes, 3 moves by 1 m, 4 (as
/// 3 of the map after, which is also numbered otherwise) is new.
class ChangeScores : public ::testing::Test {
 protected:
  ChangeScores() {
    told_.X_AB = at(1, 0, 0);
    add(before_, 1, patch(-1, 0, 40));
    add(before_, 2, patch(1, 0, kSide));
    add(before_, 3, patch(2, 0, kSide));
    add(after_, 1, patch(0, 0, 40));
    add(after_, 2, patch(3, 1, kSide));
    add(after_, 3, patch(5, 0, kSide));
    TrueObject gone = object("gone thing", "gone");
    gone.id_before = 2;
    TrueObject moved = object("moved thing", "moved");
    moved.id_before = 3;
    moved.id_after = 2;
    moved.X_SG_before = at(3, 0, 0);
    moved.X_SG_after = at(3, 1, 0);
    TrueObject brought = object("new thing", "new");
    brought.id_after = 3;
    truth_.changes = {gone, moved, brought};
  }

  ObjectScores score() const { return score_changes(told_, truth_, before_, after_, 0.03); }

  void tell(const std::string& kind, const std::vector<CloudPoint>& was,
            const std::vector<CloudPoint>& is) {
    told_.changes.push_back({.id = std::ssize(told_.changes) + 1,
                             .kind = kind,
                             .X_after_before = std::nullopt,
                             .was_W = was,
                             .is_W = is});
  }

  Truth before_;
  Truth after_;
  TrueObjects truth_;
  ToldChanges told_;
};

TEST_F(ChangeScores, AllThatIsToldRightlyIsFound) {
  tell("gone", patch(2, 0, kSide), {});
  tell("moved", patch(3, 0, kSide), patch(3, 1, kSide));
  told_.changes.back().X_after_before = at(0, 1.01, 0);
  tell("new", {}, patch(5, 0, kSide));
  const ObjectScores scores = score();
  const Tally large = tally(scores, kSizeClasses[2]);
  EXPECT_EQ(large.precision(), 1.0);
  EXPECT_EQ(large.recall(), 1.0);
  EXPECT_EQ(large.num_true, 3);
  ASSERT_TRUE(scores.truth[1].error);
  EXPECT_NEAR(scores.truth[1].error->translation_m, 0.01, 1e-9);
  EXPECT_EQ(moved_share(scores).num_right, 1);
  EXPECT_EQ(num_large_false_claims(scores), 0);
  EXPECT_EQ(tally(scores, kSizeClasses[0]).recall(), std::nullopt);
}

TEST_F(ChangeScores, AMotionThatIsFarOffIsNotRight) {
  tell("moved", patch(3, 0, kSide), patch(3, 1, kSide));
  told_.changes.back().X_after_before = at(0, 1.03, 0);
  const ObjectScores scores = score();
  EXPECT_TRUE(scores.truth[1].is_found_as_kind);
  EXPECT_EQ(moved_share(scores).num_right, 0);
  EXPECT_EQ(moved_share(scores).num_true, 1);
}

TEST_F(ChangeScores, AMovedThingToldAsGoneAndNewIsFoundButNotAsMoved) {
  tell("gone", patch(3, 0, kSide), {});
  tell("new", {}, patch(3, 1, kSide));
  const ObjectScores scores = score();
  EXPECT_TRUE(scores.truth[1].is_found);
  EXPECT_FALSE(scores.truth[1].is_found_as_kind);
  EXPECT_TRUE(scores.claims[0].is_right && scores.claims[1].is_right);
  EXPECT_NEAR(*tally(scores, kSizeClasses[2]).recall(), 1.0 / 3, 1e-12);
}

TEST_F(ChangeScores, UncoveredSurfaceIsNoTrueChange) {
  tell("new", {}, patch(0, 0, 20));  // of the table
  tell("new", {}, patch(7, 7, 20));  // of nothing
  const ObjectScores scores = score();
  EXPECT_FALSE(scores.claims[0].is_right);
  EXPECT_FALSE(scores.claims[1].is_right);
  EXPECT_EQ(num_large_false_claims(scores), 2);
  EXPECT_EQ(tally(scores, kSizeClasses[1]).precision(), 0.0);  // 400 points each
  EXPECT_EQ(tally(scores, kSizeClasses[2]).precision(), std::nullopt);
  EXPECT_EQ(tally(scores, kSizeClasses[2]).recall(), 0.0);
}

TEST_F(ChangeScores, TheWrongKindIsNotRightAndTwoThirdsOfAThingAre) {
  tell("gone", {}, patch(5, 0, kSide));
  tell("new", {}, patch(5, 0, 20));
  const ObjectScores scores = score();
  EXPECT_THAT(scores.claims[0].reason, HasSubstr("is new"));
  EXPECT_FALSE(scores.claims[0].is_right);
  EXPECT_TRUE(scores.claims[1].is_right);
}

TEST_F(ChangeScores, ATenthOfAThingIsNotTheThing) {
  tell("new", {}, patch(5, 0, 8));
  const ObjectScores scores = score();
  EXPECT_THAT(scores.claims[0].reason, HasSubstr("less than half"));
  EXPECT_FALSE(scores.truth[2].is_found);
}

TEST_F(ChangeScores, TheReportHasAllOfIt) {
  tell("new", {}, patch(0, 0, 20));
  const auto folder = std::filesystem::path(::testing::TempDir()) / "objects_report";
  write_objects_report(score(), folder);
  for (const char* name : {"scores.json", "summary.csv", "objects.csv", "claims.csv", "sizes.gp"}) {
    EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
  }
  const std::string text = to_text(score());
  EXPECT_THAT(text, HasSubstr("false, of 200 points and more: 1"));
  EXPECT_THAT(text, HasSubstr("told as moved, within 2 cm and 5 degrees: 0 of 1"));
  EXPECT_THAT(to_json(score()), HasSubstr("\"false_of_200_points\": 1"));
}

TEST(ToldChanges, PointsAreOfBeforeOrOfNow) {
  const auto folder = std::filesystem::path(::testing::TempDir()) / "told_changes";
  std::filesystem::create_directories(folder);
  const auto write = [&](const std::string& properties) {
    std::ofstream(folder / "changes.json")
        << R"({"X_AB":[1,0,0,2,0,1,0,0,0,0,1,0],"changes":[{"id":7,"kind":"new"}]})";
    std::ofstream(folder / "change_7.ply")
        << "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
        << "property float z\n"
        << properties << "end_header\n1 2 3 1\n4 5 6 0\n";
  };
  write("property uchar was\n");
  const ToldChanges told = read_told_changes(folder);
  EXPECT_EQ(told.X_AB.translation().x(), 2.0);
  ASSERT_EQ(told.changes.size(), 1U);
  ASSERT_EQ(told.changes[0].was_W.size(), 1U);
  EXPECT_EQ(told.changes[0].was_W[0].x, 1.0F);
  ASSERT_EQ(told.changes[0].is_W.size(), 1U);
  EXPECT_EQ(told.changes[0].is_W[0].x, 4.0F);
  write("property uchar wax\n");
  try {
    read_told_changes(folder);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), ::testing::AllOf(HasSubstr("change_7.ply"), HasSubstr("'was'")));
  }
}

ToldDetection detection(std::int64_t id, const std::string& name, const Pose& X_WO) {
  return {.id = id,
          .name = name,
          .X_WO = X_WO,
          .box_O = {Eigen::Vector3d(-0.1, -0.1, -0.1), Eigen::Vector3d(0.1, 0.1, 0.1)},
          .points = 600};
}

class DetectionScores : public ::testing::Test {
 protected:
  DetectionScores() {
    TrueObject mug = object("mug red", "same object");
    mug.id_after = 5;
    mug.X_SG_after = at(0.12, 0.12, 0);
    truth_.objects = {mug};
    add(map_, 5, patch(0, 0, kSide));
    add(map_, 6, patch(2, 0, kSide));
  }

  ObjectScores score(const std::vector<ToldDetection>& told) const {
    return score_detections(told, truth_, map_, {"mug_red", "globe"}, {});
  }

  TrueObjects truth_;
  Truth map_;
};

TEST_F(DetectionScores, TheNearestOfTheNameIsRightAndOnlyIt) {
  const ObjectScores scores =
      score({detection(1, "mug_red", at(0.16, 0.12, 0)), detection(2, "mug_red", at(0.13, 0.12, 0)),
             detection(3, "mug_red", at(2.1, 0.1, 0)), detection(4, "globe", at(0.12, 0.12, 0))});
  EXPECT_FALSE(scores.claims[0].is_right);
  EXPECT_THAT(scores.claims[0].reason, HasSubstr("nearer"));
  EXPECT_TRUE(scores.claims[1].is_right);
  EXPECT_FALSE(scores.claims[2].is_right);
  EXPECT_FALSE(scores.claims[3].is_right);
  ASSERT_EQ(scores.truth.size(), 1U);
  EXPECT_NEAR(scores.truth[0].error->translation_m, 0.01, 1e-9);
  const Tally large = tally(scores, kSizeClasses[2]);
  EXPECT_EQ(large.precision(), 0.25);
  EXPECT_EQ(large.recall(), 1.0);
}

TEST_F(DetectionScores, WhatWasTaughtAndNotDetectedIsMissed) {
  EXPECT_EQ(tally(score({}), kSizeClasses[2]).recall(), 0.0);
}

TEST(ToldDetections, TheLastWordCountsAndBadFilesAreNamed) {
  const auto path = std::filesystem::path(::testing::TempDir()) / "detections.json";
  const std::string tail =
      R"(,"name":"mug","X_WO":[1,0,0,0,0,1,0,0,0,0,1,%],"points":9,"box_min_O":[0,0,0],"box_max_O":[1,1,1])";
  const auto entry = [&](int id, const std::string& z, const std::string& event, int utime) {
    std::string text = R"({"detection":)" + std::to_string(id) + tail + R"(,"event":")" + event +
                       R"(","utime":)" + std::to_string(utime) + "}";
    return text.replace(text.find('%'), 1, z);
  };
  std::ofstream(path) << R"({"detections":[)" << entry(1, "0", "found", 5) << ','
                      << entry(2, "0", "found", 6) << ',' << entry(1, "3", "moved", 7) << ','
                      << entry(2, "0", "gone", 8) << "]}";
  const auto told = read_told_detections(path);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].X_WO.translation().z(), 3.0);
  EXPECT_EQ(told[0].found_utime, 5);
  std::ofstream(path) << R"({"detections":[{"detection":1}]})";
  try {
    read_told_detections(path);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("detections.json"));
  }
  EXPECT_THROW(pose_of({1, 2, 3}), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::segmenter
