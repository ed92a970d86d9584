#include <gtest/gtest.h>

#include "tests/viewer/support/patched_room.hpp"
#include "viewer/core/figure/run_figure.hpp"

namespace kintsugi::viewer {
namespace {

MapRenderer::Config small() {
  MapRenderer::Config config;
  config.width_px = 480;
  config.height_px = 270;
  config.supersampling = 1;
  return config;
}

class RunFigureTest : public ::testing::Test {
 protected:
  RunFigureTest() {
    for (std::size_t i = 0; i < room_.slices.size(); ++i) {
      map_.add_slice(room_.slices[i]);
      map_.apply_update(room_.updates[i]);
    }
    for (const CameraPose& pose : room_.poses) {
      map_.add_pose(pose);
      depth_camera_.update(pose, map_.up(0).up_W());
    }
  }

  Subject subject(const Viewpoint& viewpoint) const {
    return {map_, 0, map_.received_track(0), depth_camera_, viewpoint};
  }
  const CameraView& view() const { return room_.views.back(); }

  const SyntheticMap room_ = make_patched_room(3.0, 0.05);
  ReceivedMap map_{1'000};
  SmoothedCamera depth_camera_;
  const MapRenderer renderer_{small()};
};

double difference(const cv::Mat3b& a, const cv::Mat3b& b) { return cv::norm(a, b, cv::NORM_INF); }

TEST_F(RunFigureTest, IsTheFigureOfTheMapWithoutAView) {
  RunFigure figure(renderer_);
  const Subject seen = subject(OverviewViewpoint{});
  EXPECT_EQ(0.0, difference(renderer_.draw_figure(seen, "a"),
                            figure.draw(seen, nullptr, "a", RunFigure::Map::kMayBeOld)));
}

TEST_F(RunFigureTest, DrawsTheMapOnlyWhenItMust) {
  RunFigure figure(renderer_);
  Subject seen = subject(FollowViewpoint{});
  const cv::Mat3b first = figure.draw(seen, &view(), "a", RunFigure::Map::kMayBeOld);
  EXPECT_TRUE(figure.has_drawn_map());
  EXPECT_EQ(0.0, difference(first, figure.draw(seen, &view(), "a", RunFigure::Map::kMayBeOld)));
  EXPECT_FALSE(figure.has_drawn_map());
  EXPECT_EQ(0.0, difference(first, figure.draw(seen, &view(), "a", RunFigure::Map::kNew)));
  EXPECT_TRUE(figure.has_drawn_map());

  seen.track.X_WC->translation().x() += 0.02;  // the frustum moves a little
  EXPECT_LT(0.0, difference(first, figure.draw(seen, &view(), "a", RunFigure::Map::kMayBeOld)));
  EXPECT_FALSE(figure.has_drawn_map());
  seen.track.X_WC->translation().x() += 30.0;  // and out of the picture
  figure.draw(seen, &view(), "a", RunFigure::Map::kMayBeOld);
  EXPECT_TRUE(figure.has_drawn_map());
  seen.highlight = {1};
  figure.draw(seen, &view(), "a", RunFigure::Map::kMayBeOld);
  EXPECT_TRUE(figure.has_drawn_map());
}

TEST_F(RunFigureTest, DrawsAnotherPartOfTheMapAnew) {
  RunFigure figure(renderer_);
  Subject seen = subject(OverviewViewpoint{});
  const cv::Mat3b first = figure.draw(seen, &view(), "a", RunFigure::Map::kMayBeOld);
  seen.part = 1;  // there is nothing
  const cv::Mat3b nothing = figure.draw(seen, &view(), "a", RunFigure::Map::kMayBeOld);
  EXPECT_TRUE(figure.has_drawn_map());
  EXPECT_GT(difference(first, nothing), 0.0);
}

TEST_F(RunFigureTest, HasTheWholeFrustumInThePictureWhereverTheCameraIs) {
  for (const Viewpoint& viewpoint :
       {Viewpoint(FollowViewpoint{}), Viewpoint(OverviewViewpoint{})}) {
    for (const double x_m : {-40.0, -3.0, 0.0, 3.0, 40.0}) {
      for (const double turn_rad : {0.0, 1.0, 3.0, -2.0}) {
        Subject seen = subject(viewpoint);
        seen.track.X_WC->translation().x() += x_m;
        seen.track.X_WC->rotate(Eigen::AngleAxisd(turn_rad, Eigen::Vector3d(1, 1, 0).normalized()));
        const VirtualCamera camera =
            renderer_.map_pictures(seen, {200, 150}, {Coloring::kTrue}).front().camera;
        EXPECT_TRUE(is_in_picture(*renderer_.frustum(seen.track), camera))
            << x_m << ' ' << turn_rad;
      }
    }
  }
}

TEST_F(RunFigureTest, FillsAnyReasonableSize) {
  for (const cv::Size size : {cv::Size(160, 120), cv::Size(333, 777), cv::Size(800, 200)}) {
    MapRenderer::Config config = small();
    config.width_px = size.width;
    config.height_px = size.height;
    const MapRenderer renderer(config);
    RunFigure figure(renderer);
    Subject seen = subject(FollowViewpoint{});
    seen.highlight = {1};
    EXPECT_EQ(size, figure.draw(seen, &view(), "caption", RunFigure::Map::kNew).size());
  }
}

TEST_F(RunFigureTest, ObjectsAreDrawnOverAnOldMapToo) {
  RunFigure figure(renderer_);
  Subject seen = subject(OverviewViewpoint{});
  const cv::Mat3b without = figure.draw(seen, &view(), "a", RunFigure::Map::kMayBeOld);
  DrawnObject object;
  object.name = "desk";
  object.X_WO = view().X_WC;
  object.X_WO.translation() += 1.5 * object.X_WO.linear().col(2);
  object.box_min_O.setConstant(-0.3F);
  object.box_max_O.setConstant(0.3F);
  object.is_confirmed = true;
  seen.objects = {object};
  const cv::Mat3b with = figure.draw(seen, &view(), "a", RunFigure::Map::kMayBeOld);
  EXPECT_FALSE(figure.has_drawn_map());
  EXPECT_GT(difference(without.colRange(0, 240), with.colRange(0, 240)), 0.0) << "camera";
  EXPECT_GT(difference(without.colRange(320, 480), with.colRange(320, 480)), 0.0) << "map";
  seen.objects.clear();
  EXPECT_EQ(0.0, difference(without, figure.draw(seen, &view(), "a", RunFigure::Map::kMayBeOld)));
}

}  // namespace
}  // namespace kintsugi::viewer
