#include "mapper/core/registration/depth_edges.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "mapper/core/frame/kernel_arguments.hpp"
#include "mapper/core/frame/same_surface.hpp"

namespace kintsugi::mapper {
namespace {

constexpr int kLinesAround = 2;       ///< on each side, over which an outline must go on
constexpr float kMaxGapShare = 0.1F;  ///< of the image: widest gap between the two surfaces

std::vector<EdgePixel> edges_of_line(const float* depth_m, int length,
                                     const DepthTolerance& tolerance) {
  std::vector<EdgePixel> edges;
  const int max_gap = static_cast<int>(kMaxGapShare * static_cast<float>(length));
  int last = -1;
  for (int i = 0; i < length; ++i) {
    if (!(depth_m[i] > 0.0F)) continue;
    const int before = last;
    last = i;
    if (before < 0 || i - before > max_gap) continue;
    const float step_m = depth_m[i] - depth_m[before];
    const float near_m = std::min(depth_m[i], depth_m[before]);
    if (std::abs(step_m) <= same_surface_m(tolerance, near_m, i - before)) continue;
    const bool ends = step_m > 0.0F;
    const float border = ends ? static_cast<float>(before) + 0.5F : static_cast<float>(i) - 0.5F;
    edges.push_back({.position_px = border, .depth_m = near_m, .ends = ends});
  }
  return edges;
}

/// Where the outline of `edge` crosses another line, `distance` lines away.
std::optional<float> continuation(const EdgePixel& edge, const std::vector<EdgePixel>& line,
                                  int distance, const DepthTolerance& tolerance) {
  for (const EdgePixel& other : line) {
    const bool is_same =
        other.ends == edge.ends &&
        std::abs(other.position_px - edge.position_px) <= static_cast<float>(distance) + 0.5F &&
        std::abs(other.depth_m - edge.depth_m) <= same_surface_m(tolerance, edge.depth_m, distance);
    if (is_same) return other.position_px;
  }
  return std::nullopt;
}

EdgeLines edges_in_rows(const cv::Mat_<float>& depth_m, const DepthTolerance& tolerance) {
  EdgeLines all(depth_m.rows);
  for (int row = 0; row < depth_m.rows; ++row) {
    all[row] = edges_of_line(depth_m[row], depth_m.cols, tolerance);
  }
  EdgeLines kept(depth_m.rows);
  for (int row = kLinesAround; row + kLinesAround < depth_m.rows; ++row) {
    for (EdgePixel edge : all[row]) {
      const auto above = continuation(edge, all[row - kLinesAround], kLinesAround, tolerance);
      const auto below = continuation(edge, all[row + kLinesAround], kLinesAround, tolerance);
      if (!above || !below) continue;
      edge.slope = (*below - *above) / (2.0F * kLinesAround);
      kept[row].push_back(edge);
    }
  }
  return kept;
}

}  // namespace

DepthEdges find_depth_edges(const SurfaceMap& surface) {
  // Of the noise of the whole: an outline that noise or a camera's interpolation may have made is
  // none.
  const DepthTolerance tolerance = depth_tolerance(surface.noise, surface.intrinsics);
  const cv::Mat_<float> transposed = surface.depth_m.t();
  return {edges_in_rows(surface.depth_m, tolerance), edges_in_rows(transposed, tolerance)};
}

}  // namespace kintsugi::mapper
