// Labels with segment ids, and highlighted segments.

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "tests/viewer/support/synthetic_room.hpp"
#include "viewer/core/figure/map_renderer.hpp"
#include "viewer/core/figure/segment_labels.hpp"
#include "viewer/core/rendering/shade.hpp"

namespace kintsugi::viewer {
namespace {

const cv::Size kSize(1280, 720);

IdImage nothing() { return {kSize, static_cast<std::int32_t>(kNoSegment)}; }

void add(IdImage& ids, const cv::Rect& area, std::int32_t id) { ids(area).setTo(id); }

bool are_apart(const std::vector<SegmentLabel>& labels) {
  for (std::size_t i = 0; i < labels.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (!(labels[i].box & labels[j].box).empty()) return false;
      if (labels[i].box.contains(labels[j].anchor)) return false;
      if (labels[j].box.contains(labels[i].anchor)) return false;
    }
  }
  return true;
}

TEST(SegmentLabels, StandInTheMiddleOfASegmentWithRoom) {
  IdImage ids = nothing();
  add(ids, {100, 100, 401, 201}, 12);
  const auto labels = place_labels(ids, {}, {});
  ASSERT_EQ(1U, labels.size());
  EXPECT_EQ(12U, labels[0].segment_id);
  EXPECT_EQ(cv::Point(300, 200), labels[0].anchor);
  EXPECT_TRUE(labels[0].box.contains(labels[0].anchor));
}

TEST(SegmentLabels, StandOnTheSegmentWhenItsCentroidIsNot) {
  IdImage ids = nothing();
  add(ids, {100, 100, 400, 400}, 5);
  add(ids, {180, 180, 240, 240}, 6);  // in the middle of it
  for (const SegmentLabel& label : place_labels(ids, {}, {})) {
    EXPECT_EQ(static_cast<std::int32_t>(label.segment_id), ids(label.anchor));
    const cv::Mat seen = ids(label.box) == static_cast<std::int32_t>(label.segment_id);
    EXPECT_EQ(label.box.area(), cv::countNonZero(seen)) << label.segment_id;
  }
}

TEST(SegmentLabels, StandBesideWhatTheyWouldHide) {
  IdImage ids = nothing();
  add(ids, {600, 300, 12, 9}, 123);
  EXPECT_TRUE(place_labels(ids, {}, {}).empty());  // too few pixels for a label
  const auto labels = place_labels(ids, {123}, {});
  ASSERT_EQ(1U, labels.size());
  EXPECT_EQ(0, cv::countNonZero(ids(labels[0].box)));
}

TEST(SegmentLabels, CoverNeitherEachOtherNorWhatIsReserved) {
  IdImage ids = nothing();
  std::int32_t id = 1'000;
  for (int v = 0; v < kSize.height; v += 24) {  // more segments than there is room for
    for (int u = 0; u + 24 <= kSize.width; u += 24) add(ids, cv::Rect(u, v, 24, 24), id++);
  }
  const std::array reserved{cv::Rect(0, 0, 400, 300)};
  const auto labels = place_labels(ids, {}, reserved);
  EXPECT_GT(labels.size(), 30U);
  EXPECT_TRUE(are_apart(labels));
  for (const SegmentLabel& label : labels) {
    EXPECT_TRUE((label.box & reserved[0]).empty());
    EXPECT_EQ(label.box, label.box & cv::Rect({}, kSize));
  }
}

TEST(SegmentLabels, AreThoseOfTheLargestSegmentsFirst) {
  IdImage ids = nothing();
  add(ids, {0, 0, 300, 300}, 3);
  add(ids, {400, 0, 500, 500}, 70'000);
  add(ids, {0, 400, 100, 100}, 1);
  const auto labels = place_labels(ids, {}, {});
  std::vector<std::uint32_t> order;
  for (const SegmentLabel& label : labels) order.push_back(label.segment_id);
  EXPECT_THAT(order, ::testing::ElementsAre(70'000U, 3U, 1U));
}

struct Furnished {
  ReceivedMap map{1'000};
  SmoothedCamera depth_camera;

  Furnished() {
    const SyntheticMap room = make_room(4.0, 0.04);
    for (const CloudSlice& slice : room.slices) map.add_slice(slice);
    for (const SegmentUpdate& update : room.updates) map.apply_update(update);
  }
  Subject from_above(const Highlight& highlight) const {
    return {map,      0, {}, depth_camera, FixedViewpoint{{0.0, -8.0, 2.0}, {0.0, 0.0, 2.001}},
            highlight};
  }
};

constexpr std::uint32_t kFloor = 1;
constexpr std::uint32_t kDesk = 7;
const cv::Point kOnFloor(280, 155);  // of a picture of 480 x 270

MapRenderer::Config small() {
  MapRenderer::Config config;
  config.width_px = 480;
  config.height_px = 270;
  return config;
}

TEST(Highlight, KeepsColorsAndDimsTheRest) {
  const Furnished room;
  const MapRenderer renderer(small());
  for (const Coloring coloring : {Coloring::kTrue, Coloring::kSegments}) {
    const cv::Vec3b usual = renderer.draw_map(room.from_above({}), coloring)(kOnFloor);
    const cv::Vec3b chosen = renderer.draw_map(room.from_above({kFloor}), coloring)(kOnFloor);
    const cv::Vec3b dim = renderer.draw_map(room.from_above({kDesk}), coloring)(kOnFloor);
    EXPECT_EQ(usual, chosen);
    for (int i = 0; i < 3; ++i) EXPECT_LT(dim[i], 0.6 * cv::norm(usual, cv::NORM_INF));
  }
}

TEST(Highlight, OutlinesWhatStandsOut) {
  const Furnished room;
  const auto white = [&](const Highlight& highlight) {
    cv::Mat mask;
    cv::inRange(MapRenderer(small()).draw_map(room.from_above(highlight), Coloring::kTrue),
                cv::Scalar::all(250), cv::Scalar::all(255), mask);
    return cv::countNonZero(mask);
  };
  EXPECT_EQ(0, white({}));
  EXPECT_GT(white({kDesk}), 60);  // about the desk: some 30 x 25 pixels
}

TEST(Highlight, OfSegmentsThatAreNotThereDimsEverything) {
  const Furnished room;
  const MapRenderer renderer(small());
  const cv::Mat3b figure = renderer.draw_figure(room.from_above({4'000'000'000U}), "caption");
  EXPECT_EQ(cv::Size(480, 270), figure.size());
  const cv::Mat3b map = renderer.draw_map(room.from_above({4'000'000'000U}), Coloring::kSegments);
  double brightest = 0.0;
  cv::minMaxLoc(map.reshape(1), nullptr, &brightest);
  EXPECT_LT(brightest, 160.0);
}

TEST(Highlight, ComesCloserToSegments) {
  const Furnished room;
  const Intrinsics intrinsics = pinhole(480, 270, 0.9);
  const auto chunks = room.map.chunks(0);
  const Eigen::Matrix3d R_WV = look_down(room.map.up(0).up_W(), 0.0, 1.0);
  const auto desk = close_up(chunks, {kDesk}, R_WV, intrinsics);
  const auto both = close_up(chunks, {kDesk, kFloor}, R_WV, intrinsics);
  ASSERT_TRUE(desk && both);
  const Eigen::Vector3d forward_W = R_WV.col(2);
  EXPECT_GT(forward_W.dot(desk->X_WV.translation()), forward_W.dot(both->X_WV.translation()));
  EXPECT_FALSE(close_up(chunks, {99'999}, R_WV, intrinsics));
  EXPECT_FALSE(close_up(chunks, {}, R_WV, intrinsics));
}

TEST(MapRenderer, WritesIdsOnlyWhereItIsAskedTo) {
  const Furnished room;
  MapRenderer::Config config = small();
  const auto draw = [&](Coloring coloring) {
    return MapRenderer(config).draw_map(room.from_above({}), coloring);
  };
  const cv::Mat3b map = draw(Coloring::kTrue);
  const cv::Mat3b segments = draw(Coloring::kSegments);
  config.label_ids = true;
  EXPECT_EQ(0.0, cv::norm(map, draw(Coloring::kTrue), cv::NORM_INF));
  EXPECT_GT(cv::norm(segments, draw(Coloring::kSegments), cv::NORM_INF), 0.0);
}

}  // namespace
}  // namespace kintsugi::viewer
