#include "mapper/synthetic/render/renderer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <tbb/parallel_for.h>

namespace kintsugi::synthetic {

namespace {

constexpr int kTile = 16;  // pixels
constexpr std::size_t kTilePixels = std::size_t{kTile} * kTile;
constexpr double kNear_m = 1e-3;  // nothing nearer than this is drawn
const cv::Vec3b kSky(226, 236, 246);

/// A solid that may be seen: what the tiles need of it, in single precision.
struct Candidate {
  BasicShape<float> shape;
  Eigen::Vector3f camera_O;
  Eigen::Matrix3f R_OC;
  float near_m;     // no point of it has a smaller depth
  cv::Rect pixels;  // no pixel outside sees it
  int primitive;
};

/// The corners of the bounding box, and where its edges pass the near plane.
std::vector<Eigen::Vector3d> corners_before_camera(const Eigen::Vector3d& half, const Pose& X_CO) {
  std::array<Eigen::Vector3d, 8> corners;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d sign((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1);
    corners[i] = X_CO * half.cwiseProduct(sign);
  }
  std::vector<Eigen::Vector3d> visible;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d& a = corners[i];
    if (a.z() >= kNear_m) visible.push_back(a);
    for (int bit : {1, 2, 4}) {
      if ((i & bit) != 0) continue;
      const Eigen::Vector3d& b = corners[i | bit];
      if ((a.z() < kNear_m) == (b.z() < kNear_m)) continue;
      visible.push_back(a + (kNear_m - a.z()) / (b.z() - a.z()) * (b - a));
    }
  }
  return visible;
}

std::vector<Candidate> find_candidates(const Scene& scene, const Intrinsics& camera,
                                       const Pose& X_WC) {
  const cv::Rect image(0, 0, camera.width, camera.height);
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < scene.primitives().size(); ++i) {
    const Primitive& primitive = scene.primitives()[i];
    const Pose X_CO = X_WC.inverse() * primitive.X_WO;
    const auto corners = corners_before_camera(primitive.shape.half_extents, X_CO);
    if (corners.empty()) continue;
    Eigen::Array2d low = Eigen::Array2d::Constant(1e9);
    Eigen::Array2d high = -low;
    double near_m = corners.front().z();
    for (const Eigen::Vector3d& p_C : corners) {
      const Eigen::Array2d pixel(camera.fx * p_C.x() / p_C.z() + camera.cx,
                                 camera.fy * p_C.y() / p_C.z() + camera.cy);
      low = low.min(pixel);
      high = high.max(pixel);
      near_m = std::min(near_m, p_C.z());
    }
    low = low.max(-1e6).floor();
    high = high.min(1e6).ceil() + 1;
    if ((high <= low).any()) continue;
    const cv::Rect pixels =
        cv::Rect(cv::Point(static_cast<int>(low.x()), static_cast<int>(low.y())),
                 cv::Point(static_cast<int>(high.x()), static_cast<int>(high.y()))) &
        image;
    if (pixels.empty()) continue;
    const Pose X_OC = X_CO.inverse();
    candidates.push_back({primitive.shape.cast<float>(), X_OC.translation().cast<float>(),
                          X_OC.linear().cast<float>(), static_cast<float>(near_m), pixels,
                          static_cast<int>(i)});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.near_m < b.near_m; });
  return candidates;
}

class TileRenderer {
 public:
  TileRenderer(const Scene& scene, const std::vector<Candidate>& candidates, RenderedFrame& frame)
      : scene_(scene), candidates_(candidates), frame_(frame) {}

  void render(const cv::Rect& tile) const {
    Nearest nearest;
    find_nearest(tile, nearest);
    shade(tile, nearest);
  }

 private:
  struct Nearest {
    std::array<float, kTilePixels> depth_m;
    std::array<int, kTilePixels> candidate;
  };

  Eigen::Vector3f direction_C(int u, int v) const {
    const Intrinsics& camera = frame_.intrinsics;
    return {static_cast<float>((u - camera.cx) / camera.fx),
            static_cast<float>((v - camera.cy) / camera.fy), 1.0F};
  }

  void find_nearest(const cv::Rect& tile, Nearest& nearest) const {
    nearest.depth_m.fill(std::numeric_limits<float>::infinity());
    nearest.candidate.fill(-1);
    float farthest_m = std::numeric_limits<float>::infinity();
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      const Candidate& candidate = candidates_[c];
      if (candidate.near_m > farthest_m) break;
      const cv::Rect pixels = candidate.pixels & tile;
      if (pixels.empty()) continue;
      for (int v = pixels.y; v < pixels.br().y; ++v) {
        for (int u = pixels.x; u < pixels.br().x; ++u) {
          const float t = intersect<float>(candidate.shape, candidate.camera_O,
                                           candidate.R_OC * direction_C(u, v));
          const int at = (v - tile.y) * kTile + (u - tile.x);
          const bool nearer = t < nearest.depth_m[at] ||
                              (t == nearest.depth_m[at] && std::isfinite(t) &&
                               candidate.primitive < candidates_[nearest.candidate[at]].primitive);
          if (!nearer) continue;
          nearest.depth_m[at] = t;
          nearest.candidate[at] = static_cast<int>(c);
        }
      }
      farthest_m = 0.0F;
      for (int v = 0; v < tile.height; ++v) {
        const auto row = nearest.depth_m.begin() + static_cast<std::ptrdiff_t>(v) * kTile;
        farthest_m = std::max(farthest_m, *std::max_element(row, row + tile.width));
      }
    }
  }

  void shade(const cv::Rect& tile, const Nearest& nearest) const {
    for (int v = tile.y; v < tile.br().y; ++v) {
      for (int u = tile.x; u < tile.br().x; ++u) {
        const int at = (v - tile.y) * kTile + (u - tile.x);
        if (nearest.candidate[at] < 0) {
          shade_sky(v, u);
        } else {
          shade_pixel(v, u, candidates_[nearest.candidate[at]], nearest.depth_m[at]);
        }
      }
    }
  }

  void shade_sky(int v, int u) const {
    frame_.depth_m(v, u) = std::numeric_limits<float>::quiet_NaN();
    frame_.color_rgb(v, u) = kSky;
    frame_.normals_W(v, u) = cv::Vec3f(0, 0, 0);
    frame_.instances(v, u) = kNoInstance;
  }

  void shade_pixel(int v, int u, const Candidate& candidate, float depth_m) const {
    const Primitive& primitive = scene_.primitives()[candidate.primitive];
    const Eigen::Vector3f p_O = candidate.camera_O + depth_m * (candidate.R_OC * direction_C(u, v));
    const Eigen::Vector3f normal_O = outward_normal<float>(candidate.shape, p_O);
    const Eigen::Vector3f normal_W = primitive.X_WO.linear().cast<float>() * normal_O;
    const Color white_light_color =
        255.0F * irradiance(normal_W) * albedo(primitive.material, candidate.shape, p_O, normal_O);
    const Color color = white_light_color.cwiseProduct(scene_.light());
    frame_.depth_m(v, u) = depth_m;
    frame_.color_rgb(v, u) = cv::Vec3b(cv::saturate_cast<std::uint8_t>(color.x()),
                                       cv::saturate_cast<std::uint8_t>(color.y()),
                                       cv::saturate_cast<std::uint8_t>(color.z()));
    frame_.normals_W(v, u) = cv::Vec3f(normal_W.x(), normal_W.y(), normal_W.z());
    frame_.instances(v, u) = static_cast<std::uint16_t>(primitive.instance);
  }

  const Scene& scene_;
  const std::vector<Candidate>& candidates_;
  RenderedFrame& frame_;
};

void check_intrinsics(const Intrinsics& camera) {
  const bool has_lens = camera.distortion != std::array<double, 5>{};
  if (camera.width <= 0 || camera.height <= 0 || !(camera.fx > 0) || !(camera.fy > 0) || has_lens) {
    throw std::invalid_argument(
        "render: the intrinsics must have positive size and focal lengths and no distortion; got " +
        std::to_string(camera.width) + " x " + std::to_string(camera.height) + ", f " +
        std::to_string(camera.fx) + " " + std::to_string(camera.fy) +
        (has_lens ? ", with distortion" : ""));
  }
}

}  // namespace

RenderedFrame render(const Scene& scene, const Intrinsics& intrinsics, const Pose& X_WC) {
  check_intrinsics(intrinsics);
  const cv::Size size(intrinsics.width, intrinsics.height);
  RenderedFrame frame{X_WC,
                      intrinsics,
                      cv::Mat_<float>(size),
                      cv::Mat_<cv::Vec3b>(size),
                      cv::Mat_<cv::Vec3f>(size),
                      cv::Mat_<std::uint16_t>(size)};
  const std::vector<Candidate> candidates = find_candidates(scene, intrinsics, X_WC);
  const TileRenderer renderer(scene, candidates, frame);
  const int columns = (size.width + kTile - 1) / kTile;
  const int rows = (size.height + kTile - 1) / kTile;
  tbb::parallel_for(0, columns * rows, [&](int i) {
    const cv::Rect tile(i % columns * kTile, i / columns * kTile, kTile, kTile);
    renderer.render(tile & cv::Rect(cv::Point(0, 0), size));
  });
  return frame;
}

}  // namespace kintsugi::synthetic
