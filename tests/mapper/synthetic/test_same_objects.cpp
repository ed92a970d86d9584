// Scenes with the same objects in them: "office" at two times, and the office's things in the
// kitchen.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "mapper/synthetic/render/renderer.hpp"
#include "mapper/synthetic/rooms/scenes.hpp"
#include "mapper/synthetic/scene/object_model.hpp"
#include "mapper/synthetic/scene/scene_builder.hpp"

namespace kintsugi::synthetic {
namespace {

using Eigen::Vector3d;

const Instance* with_key(const Scene& scene, const std::string& key) {
  const auto found = std::ranges::find(scene.instances(), key, &Instance::key);
  return found == scene.instances().end() ? nullptr : &*found;
}

std::vector<Primitive> solids_of(const Scene& scene, int instance) {
  std::vector<Primitive> solids;
  std::ranges::copy_if(scene.primitives(), std::back_inserter(solids),
                       [&](const Primitive& p) { return p.instance == instance; });
  return solids;
}

Eigen::AlignedBox3d box_G(const Scene& scene, const Instance& instance) {
  Eigen::AlignedBox3d box;
  for (const Primitive& solid : solids_of(scene, instance.id)) {
    const Pose X_GO = instance.X_WG.inverse() * solid.X_WO;
    const Vector3d reach = X_GO.linear().cwiseAbs() * solid.shape.half_extents;
    box.extend(Vector3d(X_GO.translation() - reach));
    box.extend(Vector3d(X_GO.translation() + reach));
  }
  return box;
}

/// Keys of what changed.
struct Changes {
  std::vector<std::string> gone;
  std::vector<std::string> brought;
  std::vector<std::string> moved;
};

Changes changes(const Scene& before, const Scene& after) {
  Changes changes;
  for (const Instance& instance : before.instances()) {
    const Instance* const now = with_key(after, instance.key);
    if (now == nullptr) {
      changes.gone.push_back(instance.key);
    } else if (!now->X_WG.isApprox(instance.X_WG, 0.0)) {
      changes.moved.push_back(instance.key);
    }
  }
  for (const Instance& instance : after.instances()) {
    if (with_key(before, instance.key) == nullptr) changes.brought.push_back(instance.key);
  }
  return changes;
}

TEST(OfficeLater, TenThingsAreGoneTenNewAndTenMoved) {
  const Scene before = make_scene("office");
  const Scene after = make_scene("office-later");
  const auto [gone, brought, moved] = changes(before, after);
  EXPECT_EQ(gone.size(), 10U);
  EXPECT_EQ(brought.size(), 10U);
  EXPECT_EQ(moved.size(), 10U);
  int num_far = 0;
  for (const std::string& key : moved) {
    const Instance& was = *with_key(before, key);
    const Vector3d centre_G = box_G(before, was).center();
    const double moved_m = (with_key(after, key)->X_WG * centre_G - was.X_WG * centre_G).norm();
    if (moved_m > box_G(before, was).sizes().maxCoeff()) ++num_far;
  }
  EXPECT_EQ(num_far, 5);
}

TEST(OfficeLater, FiveOfTheChangesHaveTheColourOfWhatTheyStandOn) {
  const Scene after = make_scene("office-later");
  const auto [gone, brought, moved] = changes(make_scene("office"), after);
  std::vector<std::string> changed = brought;
  changed.insert(changed.end(), moved.begin(), moved.end());
  const auto has_colour_of = [&](const std::string& key, const std::string& name) {
    const auto carrier = std::ranges::find(after.instances(), name, &Instance::name);
    return with_key(after, key)->color == carrier->color;
  };
  EXPECT_EQ(std::ranges::count_if(changed,
                                  [&](const std::string& key) {
                                    return has_colour_of(key, "desk") ||
                                           has_colour_of(key, "floor") ||
                                           has_colour_of(key, "wall");
                                  }),
            5);
}

TEST(OfficeLater, TheRestIsWhereItWasAndAllOfItTheSameMake) {
  const Scene before = make_scene("office");
  const Scene after = make_scene("office-later");
  const auto [gone, brought, moved] = changes(before, after);
  for (const Instance& was : before.instances()) {
    const Instance* const is = with_key(after, was.key);
    if (is == nullptr) continue;
    const bool has_moved = std::ranges::count(moved, was.key) > 0;
    const auto solids_before = solids_of(before, was.id);
    const auto solids_after = solids_of(after, is->id);
    ASSERT_EQ(solids_before.size(), solids_after.size()) << was.key;
    for (std::size_t i = 0; i < solids_before.size(); ++i) {
      const Pose X_GO_before = was.X_WG.inverse() * solids_before[i].X_WO;
      const Pose X_GO_after = is->X_WG.inverse() * solids_after[i].X_WO;
      EXPECT_TRUE(X_GO_after.isApprox(X_GO_before, 1e-9)) << was.key;
      if (has_moved) continue;
      EXPECT_TRUE(solids_after[i].X_WO.isApprox(solids_before[i].X_WO, 0.0)) << was.key;
    }
  }
}

TEST(OfficeLater, IsTheSameEachTime) {
  const Scene once = make_scene("office-later");
  const Scene again = make_scene("office-later");
  ASSERT_EQ(once.instances().size(), again.instances().size());
  for (std::size_t i = 0; i < once.instances().size(); ++i) {
    EXPECT_EQ(once.instances()[i].key, again.instances()[i].key);
    EXPECT_TRUE(once.instances()[i].X_WG.isApprox(again.instances()[i].X_WG, 0.0));
  }
}

/// Points near the surface of an object, on a grid.
std::vector<Vector3d> surface_points_W(const std::vector<Primitive>& solids) {
  constexpr double kGrid_m = 0.005;
  std::vector<Vector3d> points_W;
  for (const Primitive& solid : solids) {
    const Vector3d& half = solid.shape.half_extents;
    for (double x = -half.x(); x <= half.x(); x += kGrid_m) {
      for (double y = -half.y(); y <= half.y(); y += kGrid_m) {
        for (double z = -half.z(); z <= half.z(); z += kGrid_m) {
          const Vector3d p_O(x, y, z);
          if (std::abs(signed_distance(solid.shape, p_O)) > kGrid_m / 2) continue;
          points_W.push_back(solid.X_WO * p_O);
        }
      }
    }
  }
  return points_W;
}

/// How far an instance reaches into others, metres: in its lowest centimetre, and above that.
std::pair<double, double> overlap_m(const Scene& scene, int instance) {
  std::vector<Primitive> others;
  std::ranges::copy_if(scene.primitives(), std::back_inserter(others),
                       [&](const Primitive& p) { return p.instance != instance; });
  const Scene rest(std::move(others), scene.instances());
  const auto points_W = surface_points_W(solids_of(scene, instance));
  double lowest_m = points_W.front().z();
  for (const Vector3d& p_W : points_W) lowest_m = std::min(lowest_m, p_W.z());
  std::pair<double, double> deepest_m(0.0, 0.0);
  for (const Vector3d& p_W : points_W) {
    double& deepest = p_W.z() < lowest_m + 0.011 ? deepest_m.first : deepest_m.second;
    deepest = std::max(deepest, -rest.signed_distance(p_W));
  }
  return deepest_m;
}

/// Thin things are let 1 cm into what they lie on, so that noise does not take them for it; others
/// no more than the grid of points tells from touching.
void expect_no_overlap(const Scene& scene, const Instance& instance) {
  const auto [foot_m, above_m] = overlap_m(scene, instance.id);
  EXPECT_LT(foot_m, 0.0131) << instance.key;
  EXPECT_LT(above_m, 0.0051) << instance.key;
}

TEST(OfficeLater, NothingThatChangedReachesIntoSomethingElse) {
  const Scene after = make_scene("office-later");
  const auto [gone, brought, moved] = changes(make_scene("office"), after);
  for (const std::string& key : brought) expect_no_overlap(after, *with_key(after, key));
  for (const std::string& key : moved) expect_no_overlap(after, *with_key(after, key));
}

/// Cells of 1 cm of each model's surface that the camera sees within the range of a Kinect.
std::map<std::string, std::size_t> seen_cells(const std::string& name) {
  const auto [scene, path] = make_scene_with_path(name);
  const Intrinsics camera = centred_camera(320, 240, 262.5);
  std::map<std::string, std::set<std::array<int, 3>>> cells;
  for (int frame = 0; frame < path.num_frames(); frame += 15) {
    const RenderedFrame seen = render(scene, camera, path.X_WC(frame / 30.0));
    for (int v = 0; v < camera.height; ++v) {
      for (int u = 0; u < camera.width; ++u) {
        const double z = seen.depth_m(v, u);
        if (!(z > 0.4 && z < 4.0)) continue;
        const Vector3d p_W = seen.X_WC * Vector3d((u - camera.cx) / camera.fx * z,
                                                  (v - camera.cy) / camera.fy * z, z);
        const Eigen::Vector3i cell = (p_W / 0.01).array().floor().cast<int>();
        cells[scene.instances()[seen.instances(v, u) - 1].key].insert(
            {cell.x(), cell.y(), cell.z()});
      }
    }
  }
  std::map<std::string, std::size_t> counts;
  for (const auto& [key, own] : cells) counts[key] = own.size();
  return counts;
}

/// A plane that is oblique to the grid touches up to 1.7 cells for each cm^2, on average 1.5.
constexpr std::size_t kCellsOf500cm2 = 750;

TEST(OfficeLater, MostOfWhatChangedIsWellSeenByBothPaths) {
  const auto before = seen_cells("office");
  const auto after = seen_cells("office-later");
  const auto [gone, brought, moved] = changes(make_scene("office"), make_scene("office-later"));
  const auto num_well_seen = [](const std::vector<std::string>& keys, const auto& cells) {
    return std::ranges::count_if(keys, [&](const std::string& key) {
      return cells.contains(key) && cells.at(key) >= kCellsOf500cm2;
    });
  };
  EXPECT_GE(num_well_seen(gone, before), 6);
  EXPECT_GE(num_well_seen(brought, after), 6);
  EXPECT_GE(num_well_seen(moved, before), 6);
  EXPECT_GE(num_well_seen(moved, after), 6);
}

TEST(OfficeAgain, IsTheOfficeFromElsewhereInAnotherLight) {
  const auto [before, path_before] = make_scene_with_path("office");
  const auto [again, path_again] = make_scene_with_path("office-again");
  const auto [gone, brought, moved] = changes(before, again);
  EXPECT_TRUE(gone.empty() && brought.empty() && moved.empty());
  EXPECT_EQ(before.light(), Color(Color::Ones()));
  EXPECT_LT(again.light().maxCoeff(), 1.0F);
  const Pose between = path_before.X_WC(0).inverse() * path_again.X_WC(0);
  EXPECT_GT(between.translation().norm(), 1.0);
  EXPECT_GT(Eigen::AngleAxisd(between.linear()).angle(), 0.3);
  const Pose later = make_scene_with_path("office-later").trajectory.X_WC(0);
  EXPECT_TRUE(later.isApprox(path_again.X_WC(0), 0.0));
}

TEST(Kitchen, HasFifteenThingsOfTheOfficeAmongOthers) {
  const Scene kitchen = make_scene("kitchen");
  const auto in_kitchen = seen_cells("kitchen");
  const Scene office = make_scene("office");
  const auto in_office = seen_cells("office");
  int num_shared = 0;
  int num_large = 0;
  int num_others = 0;
  for (const Instance& instance : kitchen.instances()) {
    if (instance.is_structure || !in_kitchen.contains(instance.key)) continue;
    const std::size_t cells = in_kitchen.at(instance.key);
    const bool is_shared = std::ranges::any_of(office.instances(), [&](const Instance& other) {
      return other.model == instance.model && in_office.contains(other.key);
    });
    if (!is_shared && cells >= 100) ++num_others;
    if (!is_shared || cells < 200) continue;
    ++num_shared;
    if (cells >= kCellsOf500cm2) ++num_large;
  }
  EXPECT_GE(num_shared, 15);
  EXPECT_GE(num_large, 8);
  EXPECT_GE(num_others, 35);
}

TEST(Kitchen, ThingsOfTheOfficeTouchNothingElse) {
  const Scene kitchen = make_scene("kitchen");
  const Scene office = make_scene("office");
  for (const Instance& instance : kitchen.instances()) {
    const bool is_shared = std::ranges::any_of(office.instances(), [&](const Instance& other) {
      return other.model == instance.model && !instance.is_structure;
    });
    if (is_shared) expect_no_overlap(kitchen, instance);
  }
}

TEST(ObjectModel, ThingsOfTheSameModelAreOfTheSameMake) {
  std::map<std::string, std::vector<Primitive>> makes;
  for (const char* name : {"office", "office-later", "kitchen"}) {
    const Scene scene = make_scene(name);
    for (const Instance& instance : scene.instances()) {
      if (instance.is_structure) continue;
      std::vector<Primitive> solids = solids_of(scene, instance.id);
      for (Primitive& solid : solids) solid.X_WO = instance.X_WG.inverse() * solid.X_WO;
      const auto& first = makes.emplace(instance.model, solids).first->second;
      ASSERT_EQ(first.size(), solids.size()) << instance.model;
      for (std::size_t i = 0; i < first.size(); ++i) {
        EXPECT_TRUE(first[i].X_WO.isApprox(solids[i].X_WO, 1e-9)) << instance.model;
        EXPECT_TRUE(first[i].shape.half_extents.isApprox(solids[i].shape.half_extents, 1e-9));
        EXPECT_EQ(first[i].material.color, solids[i].material.color) << instance.model;
        EXPECT_EQ(first[i].material.second_color, solids[i].material.second_color)
            << instance.model;
      }
    }
  }
}

TEST(ObjectModel, KeysAreUniqueInEveryScene) {
  for (const std::string& name : scene_names()) {
    std::set<std::string> keys;
    const Scene scene = make_scene(name);
    for (const Instance& instance : scene.instances()) {
      EXPECT_TRUE(keys.insert(instance.key).second) << name << ": " << instance.key;
    }
  }
}

std::vector<int> orders(const SceneBuilder& builder) {
  const Scene scene = SceneBuilder(builder).build();
  std::vector<int> orders;
  const Instance& instance = scene.instances().front();
  for (const SymmetryAxis& axis : symmetry_of(instance, scene.primitives()).axes) {
    orders.push_back(axis.order);
  }
  return orders;
}

TEST(ObjectModel, SymmetryIsThatOfTheSolids) {
  const Pose X_WG = at(1, 2, 3, 0.7);
  SceneBuilder ball;
  ball.add_object("ball", X_WG, sphere(0.1), plain(rgb(9, 9, 9)));
  EXPECT_EQ(orders(ball), (std::vector<int>{kAnyAngle, kAnyAngle, kAnyAngle}));
  SceneBuilder bottle;
  bottle.begin_object("bottle", X_WG);
  bottle.add(cylinder(0.04, 0.2), at(0, 0, 0.1), plain(rgb(9, 9, 9)));
  bottle.add(cone(0.04, 0.01, 0.05), at(0, 0, 0.225), plain(rgb(9, 9, 9)));
  EXPECT_EQ(orders(bottle), (std::vector<int>{kAnyAngle}));
  SceneBuilder brick;
  brick.add_object("brick", X_WG, box(0.1, 0.2, 0.3), plain(rgb(9, 9, 9)));
  EXPECT_EQ(orders(brick), (std::vector<int>{2, 2, 2}));
  SceneBuilder pillar;
  pillar.add_object("pillar", X_WG, box(0.1, 0.1, 0.3), plain(rgb(9, 9, 9)));
  EXPECT_EQ(orders(pillar), (std::vector<int>{2, 2, 4}));
  SceneBuilder mug;
  mug.begin_object("mug", X_WG);
  mug.add(cylinder(0.04, 0.1), at(0, 0, 0.05), plain(rgb(9, 9, 9)));
  mug.add(torus(0.03, 0.01), at(0.05, 0, 0.055) * axis_along_y(), plain(rgb(9, 9, 9)));
  EXPECT_EQ(orders(mug), std::vector<int>{});
  SceneBuilder pan;  // with two handles
  pan.begin_object("pan", X_WG);
  pan.add(cylinder(0.1, 0.1, 0.09), at(0, 0, 0.05), plain(rgb(9, 9, 9)));
  for (const double side : {-1.0, 1.0}) {
    pan.add(torus(0.03, 0.01), at(side * 0.12, 0, 0.1), plain(rgb(9, 9, 9)));
  }
  EXPECT_EQ(orders(pan), std::vector<int>{2});
}

TEST(SceneBuilder, WhatIsNotThereCanNeitherBeTakenNorMoved) {
  SceneBuilder builder;
  builder.add_object("ball", at(0, 0, 0), sphere(0.1), plain(rgb(200, 45, 45)));
  EXPECT_THROW(builder.take_away("ball"), std::invalid_argument);
  EXPECT_THROW(builder.move("ball", at(1, 0, 0)), std::invalid_argument);
  builder.move("ball red 200x200x200", at(1, 0, 0));
  builder.add_object("ball", at(0, 0, 0), sphere(0.1), plain(rgb(200, 45, 45)));
  builder.take_away("ball red 200x200x200");
  const Scene scene = std::move(builder).build();
  ASSERT_EQ(scene.instances().size(), 1U);
  EXPECT_EQ(scene.instances()[0].key, "ball red 200x200x200 2");
  EXPECT_EQ(scene.instances()[0].id, 1);
  EXPECT_NEAR(scene.signed_distance({0.3, 0, 0}), 0.2, 1e-12);
}

}  // namespace
}  // namespace kintsugi::synthetic
