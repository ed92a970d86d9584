#include <set>

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include "tests/viewer/support/synthetic_room.hpp"
#include "viewer/core/charts/axes.hpp"
#include "viewer/core/charts/chart.hpp"
#include "viewer/core/drawing/palette.hpp"
#include "viewer/core/figure/map_renderer.hpp"

namespace kintsugi::viewer {
namespace {

MapRenderer::Config small() {
  MapRenderer::Config config;
  config.width_px = 480;
  config.height_px = 270;
  return config;
}

/// A furnished room with its segments, and the smoothed camera.
struct Furnished {
  ReceivedMap map{1'000};
  SmoothedCamera depth_camera;

  explicit Furnished(bool segmented = true) {
    const SyntheticMap room = make_room(4.0, 0.04);
    for (const CloudSlice& slice : room.slices) map.add_slice(slice);
    for (std::size_t i = 0; segmented && i < room.updates.size(); ++i) {
      map.apply_update(room.updates[i]);
    }
    for (const CameraPose& pose : room.poses) {
      map.add_pose(pose);
      depth_camera.update(pose, map.up(0).up_W());
    }
  }

  Subject seen(const Viewpoint& viewpoint) const {
    return {map, 0, map.received_track(0), depth_camera, viewpoint};
  }
};

double share_of(const cv::Mat3b& image, const cv::Vec3b& color) {
  cv::Mat mask;
  cv::inRange(image, color, color, mask);
  return cv::countNonZero(mask) / static_cast<double>(mask.total());
}

TEST(MapRenderer, DrawsAnEmptyMap) {
  const ReceivedMap map(1);
  const cv::Mat3b figure =
      MapRenderer(small()).draw_figure({map, 0, {}, {}, FollowViewpoint{}}, "nothing");
  EXPECT_EQ(cv::Size(480, 270), figure.size());
  EXPECT_GT(share_of(figure, palette::kBackground), 0.8);
}

TEST(MapRenderer, ShowsTheFloorInItsColorFromAbove) {
  const Furnished room;
  const Viewpoint from_above = FixedViewpoint{{0.0, -8.0, 2.0}, {0.0, 0.0, 2.001}};
  const cv::Mat3b map = MapRenderer(small()).draw_map(room.seen(from_above), Coloring::kTrue);
  // The ceiling faces away and is not drawn. The floor is (150, 118, 84), plus or minus 8, seen at
  // a right angle: full brightness, apart from edges. A pixel with neither desk nor path:
  const cv::Vec3b& floor = map(135 + 20, 240 + 40);
  EXPECT_NEAR(84, floor[0], 12);
  EXPECT_NEAR(118, floor[1], 12);
  EXPECT_NEAR(150, floor[2], 12);
}

TEST(MapRenderer, ShowsAMapWithoutColoursInGreyAndNotInBlack) {
  Furnished room;
  SyntheticMap colorless = make_room(4.0, 0.04);
  for (CloudSlice& slice : colorless.slices) {
    ++slice.revision;
    for (CloudPoint& point : slice.points_W) point.red = point.green = point.blue = 0;
    room.map.add_slice(slice);
  }
  for (SegmentUpdate& update : colorless.updates) {
    ++update.slice_revision;
    for (LabelRun& run : update.runs) ++run.slice_revision;
    update.sequence += 1000;
    room.map.apply_update(update);
  }
  const Viewpoint from_above = FixedViewpoint{{0.0, -8.0, 2.0}, {0.0, 0.0, 2.001}};
  const cv::Mat3b map = MapRenderer(small()).draw_map(room.seen(from_above), Coloring::kTrue);
  const cv::Vec3b& floor = map(135 + 20, 240 + 40);
  EXPECT_EQ(floor[0], floor[1]);
  EXPECT_EQ(floor[1], floor[2]);
  EXPECT_GT(floor[0], 150);
}

TEST(MapRenderer, DrawsALineBetweenTheTwoPlacesOfALoop) {
  const Furnished room;
  Subject subject = room.seen(FixedViewpoint{{0.0, -8.0, 2.0}, {0.0, 0.0, 2.001}});
  subject.track = {};
  const auto draw = [&] { return MapRenderer(small()).draw_map(subject, Coloring::kTrue); };
  EXPECT_EQ(share_of(draw(), palette::kLoop), 0.0);
  subject.track.loops = {
      {.later = 3, .earlier = 1, .later_W = {0.5, 0, 2}, .earlier_W = {-0.5, 0, 2}}};
  const cv::Mat3b long_one = draw();
  const cv::Vec3b loop = palette::kLoop;
  for (int i = 0; i < 3; ++i) {  // halfway between them; the edges of a line are blended
    EXPECT_NEAR(long_one(135, 240)[i], loop[i], 40);
  }
  subject.track.loops[0].earlier_W[0] = 0.5;
  EXPECT_GT(share_of(draw(), palette::kLoop), 0.0) << "a dot where both are the same";
}

TEST(MapRenderer, ShowsSegmentsInTheirColorsAndGreyWithoutASegmenter) {
  const Viewpoint from_above = FixedViewpoint{{0.0, -8.0, 2.0}, {0.0, 0.0, 2.001}};
  const auto floor_of = [&](const Furnished& room) {
    return MapRenderer(small()).draw_map(room.seen(from_above), Coloring::kSegments)(155, 280);
  };
  const cv::Vec3b expected = segment_color(1);
  const cv::Vec3b segmented = floor_of(Furnished());
  const cv::Vec3b grey = floor_of(Furnished(false));
  const cv::Vec3b unlabelled = palette::kUnlabelledPoint;
  for (int i = 0; i < 3; ++i) {
    // At this angle shading darkens by at most a tenth; a plane has no edges.
    EXPECT_NEAR(expected[i], segmented[i], 0.1 * expected[i] + 2);
    EXPECT_NEAR(unlabelled[i], grey[i], 0.1 * unlabelled[i] + 2);
  }
}

TEST(MapRenderer, ShowsOnlyTheNewestRevisionOfEachSlice) {
  const SyntheticMap room = make_room(4.0, 0.04);
  SyntheticMap moved = room;
  for (std::size_t i = 0; i < room.slices.size(); i += 3) {
    moved.slices[i].revision = moved.updates[i].slice_revision = 1;
    moved.updates[i].sequence += std::ssize(room.updates);
    for (CloudPoint& point : moved.slices[i].points_W) point.x += 0.3F;
  }
  ReceivedMap corrected(1'000);
  ReceivedMap expected(1'000);
  for (std::size_t i = 0; i < room.slices.size(); ++i) {
    corrected.add_slice(room.slices[i]);
    corrected.apply_update(room.updates[i]);
    expected.add_slice(moved.slices[i]);
    expected.apply_update(moved.updates[i]);
  }
  const Viewpoint view = FixedViewpoint{{0.0, -8.0, 2.0}, {0.0, 0.0, 2.001}};
  const auto difference = [&] {
    const MapRenderer renderer(small());
    return cv::norm(renderer.draw_map({corrected, 0, {}, {}, view}, Coloring::kSegments),
                    renderer.draw_map({expected, 0, {}, {}, view}, Coloring::kSegments),
                    cv::NORM_INF);
  };
  EXPECT_GT(difference(), 0.0);
  for (std::size_t i = 0; i < room.slices.size(); i += 3) {
    corrected.add_slice(moved.slices[i]);
    corrected.apply_update(moved.updates[i]);
  }
  EXPECT_EQ(0.0, difference());
}

TEST(MapRenderer, DrawsTheSameBytesOnAnyNumberOfThreads) {
  const Furnished room;
  const auto draw = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return MapRenderer(small()).draw_figure(room.seen(FollowViewpoint{}), "caption");
  };
  EXPECT_EQ(0.0, cv::norm(draw(1), draw(4), cv::NORM_INF));
}

TEST(MapRenderer, FillsAnyReasonableSize) {
  const Furnished room;
  for (const cv::Size size : {cv::Size(160, 120), cv::Size(333, 777), cv::Size(800, 200)}) {
    MapRenderer::Config config = small();
    config.width_px = size.width;
    config.height_px = size.height;
    const MapRenderer renderer(config);
    EXPECT_EQ(size, renderer.draw_figure(room.seen(OverviewViewpoint{}), "caption").size());
    EXPECT_EQ(size, renderer.draw_map(room.seen(FollowViewpoint{}), Coloring::kTrue).size());
  }
}

TEST(MapRenderer, RefusesAConfigurationOutOfItsBounds) {
  for (const auto spoil : std::initializer_list<void (*)(MapRenderer::Config&)>{
           [](MapRenderer::Config& c) { c.width_px = 10; },
           [](MapRenderer::Config& c) { c.height_px = 100'000; },
           [](MapRenderer::Config& c) { c.supersampling = 0; },
           [](MapRenderer::Config& c) { c.frustum_m = -1.0; },
           [](MapRenderer::Config& c) { c.splat.radius_vox = -1.0; },
           [](MapRenderer::Config& c) { c.viewpoint.field_of_view_rad = 4.0; },
           [](MapRenderer::Config& c) { c.viewpoint.follow_radius_m = NAN; }}) {
    MapRenderer::Config config = small();
    spoil(config);
    EXPECT_THROW(MapRenderer{config}, std::invalid_argument);
  }
}

TEST(Caption, SaysWhatIsShown) {
  const Furnished room(false);
  EXPECT_NE(std::string::npos, caption(room.map, 0).find("0 segments   16 slices   lag 16"))
      << caption(room.map, 0);
}

TEST(Caption, TellsThePartOfAMapOfSeveral) {
  const SyntheticMap room = make_room(4.0, 0.04);
  ReceivedMap map(1'000);
  for (CloudSlice slice : room.slices) {
    slice.part = slice.id == 3 ? 2 : 0;
    if (slice.part == 2) slice.points_W.resize(7);
    slice.in_volume = slice.id == 3;
    map.add_slice(slice);
  }
  EXPECT_EQ(0U,
            final_caption(map, 2).find("part 2: 7 points   all 2 parts: 0 segments   16 slices"))
      << final_caption(map, 2);
  EXPECT_EQ(0U, final_caption(map, 0).find("part 0: ")) << final_caption(map, 0);
  EXPECT_NE(std::string::npos, caption(map, 2).find("100 % may change")) << caption(map, 2);
  EXPECT_EQ(std::string::npos, caption(map, 0).find("may change")) << caption(map, 0);
}

TEST(Chart, RoundsUpToOneTwoOrFive) {
  EXPECT_DOUBLE_EQ(1.0, round_up(0.0));
  EXPECT_DOUBLE_EQ(1.0, round_up(1.0));
  EXPECT_DOUBLE_EQ(2.0, round_up(1.1));
  EXPECT_DOUBLE_EQ(5.0, round_up(4.0));
  EXPECT_DOUBLE_EQ(1000.0, round_up(501.0));
  EXPECT_DOUBLE_EQ(0.02, round_up(0.013));
}

TEST(Chart, DrawsAlsoWithoutPoints) {
  const cv::Mat3b image =
      draw_charts(std::array{Chart{"a", {}}, Chart{"b", {{0, 1}, {5, 3}}}}, "slice", {300, 200});
  EXPECT_EQ(cv::Size(300, 200), image.size());
}

}  // namespace
}  // namespace kintsugi::viewer
