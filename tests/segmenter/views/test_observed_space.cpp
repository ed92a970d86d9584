// What views tell about places.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <random>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/views/observed_space.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr double kVoxel_m = 0.01;

/// A camera at the origin that measures the same depth everywhere.
MapView wall(double depth_m) {
  MapView view;
  view.intrinsics = {.fx = 130, .fy = 130, .cx = 79.5, .cy = 59.5, .width = 160, .height = 120};
  view.depth_mm.assign(std::size_t{160} * 120, static_cast<std::uint16_t>(1e3 * depth_m));
  return view;
}

std::uint16_t& depth_at(MapView& view, int i, int j) {
  return view.depth_mm.at(static_cast<std::size_t>(j) *
                              static_cast<std::size_t>(view.intrinsics.width) +
                          static_cast<std::size_t>(i));
}

Sights sights_of(const MapView& view, const Eigen::Vector3f& p_W) {
  ObservedSpace space(kVoxel_m);
  space.add(view);
  return space.sights(p_W);
}

constexpr Sights kNothing{};
constexpr Sights kThrough{.through = 1};
constexpr Sights kMeasured{.measured = 1};

TEST(ObservedSpace, TellsWhatIsBeforeOnAndBehindASurface) {
  const MapView view = wall(2.0);
  EXPECT_EQ(sights_of(view, {0, 0, 1.5F}), kThrough);
  EXPECT_EQ(sights_of(view, {0.3F, 0.2F, 2.0F}), kMeasured);
  EXPECT_EQ(sights_of(view, {0, 0, 2.5F}), kNothing);
}

TEST(ObservedSpace, TellsNothingOutsideOfTheViews) {
  const MapView view = wall(2.0);
  EXPECT_EQ(sights_of(view, {0, 0, -1.0F}), kNothing);
  EXPECT_EQ(sights_of(view, {0, 0, 0}), kNothing);
  EXPECT_EQ(sights_of(view, {3, 0, 1}), kNothing);
  EXPECT_EQ(sights_of(view, {0, -3, 1}), kNothing);
  EXPECT_EQ(sights_of(view, {NAN, 0, 1}), kNothing);
}

TEST(ObservedSpace, MarginGrowsWithTheNoiseOfTheCamera) {
  // Three standard deviations at 1 m are 6 mm, less than the voxel; at 4 m they are 8 cm.
  EXPECT_EQ(sights_of(wall(1.0), {0, 0, 0.985F}), kThrough);
  EXPECT_EQ(sights_of(wall(1.0), {0, 0, 0.995F}), kMeasured);
  EXPECT_EQ(sights_of(wall(4.0), {0, 0, 3.94F}), kMeasured);
  EXPECT_EQ(sights_of(wall(4.0), {0, 0, 3.85F}), kThrough);
}

TEST(ObservedSpace, SaysNothingWhereNothingIsMeasured) {
  MapView view = wall(2.0);
  depth_at(view, 80, 60) = 0;
  for (const float x : {-0.003F, 0.003F, 0.012F}) {
    EXPECT_EQ(sights_of(view, {x, x, 1.5F}), kNothing) << x;
  }
  EXPECT_EQ(sights_of(view, {0.1F, 0.1F, 1.5F}), kThrough);
}

TEST(ObservedSpace, SaysNothingBesideWhatIsInFront) {
  // A thin thing at 1 m in column 80: what is next to it may be hidden by it, or be part of it.
  MapView view = wall(2.0);
  for (int j = 0; j < 120; ++j) depth_at(view, 80, j) = 1000;
  const auto x_of = [](double u_px, double z_m) {
    return static_cast<float>((u_px - 79.5) / 130 * z_m);
  };
  EXPECT_EQ(sights_of(view, {x_of(79, 1.0), 0, 1.0F}), kNothing);
  EXPECT_EQ(sights_of(view, {x_of(80, 1.0), 0, 1.0F}), kMeasured);
  EXPECT_EQ(sights_of(view, {x_of(80, 1.5), 0, 1.5F}), kNothing);  // the wall is seen beside it
  EXPECT_EQ(sights_of(view, {x_of(78, 1.0), 0, 1.0F}), kNothing);  // a voxel is 1.3 pixels here
  EXPECT_EQ(sights_of(view, {x_of(77, 1.0), 0, 1.0F}), kThrough);
}

TEST(ObservedSpace, TellsWhatCoversTheSideOfASurfaceThatAViewLooksAt) {
  ObservedSpace space(kVoxel_m);
  space.add(wall(2.0));
  const std::vector<std::size_t> views = {0};
  const Eigen::Vector3f to_camera = -Eigen::Vector3f::UnitZ();
  const auto is_covered = [&](float z_m, const Eigen::Vector3f& normal_W, float within_m) {
    constexpr float kGrazing = 0.2F;
    return space.sights({0, 0, z_m}, normal_W, kGrazing, within_m, views).is_covered;
  };
  EXPECT_TRUE(is_covered(2.5F, to_camera, 0.6F));
  EXPECT_FALSE(is_covered(2.5F, to_camera, 0.4F));
  EXPECT_FALSE(is_covered(2.5F, -to_camera, 0.6F));
  EXPECT_FALSE(is_covered(2.5F, Eigen::Vector3f(1.0F, 0.0F, -0.1F).normalized(), 0.6F));
  EXPECT_FALSE(is_covered(2.0F, to_camera, 0.6F));
  EXPECT_FALSE(is_covered(1.5F, to_camera, 0.6F));
  EXPECT_FALSE(space.sights({0, 0, 2.5F}, to_camera, 0.2F, 0.6F, {}).is_covered);
  EXPECT_EQ(space.sights({0, 0, 1.5F}, to_camera, 0.2F, 0.6F, views).sights, kThrough);
  EXPECT_EQ(space.sights({0, 0, 2.0F}, to_camera, 0.2F, 0.6F, views).sights, kMeasured);
}

TEST(ObservedSpace, LeavesOutViewsThatMeasuredAllFarInFront) {
  ObservedSpace space(kVoxel_m);
  MapView near = wall(1.0);
  depth_at(near, 20, 20) = 1400;
  space.add(near);
  space.add(wall(3.0));
  using ::testing::ElementsAre;
  EXPECT_THAT(space.views_of({0, 0, 2.5F}, 0.9F), ElementsAre(1));
  EXPECT_THAT(space.views_of({0, 0, 2.5F}, 1.2F), ElementsAre(0, 1));
  EXPECT_THAT(space.views_of({0, 0, 2.5F}, 0.9F, 0.3F), ElementsAre(0, 1)) << "it may cover it";
  EXPECT_THAT(space.views_of({0, 0, 3.04F}, 0.0F), ElementsAre(1)) << "within its noise";
  EXPECT_THAT(space.views_of({0, 0, 9.0F}, 0.5F), ElementsAre());
}

TEST(ObservedSpace, CountsEachView) {
  ObservedSpace space(kVoxel_m);
  EXPECT_TRUE(space.empty());
  MapView turned = wall(2.0);
  turned.X_WC.linear() = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitY()).matrix();
  turned.X_WC.translation() << 0, 0, 3.0;
  for (const double depth_m : {1.0, 2.0, 2.0, 3.0}) space.add(wall(depth_m));
  space.add(turned);  // it looks at the others, and measures a surface at z = 1
  EXPECT_EQ(space.sights(Eigen::Vector3f(0, 0, 2.0F)), (Sights{.through = 2, .measured = 2}));
  space.clear();
  EXPECT_TRUE(space.empty());
  EXPECT_EQ(space.sights(Eigen::Vector3f(0, 0, 2.0F)), kNothing);
}

TEST(ObservedSpace, ManyPlacesAreToldAsEachAlone) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  ObservedSpace space(kVoxel_m);
  for (int i = 0; i < 20; ++i) {
    MapView view = wall(1.5 + number(random));
    const Eigen::Vector3d axis(number(random), number(random), number(random));
    view.X_WC.linear() = Eigen::AngleAxisd(3.0 * number(random), axis.normalized()).matrix();
    view.X_WC.translation() << number(random), number(random), number(random);
    space.add(view);
  }
  std::vector<Eigen::Vector3f> points_W{{NAN, 0, 0}, {1e30F, 0, 0}};
  for (int i = 0; i < 3000; ++i) {
    points_W.emplace_back(3 * number(random), 3 * number(random), 3 * number(random));
  }
  const std::vector<Sights> all = space.sights(points_W);
  int num_seen = 0;
  for (std::size_t i = 0; i < points_W.size(); ++i) {
    EXPECT_EQ(all[i], space.sights(points_W[i])) << points_W[i].transpose();
    num_seen += all[i] != kNothing;
  }
  EXPECT_GT(num_seen, 250);

  const Eigen::Vector3f center_W(1.5F, 0.2F, -0.3F);
  const std::vector<std::size_t> views = space.views_of(center_W, 0.5F);
  EXPECT_LT(views.size(), 12U);
  constexpr float kWithin_m = 0.4F;
  const std::vector<std::size_t> covering = space.views_of(center_W, 0.5F, kWithin_m);
  std::vector<std::size_t> every(20);
  std::iota(every.begin(), every.end(), std::size_t{0});
  int num_covered = 0;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3f p_W =
        center_W +
        0.28F * Eigen::Vector3d(number(random), number(random), number(random)).cast<float>();
    EXPECT_EQ(space.sights(p_W, views), space.sights(p_W));
    const Eigen::Vector3f normal_W =
        Eigen::Vector3d(number(random), number(random), number(random)).cast<float>().normalized();
    const SightsOfSurface some = space.sights(p_W, normal_W, 0.1F, kWithin_m, covering);
    const SightsOfSurface all_of_them = space.sights(p_W, normal_W, 0.1F, kWithin_m, every);
    EXPECT_EQ(some.sights, all_of_them.sights);
    EXPECT_EQ(some.is_covered, all_of_them.is_covered);
    num_covered += some.is_covered ? 1 : 0;
  }
  EXPECT_GT(num_covered, 5);
}

TEST(ObservedSpace, RefusesAViewThatHasNotItsDepths) {
  ObservedSpace space(kVoxel_m);
  MapView view = wall(1.0);
  view.depth_mm.pop_back();
  EXPECT_THROW(space.add(view), std::invalid_argument);
  view.intrinsics.width = 0;
  EXPECT_THROW(space.add(view), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::segmenter
