#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "mapper/core/registration/depth_edges.hpp"
#include "tests/mapper/core/box_room.hpp"

namespace kintsugi::mapper {
namespace {

using EdgeLines = std::vector<std::vector<EdgePixel>>;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kBox_m = 1.0F;
constexpr float kWall_m = 2.0F;
constexpr int kLeft = 100;  // first and last pixel of the box
constexpr int kRight = 179;
constexpr int kTop = 60;
constexpr int kBottom = 149;

SurfaceMap surface_of(const cv::Mat_<float>& depth_m) {
  SurfaceMap surface(testing::test_camera());
  surface.depth_m = depth_m;
  return surface;
}

cv::Mat_<float> wall() { return cv::Mat_<float>(240, 320, kWall_m); }

cv::Mat_<float> box_before_wall() {
  cv::Mat_<float> depth_m = wall();
  depth_m(cv::Rect(kLeft, kTop, kRight - kLeft + 1, kBottom - kTop + 1)).setTo(kBox_m);
  return depth_m;
}

std::size_t count(const EdgeLines& lines) {
  std::size_t number = 0;
  for (const auto& line : lines) number += line.size();
  return number;
}

void expect_edge(const EdgePixel& edge, float position_px, bool ends) {
  EXPECT_EQ(edge.position_px, position_px);
  EXPECT_EQ(edge.slope, 0.0F);
  EXPECT_EQ(edge.depth_m, kBox_m);
  EXPECT_EQ(edge.ends, ends);
}

TEST(DepthEdges, AreTheOutlineOfABoxInRowsAndColumns) {
  const DepthEdges edges = find_depth_edges(surface_of(box_before_wall()));
  ASSERT_EQ(edges.rows.size(), 240U);
  ASSERT_EQ(edges.columns.size(), 320U);
  for (int row = 0; row < 240; ++row) {
    // At the corners the outline does not go on over two rows.
    const bool is_beside_box = row >= kTop + 2 && row <= kBottom - 2;
    ASSERT_EQ(edges.rows[row].size(), is_beside_box ? 2U : 0U) << row;
    if (!is_beside_box) continue;
    expect_edge(edges.rows[row][0], kLeft - 0.5F, false);
    expect_edge(edges.rows[row][1], kRight + 0.5F, true);
  }
  for (int column = 0; column < 320; ++column) {
    const bool is_beside_box = column >= kLeft + 2 && column <= kRight - 2;
    ASSERT_EQ(edges.columns[column].size(), is_beside_box ? 2U : 0U) << column;
    if (!is_beside_box) continue;
    expect_edge(edges.columns[column][0], kTop - 0.5F, false);
    expect_edge(edges.columns[column][1], kBottom + 0.5F, true);
  }
}

TEST(DepthEdges, HaveTheSlopeOfTheOutline) {
  constexpr double kSlope = 0.4;  // columns a row
  cv::Mat_<float> depth_m = wall();
  for (int v = 0; v < depth_m.rows; ++v) {
    const int end = 80 + static_cast<int>(std::lround(kSlope * v));
    depth_m.row(v).colRange(0, end).setTo(kBox_m);
  }
  for (const bool transposed : {false, true}) {
    SurfaceMap surface = surface_of(transposed ? cv::Mat_<float>(depth_m.t()) : depth_m);
    if (transposed) std::swap(surface.intrinsics.width, surface.intrinsics.height);
    const DepthEdges edges = find_depth_edges(surface);
    const EdgeLines& lines = transposed ? edges.columns : edges.rows;
    EXPECT_EQ(count(transposed ? edges.rows : edges.columns), 0U)
        << "it is steeper than 45 degrees";
    double sum_of_slopes = 0.0;
    for (int line = 2; line < 238; ++line) {
      ASSERT_EQ(lines[line].size(), 1U) << line;
      const EdgePixel& edge = lines[line][0];
      EXPECT_NEAR(edge.position_px, 79.5 + kSlope * line, 0.51) << line;
      EXPECT_NEAR(edge.slope, kSlope, 0.26) << "positions are whole pixels, four lines apart";
      sum_of_slopes += edge.slope;
    }
    EXPECT_NEAR(sum_of_slopes / 236.0, kSlope, 0.01);
  }
}

TEST(DepthEdges, LieBesideTheShadowOfTheNearSurface) {
  cv::Mat_<float> depth_m = box_before_wall();
  depth_m.colRange(kLeft - 9, kLeft).setTo(kNaN);
  depth_m.colRange(kRight + 1, kRight + 16).setTo(0.0F);
  const DepthEdges edges = find_depth_edges(surface_of(depth_m));
  for (int row = kTop + 2; row <= kBottom - 2; ++row) {
    ASSERT_EQ(edges.rows[row].size(), 2U) << row;
    expect_edge(edges.rows[row][0], kLeft - 0.5F, false);
    expect_edge(edges.rows[row][1], kRight + 0.5F, true);
  }
}

TEST(DepthEdges, AreNotKnownAcrossAWideGap) {
  cv::Mat_<float> depth_m = box_before_wall();
  depth_m.colRange(kRight + 1, kRight + 41).setTo(kNaN);  // an eighth of the image
  const DepthEdges edges = find_depth_edges(surface_of(depth_m));
  for (int row = kTop + 2; row <= kBottom - 2; ++row) {
    ASSERT_EQ(edges.rows[row].size(), 1U) << row;
    expect_edge(edges.rows[row][0], kLeft - 0.5F, false);
  }
}

TEST(DepthEdges, AreNotMadeByNoise) {
  cv::RNG random(4);
  for (const float wall_m : {1.0F, 3.0F}) {
    cv::Mat_<float> depth_m(240, 320);
    random.fill(depth_m, cv::RNG::NORMAL, wall_m, DepthNoise().sigma_m(wall_m));
    // Single wrong pixels, too, but no lines of them.
    for (int i = 0; i < 50; ++i) depth_m(random.uniform(0, 240), random.uniform(0, 320)) = 0.7F;
    const DepthEdges edges = find_depth_edges(surface_of(depth_m));
    EXPECT_EQ(count(edges.rows) + count(edges.columns), 0U) << wall_m;
  }
}

TEST(DepthEdges, AreWhereTheyWereInSpiteOfNoise) {
  cv::Mat_<float> depth_m = box_before_wall();
  cv::RNG random(4);
  for (int v = 0; v < depth_m.rows; ++v) {
    for (int u = 0; u < depth_m.cols; ++u) {
      depth_m(v, u) += static_cast<float>(random.gaussian(DepthNoise().sigma_m(depth_m(v, u))));
    }
  }
  const DepthEdges edges = find_depth_edges(surface_of(depth_m));
  EXPECT_EQ(count(edges.rows), count(find_depth_edges(surface_of(box_before_wall())).rows));
  for (int row = kTop + 2; row <= kBottom - 2; ++row) {
    ASSERT_EQ(edges.rows[row].size(), 2U) << row;
    EXPECT_EQ(edges.rows[row][0].position_px, kLeft - 0.5F);
    EXPECT_EQ(edges.rows[row][1].position_px, kRight + 0.5F);
  }
}

TEST(DepthEdges, AreNotMadeByCreasesAndSlantedWalls) {
  // The inside of a room without the crate.
  Pose X_WC = Pose::Identity();
  X_WC.linear() = Eigen::AngleAxisd(1.0, Eigen::Vector3d(0.3, 1.0, 0.1).normalized()).matrix();
  const Intrinsics camera = testing::test_camera();
  cv::Mat_<float> depth_m(camera.height, camera.width);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector3d ray_C((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1.0);
      depth_m(v, u) = static_cast<float>(
          testing::intersect(testing::kRoom, X_WC.translation(), X_WC.linear() * ray_C, true)
              .distance);
    }
  }
  const DepthEdges edges = find_depth_edges(surface_of(depth_m));
  EXPECT_EQ(count(edges.rows) + count(edges.columns), 0U);
}

}  // namespace
}  // namespace kintsugi::mapper
