#include "segmenter/views/observed_space.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include <oneapi/tbb/parallel_for.h>

#include "segmenter/views/depth_noise.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr float kNearest_m = 0.05F;  // no depth camera measures nearer than this
// To each side of a place: nearer than so many voxels' pixels, a voxel is larger than what is
// compared, which then says less about the place's surroundings but not about the place.
constexpr int kMaxReach_px = 4;
// Standard deviations: one of 700 measurements of a surface is farther off.
constexpr double kNoiseBound = 3.0;
// Edge of the cells whose points share a list of views: about a tenth of what a view shows.
constexpr float kCell_m = 0.3F;

using Cell = std::array<std::int32_t, 3>;

Cell cell_of(const Eigen::Vector3f& p_W) {
  const auto index = [](float x) {
    constexpr float kMost = 1e9F;  // anything farther, and NaN, is seen by no view
    return static_cast<std::int32_t>(
        std::isfinite(x) ? std::clamp(std::floor(x / kCell_m), -kMost, kMost) : kMost);
  };
  return {index(p_W.x()), index(p_W.y()), index(p_W.z())};
}

/// The angle between the optical axis and the corner that is farthest from it.
double half_angle_rad(const Intrinsics& camera) {
  double tangent = 0.0;
  for (const double u_px : {-0.5, camera.width - 0.5}) {
    for (const double v_px : {-0.5, camera.height - 0.5}) {
      tangent = std::max(
          tangent, std::hypot((u_px - camera.cx) / camera.fx, (v_px - camera.cy) / camera.fy));
    }
  }
  return std::atan(tangent);
}

}  // namespace

// A sphere may be seen when its centre is in the cone that is as much larger.
bool ObservedSpace::Cone::meets(const Eigen::Vector3f& center_W, float radius_m) const {
  const Eigen::Vector3f d = center_W - apex_W;
  const float along = d.dot(axis_W);
  const float across = std::sqrt(std::max(0.0F, d.squaredNorm() - along * along));
  return across * cosine - along * sine <= radius_m;
}

void ObservedSpace::add(MapView view) {
  const Intrinsics& camera = view.intrinsics;
  const auto num_samples =
      static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  if (camera.width <= 0 || camera.height <= 0 || view.depth_mm.size() != num_samples) {
    throw std::invalid_argument("a view of " + std::to_string(camera.width) + " x " +
                                std::to_string(camera.height) + " pixels has " +
                                std::to_string(view.depth_mm.size()) + " depths");
  }
  const Pose X_CW = view.X_WC.inverse(Eigen::Isometry);
  X_CW_.emplace_back(X_CW.matrix().topRows<3>().cast<float>());
  const double half_rad = half_angle_rad(camera);
  cones_.push_back({view.X_WC.translation().cast<float>(), view.X_WC.linear().col(2).cast<float>(),
                    static_cast<float>(std::cos(half_rad)),
                    static_cast<float>(std::sin(half_rad))});
  farthest_m_.push_back(1e-3F * static_cast<float>(std::ranges::max(view.depth_mm)));
  views_.push_back(std::move(view));
}

void ObservedSpace::clear() {
  views_.clear();
  X_CW_.clear();
  cones_.clear();
  farthest_m_.clear();
}

/// How far a measurement at this depth may be from a surface that it shows.
double ObservedSpace::margin_m(double z_m) const {
  return std::max(resolution_m_, kNoiseBound * depth_sigma_m(z_m));
}

/// Not when all that the view measured is farther in front of the sphere.
bool ObservedSpace::may_show(std::size_t view, const Eigen::Vector3f& center_W, float radius_m,
                             float within_m) const {
  const Cone& cone = cones_[view];
  const float nearest_m = (center_W - cone.apex_W).dot(cone.axis_W) - radius_m;
  const float in_front_m = std::max(within_m, static_cast<float>(margin_m(nearest_m)));
  return nearest_m - in_front_m <= farthest_m_[view] && cone.meets(center_W, radius_m);
}

ObservedSpace::Look ObservedSpace::look(std::size_t view, const Eigen::Vector3f& p_W) const {
  const Eigen::Vector3f p_C = X_CW_[view] * p_W.homogeneous();
  const float z_m = p_C.z();
  if (!(z_m > kNearest_m)) return {};
  const Intrinsics& camera = views_[view].intrinsics;
  const auto fx = static_cast<float>(camera.fx);
  const float u_px = fx * p_C.x() / z_m + static_cast<float>(camera.cx);
  const float v_px = static_cast<float>(camera.fy) * p_C.y() / z_m + static_cast<float>(camera.cy);
  const float voxel_px = static_cast<float>(resolution_m_) * fx / z_m;
  const int reach = std::clamp(static_cast<int>(std::ceil(voxel_px)), 1, kMaxReach_px);
  const auto border = static_cast<float>(reach);
  const bool is_inside = u_px >= border && v_px >= border &&
                         u_px <= static_cast<float>(camera.width - 1) - border &&
                         v_px <= static_cast<float>(camera.height - 1) - border;
  if (!is_inside) return {};
  const auto i = static_cast<std::ptrdiff_t>(std::lround(u_px));
  const auto j = static_cast<std::ptrdiff_t>(std::lround(v_px));
  const std::uint16_t* const at = views_[view].depth_mm.data() + j * camera.width + i;
  if (*at == 0) return {};
  const double margin = margin_m(z_m);
  const auto nearest_mm = static_cast<float>(1e3 * (z_m - margin));
  const auto farthest_mm = static_cast<float>(1e3 * (z_m + margin));
  const auto depth_mm = static_cast<float>(*at);
  if (depth_mm >= nearest_mm && depth_mm <= farthest_mm) return {Sight::kMeasured};
  const bool is_behind = depth_mm > farthest_mm;
  for (int dj = -reach; dj <= reach; ++dj) {
    for (int di = -reach; di <= reach; ++di) {
      const std::uint16_t sample = at[std::ptrdiff_t{dj} * camera.width + di];
      const auto sample_mm = static_cast<float>(sample);
      if (sample == 0 || (is_behind ? sample_mm <= farthest_mm : sample_mm >= nearest_mm))
        return {};
    }
  }
  if (is_behind) return {Sight::kThrough};
  return {Sight::kHidden, (z_m - 1e-3F * depth_mm) * p_C.norm() / z_m};
}

Sights ObservedSpace::sights(const Eigen::Vector3f& p_W) const {
  std::vector<std::size_t> all(views_.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return sights(p_W, all);
}

void ObservedSpace::count(const Look& look, Sights& sights) {
  sights.through += look.sight == Sight::kThrough ? 1 : 0;
  sights.measured += look.sight == Sight::kMeasured ? 1 : 0;
}

std::vector<std::size_t> ObservedSpace::views_of(const Eigen::Vector3f& center_W, float radius_m,
                                                 float within_m) const {
  std::vector<std::size_t> views;
  for (std::size_t view = 0; view < views_.size(); ++view) {
    if (may_show(view, center_W, radius_m, within_m)) views.push_back(view);
  }
  return views;
}

Sights ObservedSpace::sights(const Eigen::Vector3f& p_W, std::span<const std::size_t> views) const {
  Sights sights;
  for (const std::size_t view : views) {
    count(look(view, p_W), sights);
  }
  return sights;
}

SightsOfSurface ObservedSpace::sights(const Eigen::Vector3f& p_W, const Eigen::Vector3f& normal_W,
                                      float grazing, float within_m,
                                      std::span<const std::size_t> views) const {
  SightsOfSurface seen;
  for (const std::size_t view : views) {
    const Look look_there = look(view, p_W);
    count(look_there, seen.sights);
    if (look_there.sight != Sight::kHidden || look_there.behind_m >= within_m) continue;
    const Eigen::Vector3f to_C = cones_[view].apex_W - p_W;
    seen.is_covered = seen.is_covered || to_C.dot(normal_W) >= grazing * to_C.norm();
  }
  return seen;
}

std::vector<Sights> ObservedSpace::sights(std::span<const Eigen::Vector3f> points_W) const {
  std::vector<std::pair<Cell, std::uint32_t>> by_cell;
  by_cell.reserve(points_W.size());
  for (std::size_t i = 0; i < points_W.size(); ++i) {
    by_cell.emplace_back(cell_of(points_W[i]), static_cast<std::uint32_t>(i));
  }
  std::ranges::sort(by_cell);
  std::vector<std::size_t> begins;  // of each cell in by_cell, and the end
  for (std::size_t i = 0; i < by_cell.size(); ++i) {
    if (i == 0 || by_cell[i].first != by_cell[i - 1].first) begins.push_back(i);
  }
  const std::size_t num_cells = begins.size();
  begins.push_back(by_cell.size());
  std::vector<Sights> all(points_W.size());
  oneapi::tbb::parallel_for(std::size_t{0}, num_cells, [&](std::size_t cell) {
    const auto& [x, y, z] = by_cell[begins[cell]].first;
    const Eigen::Vector3f center_W =
        kCell_m *
        (Eigen::Vector3f(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)) +
         Eigen::Vector3f::Constant(0.5F));
    const float radius_m = 0.5F * std::sqrt(3.0F) * kCell_m * 1.01F;  // 1 %: rounding
    const std::vector<std::size_t> views = views_of(center_W, radius_m);
    for (std::size_t k = begins[cell]; k < begins[cell + 1]; ++k) {
      const std::uint32_t i = by_cell[k].second;
      all[i] = sights(points_W[i], views);
    }
  });
  return all;
}

}  // namespace kintsugi::segmenter
