#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/objects/recognition/agreement.hpp"
#include "segmenter/objects/recognition/labelled_map.hpp"
#include "segmenter/objects/recognition/lit_model.hpp"
#include "segmenter/objects/recognition/scene_surface.hpp"
#include "segmenter/objects/recognition/surface.hpp"
#include "segmenter/objects/recognition/surface_field.hpp"

namespace kintsugi::segmenter {
namespace {

CloudPoint point(float x, float y, float z) {
  CloudPoint p;
  p.x = x;
  p.y = y;
  p.z = z;
  p.nz = 1.0F;
  p.red = p.green = p.blue = 255;
  return p;
}

std::vector<CloudPoint> random_points(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(0.0F, 0.2F);
  std::uniform_int_distribution<int> color(1, 255);
  std::vector<CloudPoint> points;
  points.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back(point(place(random), place(random), place(random)));
    points.back().red = static_cast<std::uint8_t>(color(random));
  }
  return points;
}

TEST(LabOf, HasTheKnownValuesOfPrimaryColours) {
  EXPECT_LT((lab_of({1, 1, 1}) - Eigen::Vector3f(100, 0, 0)).norm(), 0.05F);
  EXPECT_LT(lab_of({0, 0, 0}).norm(), 0.05F);
  // Lindbloom's calculator, sRGB and D65.
  EXPECT_LT((lab_of({1, 0, 0}) - Eigen::Vector3f(53.24F, 80.09F, 67.20F)).norm(), 0.1F);
  EXPECT_LT((lab_of({0, 0, 1}) - Eigen::Vector3f(32.30F, 79.19F, -107.86F)).norm(), 0.1F);
}

TEST(Thinned, HasTheMeanOfEachCube) {
  const Surface surface =
      thinned(std::vector{point(0.001F, 0, 0), point(0.003F, 0, 0), point(0.015F, 0, 0)}, 0.01F);
  ASSERT_EQ(surface.size(), 2U);
  EXPECT_FLOAT_EQ(surface[0].position.x(), 0.002F);
  EXPECT_FLOAT_EQ(surface[1].position.x(), 0.015F);
  EXPECT_EQ(surface[0].normal, Eigen::Vector3f::UnitZ());
}

TEST(Thinned, LeavesOutPointsWithoutNormalsAndBothSidesOfThinThings) {
  CloudPoint back = point(0.001F, 0, 0);
  back.nz = -1.0F;
  CloudPoint flat = point(0.05F, 0, 0);
  flat.nz = 0.0F;
  EXPECT_TRUE(thinned(std::vector{point(0.001F, 0, 0), back, flat}, 0.01F).empty());
}

TEST(Thinned, DoesNotDependOnTheOrder) {
  std::vector<CloudPoint> points = random_points(2000, 1);
  const Surface surface = thinned(points, 0.02F);
  std::shuffle(points.begin(), points.end(), std::mt19937(2));
  const Surface other = thinned(points, 0.02F);
  ASSERT_EQ(surface.size(), other.size());
  for (std::size_t i = 0; i < surface.size(); ++i) {
    EXPECT_EQ(surface[i].position, other[i].position);
    EXPECT_EQ(surface[i].lab, other[i].lab);
  }
}

TEST(SmoothColors, AreMeansWithinTheRadius) {
  Surface surface = unthinned(random_points(300, 3), 1e-4F);
  const Surface before = surface;
  constexpr float kRadius_m = 0.04F;
  smooth_colors(surface, kRadius_m);
  for (std::size_t i = 0; i < before.size(); ++i) {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    float count = 0.0F;
    for (const SurfacePoint& other : before) {
      if ((other.position - before[i].position).norm() > kRadius_m) continue;
      sum += other.rgb;
      count += 1.0F;
    }
    ASSERT_LT((surface[i].rgb - sum / count).norm(), 1e-5F) << i;
  }
}

TEST(SurfaceField, FindsTheNearestPointUpToHalfACell) {
  const Surface surface = unthinned(random_points(200, 4), 0.01F);
  const SurfaceField field(surface, 0.01F, 0.03F);
  for (const SurfacePoint& query : unthinned(random_points(500, 5), 0.01F)) {
    float least = 1e9F;
    for (const SurfacePoint& p : surface) {
      least = std::min(least, (p.position - query.position).norm());
    }
    const std::int32_t nearest = field.nearest(query.position);
    if (nearest < 0) {
      EXPECT_GE(least, 0.02F);
      continue;
    }
    const Eigen::Vector3f found = surface[static_cast<std::size_t>(nearest)].position;
    // To the middle of the cell and back: its diagonal.
    EXPECT_LE((found - query.position).norm(), least + 0.0175F);
  }
  EXPECT_EQ(field.nearest({9, 9, 9}), -1);
  EXPECT_EQ(field.nearest(Eigen::Vector3f::Constant(std::nanf(""))), -1);
}

TEST(SceneSurface, FindsTheNearestPointInAllBlocks) {
  const std::vector<CloudPoint> points = random_points(300, 6);
  LabelledMap map(0.05F);
  map.set_piece(0, std::make_shared<const std::vector<CloudPoint>>(points),
                std::vector<std::uint32_t>(points.size(), 1));
  const SceneSurface scene(map, 0.01F);
  constexpr float kWithin_m = 0.02F;
  for (const SurfacePoint& query : unthinned(random_points(500, 7), 0.01F)) {
    float least = kWithin_m;
    for (const CloudPoint& p : points) {
      least = std::min(least, (Eigen::Vector3f(p.x, p.y, p.z) - query.position).norm());
    }
    const SurfacePoint* const nearest = scene.nearest(query.position, kWithin_m, any_point);
    if (least < kWithin_m) {
      ASSERT_NE(nearest, nullptr);
      EXPECT_FLOAT_EQ((nearest->position - query.position).norm(), least);
    } else {
      EXPECT_EQ(nearest, nullptr);
    }
  }
  std::size_t count = 0;
  scene.visit({Eigen::Vector3f::Constant(-10.0F), Eigen::Vector3f::Constant(10.0F)},
              [&count](const SurfacePoint& /*point*/, std::uint32_t segment) {
                EXPECT_EQ(segment, 1U);
                ++count;
              });
  EXPECT_EQ(count, points.size());
}

TEST(LitModel, AllowsForTheLightOfThePlace) {
  SurfacePoint model;
  model.has_color = true;
  model.rgb = {0.5F, 0.4F, 0.3F};
  model.lab = lab_of(model.rgb);
  LightChange evening{{-0.2F, -0.4F, -1.0F}};
  SurfacePoint seen = model;
  seen.rgb = (model.rgb.array() * evening.log_gain.array().exp()).matrix();
  seen.lab = lab_of(seen.rgb);
  const Surface surface{model};
  const auto is_same = [&](const LightChange& light) {
    return LitModel(surface, light).same_color(0, seen);
  };
  EXPECT_FALSE(is_same({}));
  EXPECT_TRUE(is_same(evening));
  Surface relit{seen};
  relight(relit, (-evening.log_gain.array()).exp());
  EXPECT_LT((relit[0].lab - model.lab).norm(), 0.01F);
  seen.has_color = false;
  EXPECT_TRUE(is_same({}));
}

TEST(LightChange, IsBoundedInBrightnessAndTint) {
  LightChange light{{-5.0F, -5.0F, -5.0F}};
  light.limit();
  EXPECT_EQ(light.log_gain, Eigen::Vector3f::Constant(-LightChange::kMaxBrightness));
  light = {{1.0F, 0.0F, -1.0F}};
  light.limit();
  EXPECT_EQ(light.log_gain, Eigen::Vector3f(LightChange::kMaxTint, 0.0F, -LightChange::kMaxTint));
}

}  // namespace
}  // namespace kintsugi::segmenter
