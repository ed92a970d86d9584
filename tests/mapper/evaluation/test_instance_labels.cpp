#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/evaluation/instance_labels.hpp"
#include "mapper/synthetic/scene/scene_builder.hpp"

namespace kintsugi::mapper {
namespace {

using synthetic::at;
using testing::ElementsAre;
using testing::EndsWith;
using testing::StartsWith;

enum Id : std::uint32_t { kNone, kTable, kCube, kBall };

/// On a table, whose top is at z = 0, a cube of 20 cm and a ball of 10 cm that touches it.
synthetic::Scene table_scene() {
  synthetic::SceneBuilder builder;
  builder.add_structure("table", at(0, 0, -0.5), synthetic::box(2, 2, 1), {});
  builder.add_object("cube", at(0, 0, 0.1), synthetic::box(0.2, 0.2, 0.2), {});
  builder.add_object("tennis ball", at(0.15, 0, 0.05), synthetic::sphere(0.05), {});
  return std::move(builder).build();
}

struct Place {
  Eigen::Vector3d p_S;
  Id nearest;
};

/// Distances that a person can work out; the limit is 3 cm.
const std::array<Place, 11> kPlaces = {{
    {{0.5, 0.5, 0.004}, kTable},
    {{0.5, 0.5, -0.004}, kTable},  // within it, as noise moves points
    {{0.5, 0.5, 0.029}, kTable},
    {{0.5, 0.5, 0.031}, kNone},
    {{0.5, 0.5, -0.031}, kNone},
    {{0, -0.102, 0.003}, kCube},  // 2 mm from the cube's side, 3 mm above the table
    {{0, -0.103, 0.002}, kTable},
    {{0, 0, 0.2}, kCube},
    {{0.1 + 0.001, 0, 0.15}, kCube},
    {{0.15, 0, 0.098}, kBall},
    {{0.1 + 0.004, 0, 0.051}, kBall},  // within the ball by 4 mm, out of the cube
}};

Pose somewhere() {
  Pose X_SW = Pose::Identity();
  X_SW.translation() << 1.0, -2.0, 0.5;
  X_SW.linear() =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
  return X_SW;
}

std::vector<CloudPoint> points_at_places(const Pose& X_SW) {
  std::vector<CloudPoint> points_W;
  for (const Place& place : kPlaces) {
    const Eigen::Vector3f p_W = (X_SW.inverse() * place.p_S).cast<float>();
    points_W.push_back({.x = p_W.x(), .y = p_W.y(), .z = p_W.z()});
  }
  return points_W;
}

TEST(InstanceLabels, AreThoseOfTheNearestSurfaceFromAnyFrame) {
  for (const Pose& X_SW : {Pose(Pose::Identity()), somewhere()}) {
    const auto labels = nearest_instances(points_at_places(X_SW), table_scene(), X_SW, 0.03);
    ASSERT_EQ(labels.size(), kPlaces.size());
    for (std::size_t i = 0; i < labels.size(); ++i) {
      EXPECT_EQ(labels[i], kPlaces[i].nearest) << kPlaces[i].p_S.transpose();
    }
  }
}

TEST(InstanceLabels, NeedADistanceAboveZero) {
  for (const double distance_m : {0.0, -1.0, std::nan("")}) {
    EXPECT_THROW(nearest_instances({}, table_scene(), Pose::Identity(), distance_m),
                 std::invalid_argument);
  }
}

TEST(InstanceLabels, OfASceneWithoutSurfacesAreNone) {
  const auto labels =
      nearest_instances({CloudPoint{}}, synthetic::Scene({}, {}), Pose::Identity(), 0.03);
  EXPECT_THAT(labels, ElementsAre(kNone));
}

std::string read_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(InstanceCloud, HasPositionsLabelsAndNames) {
  const auto path = std::filesystem::path(testing::TempDir()) / "instance_labels_truth.ply";
  const std::vector<CloudPoint> points_W = {{.x = 1, .y = 2, .z = 3}, {.x = -4, .y = 5, .z = 6}};
  write_instance_cloud(path, points_W, {kBall, kNone}, table_scene());
  const std::string file = read_file(path);
  std::filesystem::remove(path);
  EXPECT_THAT(file, StartsWith("ply\nformat binary_little_endian 1.0\n"
                               "comment instance 1 structure table\n"
                               "comment instance 2 object cube\n"
                               "comment instance 3 object tennis ball\n"
                               "element vertex 2\n"
                               "property float x\nproperty float y\nproperty float z\n"
                               "property uint instance_id\nend_header\n"));
  std::string body;
  const auto append = [&body](const auto& value) {
    body.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  for (const float coordinate : {1.0F, 2.0F, 3.0F}) append(coordinate);
  append(std::uint32_t{kBall});
  for (const float coordinate : {-4.0F, 5.0F, 6.0F}) append(coordinate);
  append(std::uint32_t{kNone});
  EXPECT_THAT(file, EndsWith("end_header\n" + body));
}

TEST(InstanceCloud, NeedsALabelForEachPoint) {
  const auto path = std::filesystem::path(testing::TempDir()) / "instance_labels_few.ply";
  EXPECT_THROW(write_instance_cloud(path, {CloudPoint{}}, {}, table_scene()),
               std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(InstanceCloud, RefusesANameOfTwoLines) {
  synthetic::SceneBuilder builder;
  builder.add_object("end_header\nball", at(0, 0, 0), synthetic::sphere(1), {});
  const auto path = std::filesystem::path(testing::TempDir()) / "instance_labels_name.ply";
  EXPECT_THROW(write_instance_cloud(path, {}, {}, std::move(builder).build()),
               std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace kintsugi::mapper
