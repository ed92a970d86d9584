// The segmentation library, as other programs use it: through its public header alone.

#include <cmath>
#include <filesystem>
#include <limits>
#include <set>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segmenter/library/segmentation.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi {
namespace {

using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// 20 x 20 points, 1 cm apart, with the corner at (x_m, 0, z_m), facing -z.
std::vector<CloudPoint> square(float x_m, float z_m = 1.0F) {
  std::vector<CloudPoint> points;
  for (int i = 0; i < 400; ++i) {
    const int row = i / 20;
    CloudPoint& point = points.emplace_back();
    point.x = x_m + 0.01F * static_cast<float>(i % 20);
    point.y = 0.01F * static_cast<float>(row);
    point.z = z_m;
    point.nz = -1.0F;
  }
  return points;
}

std::set<std::uint32_t> ids(const std::vector<std::uint32_t>& labels) {
  return {labels.begin(), labels.end()};
}

std::string message_of(const auto& action) {
  try {
    action();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "nothing was thrown";
}

Pose shifted(double x_m) { return Pose(Eigen::Translation3d(x_m, 0.0, 0.0)); }

TEST(Segmenter, GivesPiecesThatTouchOneSegmentAndOthersAnotherOne) {
  Segmenter segmenter({});
  const PieceId a = segmenter.add(square(0.0F));
  const PieceId b = segmenter.add(square(0.2F));
  const PieceId far = segmenter.add(square(2.0F));
  EXPECT_THAT(segmenter.pieces(), ElementsAre(a, b, far));
  EXPECT_THAT(segmenter.labels(a), SizeIs(400));
  EXPECT_THAT(ids(segmenter.labels(a)), SizeIs(1));
  EXPECT_EQ(segmenter.labels(b), segmenter.labels(a));
  EXPECT_NE(segmenter.labels(far), segmenter.labels(a));
  EXPECT_EQ(segmenter.num_points(), 1'200);
  ASSERT_THAT(segmenter.segments(), SizeIs(2));
  EXPECT_EQ(segmenter.segments()[0].num_points, 800U);
}

TEST(Segmenter, MovesAPieceToAnAbsolutePose) {
  Segmenter segmenter({});
  const PieceId a = segmenter.add(square(0.0F));
  const PieceId b = segmenter.add(square(2.0F));
  segmenter.move(b, shifted(-1.8));
  EXPECT_EQ(segmenter.num_segments(), 1);
  EXPECT_EQ(segmenter.labels(b), segmenter.labels(a));
  EXPECT_FLOAT_EQ(segmenter.points_W(b).front().x, 0.2F);
  ASSERT_THAT(segmenter.events(),
              Contains(::testing::Field(&SegmentEvent::type, SegmentEventType::kMerged)));
  EXPECT_THAT(segmenter.relabelled_pieces(), ElementsAre(b));

  segmenter.move(b, shifted(0.0));
  EXPECT_EQ(segmenter.num_segments(), 2);
  EXPECT_FLOAT_EQ(segmenter.points_W(b).front().x, 2.0F);
}

TEST(Segmenter, ReplacesAndRemovesPieces) {
  Segmenter segmenter({});
  const PieceId a = segmenter.add(square(0.0F));
  const PieceId b = segmenter.add(square(0.2F));
  const std::uint32_t id = segmenter.labels(a).front();
  segmenter.replace(b, square(5.0F));
  EXPECT_EQ(segmenter.num_segments(), 2);
  segmenter.move(b, shifted(1.0));
  segmenter.replace(b, square(4.0F));  // stays where it is
  EXPECT_FLOAT_EQ(segmenter.points_W(b).front().x, 5.0F);
  segmenter.remove(b);
  EXPECT_THAT(segmenter.pieces(), ElementsAre(a));
  EXPECT_THAT(segmenter.labels(a), Each(id));
  EXPECT_EQ(segmenter.num_segments(), 1);
  EXPECT_THAT(message_of([&] { segmenter.remove(b); }), HasSubstr("there is no piece 1"));
}

TEST(Segmenter, EqualsASegmenterThatWasGivenEverythingInOtherPieces) {
  Segmenter pieces({});
  Segmenter whole({});
  std::vector<CloudPoint> all;
  for (const float x_m : {0.0F, 0.5F, 0.2F}) {
    pieces.add(square(x_m));
    for (const CloudPoint& point : square(x_m)) all.push_back(point);
  }
  whole.add(all);
  EXPECT_EQ(pieces.num_segments(), whole.num_segments());
  EXPECT_EQ(pieces.segments()[0].num_points, whole.segments()[0].num_points);
}

TEST(Segmenter, GivesPointsThatCannotBeSegmentedNoSegment) {
  Segmenter segmenter({});
  std::vector<CloudPoint> points = square(0.0F);
  points[7].x = std::numeric_limits<float>::quiet_NaN();
  points[9].nz = 0.0F;
  const PieceId piece = segmenter.add(points);
  const auto labels = segmenter.labels(piece);
  EXPECT_EQ(labels[7], kNoSegment);
  EXPECT_EQ(labels[9], kNoSegment);
  EXPECT_NE(labels[8], kNoSegment);
  EXPECT_THAT(segmenter.points_W(piece), SizeIs(398));
  EXPECT_THAT(segmenter.labels(segmenter.add({})), IsEmpty());
}

TEST(Segmenter, RefusesBadOptionsAndPosesWithASentence) {
  EXPECT_THAT(message_of([] { Segmenter({.resolution_m = 0.0}); }),
              HasSubstr("resolution_m is 0, must be > 0"));
  EXPECT_THAT(message_of([] { Segmenter({.preset = "nice"}); }), HasSubstr("nice"));
  EXPECT_THAT(message_of([] { Segmenter({.mode = "magic"}); }), HasSubstr("magic"));
  EXPECT_THAT(message_of([] {
                Segmenter({.parameters = {{"colour", 1.0}}});
              }),
              HasSubstr("there is no parameter 'colour'"));
  EXPECT_THAT(message_of([] { Segmenter({.parameters = {{"scale", -1.0}}}); }), HasSubstr("scale"));
  Segmenter segmenter({});
  const PieceId piece = segmenter.add(square(0.0F));
  Pose mirror = Pose::Identity();
  mirror.linear()(0, 0) = -1.0;
  EXPECT_THAT(message_of([&] { segmenter.move(piece, mirror); }), HasSubstr("must be a rotation"));
  EXPECT_THAT(message_of([&] { segmenter.move(piece, shifted(std::nan(""))); }),
              HasSubstr("must be a rotation"));
  const std::vector<PieceMove> twice(2, {piece, shifted(1.0)});
  EXPECT_THAT(message_of([&] { segmenter.move(twice); }), HasSubstr("named twice"));
  EXPECT_FLOAT_EQ(segmenter.points_W(piece).front().x, 0.0F);
}

TEST(Segmenter, AnswersQueries) {
  Segmenter segmenter({});
  segmenter.add(square(0.0F));
  SegmentQuery query;
  query.place = QueryPlace::kPoint;
  query.point_W[2] = 1.01;
  const SegmentAnswer answer = segmenter.ask(query);
  ASSERT_THAT(answer.segments, SizeIs(1));
  EXPECT_EQ(answer.segments[0].is_planar, 1U);
  query.radius_m = -1.0;
  EXPECT_THAT(message_of([&] { (void)segmenter.ask(query); }), HasSubstr("radius_m"));
  query = {};
  query.place = QueryPlace::kPixel;
  EXPECT_THAT(message_of([&] { (void)segmenter.ask(query); }), HasSubstr("camera"));
}

TEST(Segmenter, SavesAMapThatIsReadBack) {
  const testing::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "segmenter.map";
  Segmenter segmenter({.resolution_m = 0.01, .preset = "paper"});
  const PieceId piece = segmenter.add(square(0.0F));
  segmenter.save(file);
  const SavedMap map(file);
  EXPECT_FLOAT_EQ(static_cast<float>(map.resolution_m()), 0.01F);
  EXPECT_EQ(map.points_W().size(), 400U);
  EXPECT_EQ(std::vector(map.labels().begin(), map.labels().end()), segmenter.labels(piece));
  EXPECT_EQ(map.segments(), segmenter.segments());
  EXPECT_THAT(map.ask({}).segments, SizeIs(1));
  EXPECT_THROW(SavedMap(folder.path() / "none"), std::runtime_error);
}

TEST(EstimateNormals, FaceTheViewpoint) {
  std::vector<CloudPoint> points = square(0.0F);
  for (CloudPoint& point : points) point.nz = 0.0F;
  estimate_normals(points, 0.01, Eigen::Vector3d(0.0, 0.0, 5.0));
  for (const CloudPoint& point : points) ASSERT_NEAR(point.nz, 1.0F, 1e-5F);
  EXPECT_THROW(estimate_normals(points, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi
