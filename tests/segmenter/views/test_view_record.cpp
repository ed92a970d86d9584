// Which views are kept, and where corrections of the map put them.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "segmenter/views/packed_depth.hpp"
#include "segmenter/views/view_record.hpp"
#include "tests/segmenter/query/camera_view.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr std::int64_t kSecond = 1'000'000;

CameraView view_at(double x_m, std::int64_t utime, std::int32_t part = 0) {
  Pose X_WC = Pose::Identity();
  X_WC.translation().x() = x_m;
  CameraView view = testing::view_of_wall(5, X_WC, 2.0);
  view.utime = utime;
  view.part = part;
  return view;
}

PatchPose shifted(double x_m) {
  Pose X_WP = Pose::Identity();
  X_WP.translation().x() = x_m;
  return X_WP;
}

CloudSlice patch(std::int32_t id, std::int64_t utime, std::int32_t part = 0) {
  CloudSlice slice;
  slice.session = 5;
  slice.map_name = "map";
  slice.id = id;
  slice.utime = utime;
  slice.part = part;
  slice.kind = SliceKind::kPatch;
  slice.resolution_m = 0.01F;
  return slice;
}

CloudSlice correction(std::int32_t number, std::int64_t utime, std::vector<PatchMotion> motions) {
  CloudSlice slice = patch(1000 + number, utime);
  slice.kind = SliceKind::kCorrection;
  slice.correction = number;
  slice.motions = std::move(motions);
  return slice;
}

std::vector<double> places_of(const ViewRecord& record) {
  std::vector<double> x_m;
  for (const KeptView& view : record.views().views) x_m.push_back(view.X_WC.translation().x());
  return x_m;
}

TEST(ViewRecord, KeepsAViewWhenTheCameraHasMovedOrTurned) {
  ViewRecord record(5, "map");
  // At 2 m the view is 2.4 m wide: a step of 0.125 m is a twentieth of it, two are a tenth.
  for (int i = 0; i < 9; ++i) record.add(view_at(0.125 * i, kSecond + i));
  EXPECT_EQ(places_of(record), (std::vector<double>{0.0, 0.25, 0.5, 0.75, 1.0}));
  CameraView turned = view_at(1.0, 2 * kSecond);
  turned.X_WC.linear() = Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitY()).matrix();
  record.add(turned);
  EXPECT_EQ(record.views().views.size(), 5U);
  turned.utime += 1;
  turned.X_WC.linear() = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()).matrix();
  record.add(turned);
  EXPECT_EQ(record.views().views.size(), 6U);
}

TEST(ViewRecord, KeepsAViewOfTheSamePlaceAfterALongTime) {
  ViewRecord record(5, "map");
  for (int i = 0; i <= 70; ++i) record.add(view_at(0.0, i * kSecond));
  EXPECT_EQ(record.views().views.size(), 3U);
}

TEST(ViewRecord, LeavesOutALostCameraAndTheNotLater) {
  ViewRecord record(5, "map");
  record.add(view_at(0.0, 3 * kSecond));
  record.add(view_at(5.0, 2 * kSecond));
  record.add(view_at(5.0, 3 * kSecond));
  CameraView lost = view_at(5.0, 4 * kSecond);
  lost.state = TrackingState::kLost;
  record.add(lost);
  lost.state = TrackingState::kStarting;
  record.add(lost);
  EXPECT_EQ(places_of(record), std::vector<double>{0.0});
  CameraView given = view_at(5.0, 4 * kSecond);
  given.state = TrackingState::kGiven;
  record.add(given);
  EXPECT_EQ(record.views().views.size(), 2U);
}

TEST(ViewRecord, ViewsGoWithThePatchThatCameLastBeforeThem) {
  ViewRecord record(5, "map");
  record.add(view_at(1.0, 1 * kSecond));  // before any patch: on the first
  record.add(patch(0, 2 * kSecond));
  record.add(view_at(2.0, 3 * kSecond));  // on patch 0
  record.add(patch(1, 4 * kSecond));
  record.add(view_at(3.0, 5 * kSecond));  // on patch 1
  record.add(correction(1, 6 * kSecond, {{0, shifted(10)}, {1, shifted(20)}}));
  EXPECT_EQ(places_of(record), (std::vector<double>{11.0, 12.0, 23.0}));
  // A view after the correction is in the corrected map. It hangs on patch 1, which moves on.
  record.add(view_at(24.0, 6 * kSecond));
  record.add(correction(2, 7 * kSecond, {{1, shifted(21)}}));
  EXPECT_EQ(places_of(record), (std::vector<double>{11.0, 12.0, 24.0, 25.0}));
  // The header of a newer revision counts, too.
  CloudSlice revised = patch(0, 8 * kSecond);
  revised.revision = 1;
  revised.correction = 3;
  revised.X_WP = shifted(11);
  record.add(revised);
  EXPECT_EQ(places_of(record), (std::vector<double>{12.0, 13.0, 24.0, 25.0}));
}

TEST(ViewRecord, AViewBeforeAllPatchesHangsOnTheFirst) {
  ViewRecord record(5, "map");
  record.add(view_at(1.0, 1 * kSecond));
  record.add(patch(0, 2 * kSecond));
  record.add(patch(1, 3 * kSecond));
  record.add(correction(1, 4 * kSecond, {{0, shifted(10)}}));
  EXPECT_EQ(places_of(record), std::vector<double>{11.0});
}

TEST(ViewRecord, DoNotHangOnPatchesOfAnotherMapper) {
  ViewRecord record(5, "map");
  record.add(patch(0, 1 * kSecond));
  CloudSlice of_guest = patch(1, 2 * kSecond);
  of_guest.keyframe = -1;
  record.add(of_guest);
  record.add(view_at(1.0, 3 * kSecond));
  record.add(correction(1, 4 * kSecond, {{0, shifted(10)}, {1, shifted(20)}}));
  EXPECT_EQ(places_of(record), std::vector<double>{11.0});
}

TEST(ViewRecord, SlicesMayComeLaterThanTheViews) {
  // The same as they would be without delay: the view of second 5 is in the map before the
  // correction, that of second 7 in the map after it.
  ViewRecord record(5, "map");
  for (const auto& [x_m, second] : {std::pair{1.0, 3}, {2.0, 5}, {13.0, 7}}) {
    record.add(view_at(x_m, second * kSecond));
  }
  record.add(patch(0, 2 * kSecond));
  record.add(correction(1, 6 * kSecond, {{0, shifted(10)}}));
  record.add(patch(1, 8 * kSecond));
  record.add(correction(2, 9 * kSecond, {{0, shifted(20)}}));
  EXPECT_EQ(places_of(record), (std::vector<double>{21.0, 22.0, 23.0}));
}

TEST(ViewRecord, ViewsOfAnotherPartAreKeptWithIt) {
  ViewRecord record(5, "map");
  record.add(patch(0, 1 * kSecond));
  record.add(view_at(1.0, 2 * kSecond));
  record.add(view_at(1001.0, 3 * kSecond, 1));
  record.add(patch(1, 4 * kSecond, 1));
  record.add(view_at(1002.0, 5 * kSecond, 1));
  CloudSlice joins = correction(1, 6 * kSecond, {{1, shifted(-990)}});
  record.add(joins);
  const ViewSet views = record.views();
  EXPECT_EQ(places_of(record), (std::vector<double>{1.0, 11.0, 12.0}));
  for (const KeptView& view : views.views) EXPECT_EQ(view.part, 0);
}

TEST(ViewRecord, IsBoundedAndGivesUpTheMostSimilar) {
  ViewRecord record(5, "map");
  // Two walks: a slow one of many views, later a fast one along the same places.
  const auto limit = static_cast<int>(ViewRecord::kMaxViews);
  for (int i = 0; i < limit; ++i) record.add(view_at(0.5 * i, i * kSecond / 10));
  for (int i = 0; i < 100; ++i) record.add(view_at(5.0 * i, (i + 1000) * kSecond));
  const ViewSet views = record.views();
  EXPECT_EQ(views.views.size(), ViewRecord::kMaxViews);
  EXPECT_EQ(views.views.front().utime, 0);
  const auto num_fast = std::ranges::count_if(
      views.views, [](const KeptView& view) { return view.utime >= 1000 * kSecond; });
  EXPECT_EQ(num_fast, 100);  // they are far apart in place and time
}

TEST(ViewRecord, AViewHasItsDepthAndTheCameraOfItsSamples) {
  ViewRecord record(5, "map");
  CameraView message = testing::view_of_wall(5, Pose::Identity(), 2.0);
  testing::depth_mm(message, 3, 7) = 0;
  testing::depth_mm(message, 4, 7) = 65'535;
  record.add(message);
  const ViewSet views = record.views();
  EXPECT_EQ(views.map_session, 5);
  EXPECT_EQ(views.map_name, "map");
  ASSERT_EQ(views.views.size(), 1U);
  const MapView view = unpacked(views.views[0], [](auto) { return std::nullopt; });
  EXPECT_EQ(view.depth_mm, message.depth_mm);
  EXPECT_EQ(view.utime, message.utime);
  EXPECT_EQ(view.intrinsics.width, 160);
  EXPECT_EQ(view.intrinsics.height, 120);
  // The sample (i, j) is that of pixel (4 i + 2, 4 j + 2): both cameras give it the same ray.
  EXPECT_DOUBLE_EQ((10 - view.intrinsics.cx) / view.intrinsics.fx, (42 - 319.5) / 525);
  EXPECT_DOUBLE_EQ((20 - view.intrinsics.cy) / view.intrinsics.fy, (82 - 239.5) / 525);
}

TEST(PackedDepth, RefusesOtherBytes) {
  const std::vector<std::uint16_t> depth_mm{1, 2, 0, 65'535, 5, 6};
  std::vector<std::uint8_t> packed = pack_depth(depth_mm, 3);
  EXPECT_EQ(unpack_depth(packed, 3, 2), depth_mm);
  EXPECT_THROW(unpack_depth(packed, 3, 3), std::invalid_argument);
  EXPECT_THROW(unpack_depth(packed, 3, 1), std::invalid_argument);
  packed.push_back(0);
  EXPECT_THROW(unpack_depth(packed, 3, 2), std::invalid_argument);
  packed.resize(4);
  EXPECT_THROW(unpack_depth(packed, 3, 2), std::invalid_argument);
  EXPECT_THROW(unpack_depth({}, 3, 2), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::segmenter
