#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "lcmtypes/messages.hpp"
#include "viewer/core/drawing/palette.hpp"
#include "viewer/core/figure/camera_panel.hpp"
#include "viewer/core/map/received_map.hpp"
#include "viewer/core/view/camera_image.hpp"
#include "viewer/core/view/view_segments.hpp"

namespace kintsugi::viewer {
namespace {

constexpr std::int64_t kSession = 7;
constexpr float kVoxel_m = 0.01F;
constexpr int kStep = 4;

/// A camera at W's origin, with a focal length of 320 pixels of 640 x 480.
CameraView view_at(double depth_m) {
  CameraView view;
  view.utime = 1;
  view.session = kSession;
  view.state = TrackingState::kTracking;
  view.intrinsics = {.fx = 320, .fy = 320, .cx = 319.5, .cy = 239.5, .width = 640, .height = 480};
  view.depth_step = kStep;
  view.depth_mm.assign(std::size_t{160} * 120,
                       static_cast<std::uint16_t>(std::lround(1000.0 * depth_m)));
  return view;
}

/// A wall across the camera's picture, facing it, as one slice. Left of x = 0 it is segment `left`,
/// right of it segment `right`.
void add_wall(ReceivedMap& map, std::int32_t id, float z_m, std::uint32_t left,
              std::uint32_t right) {
  CloudSlice slice;
  slice.id = id;
  slice.session = kSession;
  slice.resolution_m = kVoxel_m;
  SegmentUpdate update;
  update.map_session = kSession;
  update.session = 1;
  update.sequence = id;
  update.slice_id = id;
  const int reach = static_cast<int>(1.1F * z_m / kVoxel_m);
  for (int i = -reach; i < reach; ++i) {
    for (int j = -reach; j < reach; ++j) {
      const float x = (static_cast<float>(i) + 0.5F) * kVoxel_m;
      const float y = (static_cast<float>(j) + 0.5F) * kVoxel_m;
      slice.points_W.push_back({.x = x, .y = y, .z = z_m, .nz = -1.0F});
      update.labels.push_back(x < 0.0F ? left : right);
    }
  }
  map.add_slice(slice);
  map.apply_update(update);
}

double share_of(const IdImage& ids, std::uint32_t id) {
  return cv::countNonZero(ids == static_cast<std::int32_t>(id)) / static_cast<double>(ids.total());
}

TEST(SegmentsInView, AreThoseThatTheCameraLooksAtInEachPixel) {
  ReceivedMap map(kSession);
  add_wall(map, 0, 2.0F, 3, 4);
  const IdImage ids = segments_in_view(map.chunks(0), view_at(2.0), {320, 240}, {});
  for (int v = 0; v < ids.rows; ++v) {
    for (int u = 0; u < ids.cols; ++u) {
      // x = 0 is at u = 159.5; half of a disc of one voxel is 0.8 pixels.
      if (std::abs(u - 159.5) < 1.5) continue;
      EXPECT_EQ(u < 160 ? 3 : 4, ids(v, u)) << u << ' ' << v;
    }
  }
}

TEST(SegmentsInView, DoNotShineThroughWhatIsNotSegmentedYet) {
  ReceivedMap map(kSession);
  add_wall(map, 0, 2.0F, 3, 4);
  CameraView view = view_at(2.0);
  // Something new, 12 cm in front of the wall, in the left quarter of the picture.
  for (int v = 0; v < 120; ++v) {
    for (int u = 0; u < 40; ++u) view.depth_mm[std::size_t{160} * v + u] = 1'880;
  }
  const IdImage ids = segments_in_view(map.chunks(0), view, {160, 120}, {});
  EXPECT_EQ(0, cv::countNonZero(ids.colRange(0, 40)));
  EXPECT_EQ(0, cv::countNonZero(ids.colRange(40, 79) != 3));
}

TEST(SegmentsInView, AreNotCoveredByWhatIsNoLongerThere) {
  ReceivedMap map(kSession);
  add_wall(map, 0, 2.0F, 3, 4);
  add_wall(map, 1, 1.0F, 8, 9);
  EXPECT_EQ(0.0, share_of(segments_in_view(map.chunks(0), view_at(2.0), {160, 120}, {}), 8));
  EXPECT_GT(share_of(segments_in_view(map.chunks(0), view_at(2.0), {160, 120}, {}), 3), 0.48);
  EXPECT_GT(share_of(segments_in_view(map.chunks(0), view_at(1.0), {160, 120}, {}), 8), 0.48);
}

TEST(SegmentsInView, AreNoneWithoutADepthOrAPose) {
  ReceivedMap map(kSession);
  add_wall(map, 0, 2.0F, 3, 4);
  EXPECT_EQ(1.0, share_of(segments_in_view(map.chunks(0), view_at(0.0), {160, 120}, {}), 0));
  CameraView lost = view_at(2.0);
  lost.state = TrackingState::kLost;
  EXPECT_EQ(1.0, share_of(segments_in_view(map.chunks(0), lost, {160, 120}, {}), 0));
}

TEST(MeasuredDepth, IsExactOnASlantedPlaneAndHasNoDepthBetweenTwoSurfaces) {
  CameraView view = view_at(0.0);
  // On the plane z = 2 m + x / 2, 1 / z = (1 - (u - cx) / fx / 2) / 2.
  const auto plane_m = [&](double u) { return 2.0 / (1.0 - 0.5 * (u - 319.5) / 320.0); };
  for (int v = 0; v < 120; ++v) {
    for (int u = 0; u < 160; ++u) {
      const double depth_m = v < 60 ? plane_m(u * kStep + 2.0) : 0.5;
      view.depth_mm[std::size_t{160} * v + u] =
          static_cast<std::uint16_t>(std::lround(1000.0 * depth_m));
    }
  }
  const MeasuredDepth measured = measured_depth(view, {640, 480});
  for (int u = 2; u < 638; ++u) {
    EXPECT_NEAR(plane_m(u), measured.depth_m(100, u), 0.001) << u;
    for (int v = 0; v < 480; ++v) {
      const float depth_m = measured.depth_m(v, u);
      EXPECT_TRUE(depth_m > 1.3F || std::abs(depth_m - 0.5F) < 1e-6F) << u << ' ' << v;
    }
  }
}

TEST(CameraPanel, TintsSegmentsOutlinesThemAndLeavesTheRestAsItIs) {
  ReceivedMap map(kSession);
  add_wall(map, 0, 2.0F, 3, 0);  // the right half has no segment
  CameraView view = view_at(2.0);
  const cv::Mat3b grey(240, 320, cv::Vec3b::all(100));
  cv::imencode(".jpg", grey, view.color_jpeg);
  const cv::Mat3b panel = draw_camera_panel(map.chunks(0), view, {640, 480}, {}, {}, {});
  ASSERT_EQ(cv::Size(640, 480), panel.size());
  EXPECT_LT(cv::norm(panel(300, 500) - cv::Vec3b::all(100)), 4.0);
  const cv::Vec3b color = segment_color(3);
  const cv::Vec3d inside = cv::Vec3d(panel(300, 100));
  // Between the image's colour and the segment's, at its edge nearly the segment's.
  EXPECT_NEAR(
      0.45,
      cv::norm(inside - cv::Vec3d::all(100)) / cv::norm(cv::Vec3d(color) - cv::Vec3d::all(100)),
      0.05);
  double nearest = INFINITY;
  for (int u = 310; u < 326; ++u) {
    nearest = std::min(nearest, cv::norm(cv::Vec3d(panel(300, u)) - cv::Vec3d(color)));
  }
  EXPECT_LT(nearest, 12.0);

  const cv::Mat3b dark = draw_camera_panel(map.chunks(0), view, {640, 480}, {99}, {}, {});
  EXPECT_LT(cv::mean(dark.rowRange(60, 480))[0], 50.0);  // another segment is highlighted
}

TEST(CameraPanel, ShowsTheDepthWhenThereIsNoColorThatCanBeRead) {
  const ReceivedMap map(kSession);
  CameraView view = view_at(2.0);
  std::fill_n(view.depth_mm.begin(), 160 * 60, std::uint16_t{0});
  for (const bool has_garbage : {false, true}) {
    if (has_garbage) view.color_jpeg.assign(500, 0xab);
    const cv::Mat3b panel = draw_camera_panel(map.chunks(0), view, {160, 120}, {}, {}, {});
    EXPECT_EQ(cv::Vec3b::all(0), panel(50, 80));
    EXPECT_NEAR(127.0, panel(90, 80)[0], 2.0);  // half as bright at 2 m
    EXPECT_EQ(panel(90, 80)[0], panel(90, 80)[2]);
  }
}

TEST(CameraPanel, KeepsTheShapeOfTheImage) {
  const CameraView view = view_at(1.0);
  EXPECT_EQ(cv::Size(640, 480), camera_panel_size(view, {640, 500}));
  EXPECT_EQ(cv::Size(400, 300), camera_panel_size(view, {800, 300}));
}

}  // namespace
}  // namespace kintsugi::viewer
