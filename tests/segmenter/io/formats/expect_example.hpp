#pragma once
// Compares a table with the example that was written.

#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "segmenter/io/points/point_table.hpp"
#include "tests/segmenter/io/formats/example_clouds.hpp"

namespace kintsugi::segmenter::testing {

inline std::vector<std::string> names_of(const PointTable& table) {
  std::vector<std::string> names;
  for (const PointField& field : table.fields()) names.push_back(field.name);
  return names;
}

inline double value(const PointTable& table, std::size_t point, const std::string& column) {
  const auto field = table.find(column);
  EXPECT_TRUE(field) << column;
  return field ? table.value(point, *field) : 0.0;
}

/// Positions to the bit, as double; colours if there are any.
inline void expect_example(const PointTable& table) {
  const auto points = example_points();
  ASSERT_EQ(table.size(), points.size());
  EXPECT_EQ(table.fields()[*table.find("x")].type, ScalarType::kFloat64);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_DOUBLE_EQ(value(table, i, "x"), points[i].position[0]);
    EXPECT_DOUBLE_EQ(value(table, i, "y"), points[i].position[1]);
    EXPECT_DOUBLE_EQ(value(table, i, "z"), points[i].position[2]);
    if (!table.find("red")) continue;
    EXPECT_EQ(table.fields()[*table.find("red")].type, ScalarType::kUint8);
    EXPECT_EQ(value(table, i, "red"), points[i].color[0]);
    EXPECT_EQ(value(table, i, "green"), points[i].color[1]);
    EXPECT_EQ(value(table, i, "blue"), points[i].color[2]);
  }
}

}  // namespace kintsugi::segmenter::testing
