#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segmenter/io/points/file_cloud.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::HasSubstr;

PointTable table_of(const std::vector<std::string>& names, ScalarType type,
                    const std::vector<std::vector<double>>& rows) {
  PointTable table;
  for (const char* axis : {"x", "y", "z"}) table.add_field(axis, ScalarType::kFloat64);
  for (const std::string& name : names) table.add_field(name, type);
  for (const auto& row : rows) {
    table.append();
    for (std::size_t i = 0; i < row.size(); ++i) table.set_value(table.size() - 1, i, row[i]);
  }
  return table;
}

FileCloud cloud_of(const PointTable& table, const PositionFrame& frame = {}) {
  return cloud_of(table, find_roles(table, "a"), frame, "a");
}

TEST(FileCloud, KnowsColoursByThreeSetsOfNames) {
  for (const auto& names : {std::vector<std::string>{"red", "green", "blue"},
                            {"diffuse_red", "diffuse_green", "diffuse_blue"},
                            {"r", "g", "b"}}) {
    const auto table = table_of(names, ScalarType::kUint8, {{0, 0, 0, 1, 2, 3}});
    const CloudPoint point = cloud_of(table).points_W[0];
    EXPECT_EQ(point.red, 1);
    EXPECT_EQ(point.green, 2);
    EXPECT_EQ(point.blue, 3);
  }
}

TEST(FileCloud, ScalesColoursOf16BitsUnlessAllAreOf8) {
  const std::vector<std::string> names{"red", "green", "blue"};
  const auto of_16 = table_of(names, ScalarType::kUint16, {{0, 0, 0, 65535, 257, 0}});
  EXPECT_EQ(cloud_of(of_16).points_W[0].red, 255);
  EXPECT_EQ(cloud_of(of_16).points_W[0].green, 1);
  const auto of_8 = table_of(names, ScalarType::kUint16, {{0, 0, 0, 255, 7, 0}});
  EXPECT_EQ(cloud_of(of_8).points_W[0].green, 7);
}

TEST(FileCloud, KeepsMillimetresFarFromTheOrigin) {
  // UTM coordinates 1 mm apart.
  const auto table = table_of({}, ScalarType::kFloat32,
                              {{691'040.001, 5'334'012.002, 500.003},
                               {691'040.002, 5'334'012.002, 500.003},
                               {691'040.003, 5'334'012.002, 500.003}});
  const PointRoles roles = find_roles(table, "a");
  const Eigen::Vector3d origin_W = choose_origin_W(table, roles, 1.0);
  EXPECT_EQ(origin_W, Eigen::Vector3d(691'000.0, 5'334'000.0, 500.0));
  const FileCloud cloud = cloud_of(table, {.metres_per_unit = 1.0, .origin_W = origin_W});
  EXPECT_NEAR(cloud.points_W[2].x, 40.003, 1e-5);  // float32 at 40 m: 4e-6
  EXPECT_NEAR(cloud.points_W[0].y, 12.002, 1e-5);
  EXPECT_NEAR(cloud.points_W[0].z, 0.003, 1e-5);
}

TEST(FileCloud, ChoosesNoOriginForPointsThatAreNear) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto near = table_of({}, ScalarType::kFloat32, {{900, -900, 0}, {nan, nan, nan}});
  EXPECT_EQ(choose_origin_W(near, find_roles(near, "a"), 1.0), Eigen::Vector3d::Zero());
  const auto in_mm = table_of({}, ScalarType::kFloat32, {{500'000, 0, 0}});
  EXPECT_EQ(choose_origin_W(in_mm, find_roles(in_mm, "a"), 0.001), Eigen::Vector3d::Zero());
  const auto nonsense = table_of({}, ScalarType::kFloat32, {{1e300, 2000, 0}});
  EXPECT_EQ(choose_origin_W(nonsense, find_roles(nonsense, "a"), 1.0), Eigen::Vector3d(0, 2000, 0));
  const auto none = table_of({}, ScalarType::kFloat32, {});
  EXPECT_EQ(choose_origin_W(none, find_roles(none, "a"), 1.0), Eigen::Vector3d::Zero());
}

TEST(FileCloud, IgnoresLabelsThatAreNotWanted) {
  const auto table = table_of({"instance_id"}, ScalarType::kInt32, {{0, 0, 0, -1}});
  EXPECT_THAT([&] { cloud_of(table); },
              ::testing::ThrowsMessage<std::runtime_error>(HasSubstr("'instance_id' is -1")));
  const PointRoles roles = find_roles(table, "a", LabelUse::kIgnore);
  EXPECT_EQ(cloud_of(table, roles, {}, "a").points_W.size(), 1U);
}

TEST(ScalarType, WritesTheNearestValueOfAType) {
  char bytes[8];
  const auto written = [&](double value, ScalarType type) {
    write_scalar(value, type, bytes);
    return read_scalar(bytes, type);
  };
  EXPECT_EQ(written(300.0, ScalarType::kUint8), 255.0);
  EXPECT_EQ(written(-1.0, ScalarType::kUint32), 0.0);
  EXPECT_EQ(written(-2.6, ScalarType::kInt16), -3.0);
  EXPECT_EQ(written(std::numeric_limits<double>::quiet_NaN(), ScalarType::kInt32), 0.0);
  EXPECT_EQ(written(4e9, ScalarType::kUint32), 4e9);
  EXPECT_EQ(written(1e300, ScalarType::kFloat32), HUGE_VAL);
  EXPECT_EQ(written(0.1, ScalarType::kFloat64), 0.1);
}

}  // namespace
}  // namespace kintsugi::segmenter
