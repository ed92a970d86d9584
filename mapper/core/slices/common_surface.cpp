#include "mapper/core/slices/common_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "mapper/core/slices/tile.hpp"

namespace kintsugi::mapper {
namespace {

// The extractor gives a point where an edge of the grid of voxels crosses the surface: no place on
// the surface is farther from one.
constexpr double kSpacing_vox = 1.0;

Eigen::Vector3d position_of(const CloudPoint& p) { return {p.x, p.y, p.z}; }
Eigen::Vector3d normal_of(const CloudPoint& p) { return {p.nx, p.ny, p.nz}; }

int log2_of_mean_weight(const std::vector<CloudPoint>& points) {
  double sum = 0.0;
  for (const CloudPoint& p : points) sum += p.weight;
  return std::ilogb(std::max(1.0, sum / static_cast<double>(points.size())));
}

/// Surface points in one frame, by cells of a grid.
class PointsByCell {
 public:
  struct Point {
    TileCoord cell;
    Eigen::Vector3d position;
    Eigen::Vector3d normal;
  };

  explicit PointsByCell(double side_m) : side_m_(side_m) {}

  void add(const Eigen::Vector3d& position, const Eigen::Vector3d& normal) {
    points_.push_back({cell_of(position), position, normal});
  }

  bool empty() const { return points_.empty(); }

  void sort() { std::ranges::sort(points_, {}, &Point::cell); }

  /// Whether the condition holds for one of the points that are less than a side away; after
  /// sort().
  template <typename Condition>
  bool any_near(const Eigen::Vector3d& position, Condition condition) const {
    const TileCoord center = cell_of(position);
    for (int z = center.z - 1; z <= center.z + 1; ++z) {
      for (int y = center.y - 1; y <= center.y + 1; ++y) {
        const TileCoord first{.z = z, .y = y, .x = center.x - 1};
        const TileCoord last{.z = z, .y = y, .x = center.x + 1};
        auto point = std::ranges::lower_bound(points_, first, {}, &Point::cell);
        for (; point != points_.end() && point->cell <= last; ++point) {
          if (condition(*point)) return true;
        }
      }
    }
    return false;
  }

 private:
  TileCoord cell_of(const Eigen::Vector3d& position) const {
    const Eigen::Vector3i cell = (position / side_m_).array().floor().cast<int>();
    return {.z = cell.z(), .y = cell.y(), .x = cell.x()};
  }

  double side_m_;
  std::vector<Point> points_;
};

}  // namespace

CommonSurface::CommonSurface(const Config& config)
    : keeps_own_(config.keeps_own),
      along_m_(config.same.max_distance_vox * config.resolution_m),
      across_m_(kSpacing_vox * config.resolution_m),
      reach_m_(std::hypot(along_m_, across_m_)),
      least_cosine_(std::cos(config.same.max_angle_deg * std::numbers::pi / 180.0)) {}

void CommonSurface::set(const Name& name, std::vector<CloudPoint> points_P, const PatchPose& X_WP) {
  if (const Patch* const before = find(name)) {
    forget_what_touches(*before, name.session);
    sessions_.at(name.session).erase(name.id);
  }
  waiting_.erase(name);
  differing_.erase(name);
  if (points_P.empty()) return;
  Patch& patch = sessions_[name.session][name.id];
  patch.X_WP = X_WP.pose();
  Eigen::AlignedBox3d box_P;
  for (const CloudPoint& p : points_P) box_P.extend(position_of(p));
  patch.center_P = box_P.center();
  patch.radius_m = 0.5 * box_P.diagonal().norm();
  const bool is_kept = keeps_own_ && name.session == kOwnSession;
  patch.observations_log2 =
      is_kept ? std::numeric_limits<int>::max() : log2_of_mean_weight(points_P);
  patch.is_covered.assign(points_P.size(), false);
  patch.points_P = std::move(points_P);
  forget_what_touches(patch, name.session);
  waiting_.insert(name);
}

void CommonSurface::move(const Name& name, const PatchPose& X_WP) {
  Patch* const patch = find(name);
  if (patch == nullptr) return;
  patch->X_WP = X_WP.pose();
  has_moved_ = true;
}

CommonSurface::Patch* CommonSurface::find(const Name& name) {
  const auto session = sessions_.find(name.session);
  if (session == sessions_.end()) return nullptr;
  const auto patch = session->second.find(name.id);
  return patch == session->second.end() ? nullptr : &patch->second;
}

/// What was computed of patches of others that this one may cover.
void CommonSurface::forget_what_touches(const Patch& patch, std::int64_t session) {
  for (const auto& [other_session, others] : sessions_) {
    if (other_session == session) continue;
    for (const auto& [id, other] : others) {
      if (touch(patch, other)) waiting_.insert({other_session, id});
    }
  }
}

bool CommonSurface::touch(const Patch& a, const Patch& b) const {
  const double limit_m = a.radius_m + b.radius_m + reach_m_;
  return (a.X_WP * a.center_P - b.X_WP * b.center_P).squaredNorm() <= limit_m * limit_m;
}

/// Of each point of a patch, whether a better patch has it.
std::vector<bool> CommonSurface::covered(const Patch& patch, std::int64_t session) const {
  // In a frame O with the axes of P and the patch at its origin: parts of a map are kilometres
  // apart.
  const Pose X_PW = patch.X_WP.inverse(Eigen::Isometry);
  const double radius_m = patch.radius_m + reach_m_;
  PointsByCell better_O(reach_m_);
  for (const auto& [other_session, others] : sessions_) {
    if (other_session == session) continue;
    for (const auto& [id, other] : others) {
      const bool is_better = other.observations_log2 == patch.observations_log2
                                 ? other_session < session
                                 : other.observations_log2 > patch.observations_log2;
      if (!is_better || !touch(patch, other)) continue;
      const Pose X_PQ = X_PW * other.X_WP;
      for (const CloudPoint& point_Q : other.points_P) {
        const Eigen::Vector3d p_O = X_PQ * position_of(point_Q) - patch.center_P;
        if (p_O.squaredNorm() > radius_m * radius_m) continue;
        better_O.add(p_O, X_PQ.linear() * normal_of(point_Q));
      }
    }
  }
  if (better_O.empty()) return std::vector<bool>(patch.points_P.size(), false);
  better_O.sort();

  std::vector<bool> is_covered;
  is_covered.reserve(patch.points_P.size());
  for (const CloudPoint& point_P : patch.points_P) {
    const Eigen::Vector3d p_O = position_of(point_P) - patch.center_P;
    const Eigen::Vector3d normal = normal_of(point_P);
    is_covered.push_back(better_O.any_near(p_O, [&](const PointsByCell::Point& better) {
      if (better.normal.dot(normal) < least_cosine_) return false;
      const Eigen::Vector3d apart = p_O - better.position;
      const double along_m = apart.dot(better.normal);
      const double across_m2 = apart.squaredNorm() - along_m * along_m;
      return std::abs(along_m) <= along_m_ && across_m2 <= across_m_ * across_m_;
    }));
  }
  return is_covered;
}

std::vector<CloudPoint> CommonSurface::take(const Name& name) {
  waiting_.erase(name);
  differing_.erase(name);
  Patch* const patch = find(name);
  return patch == nullptr ? std::vector<CloudPoint>() : rest(*patch, covered(*patch, name.session));
}

CommonSurface::Names& CommonSurface::waiting() {
  if (std::exchange(has_moved_, false)) {
    for (const auto& [session, patches] : sessions_) {
      for (const auto& [id, patch] : patches) waiting_.insert({session, id});
    }
  }
  return waiting_;
}

std::vector<CommonSurface::Rest> CommonSurface::take_changed(std::size_t max_patches) {
  Names names;
  Names& from = waiting();
  while (names.size() < max_patches && !from.empty()) {
    auto next = from.upper_bound(last_);
    if (next == from.end()) next = from.begin();
    last_ = *next;
    names.insert(last_);
    from.erase(next);
  }
  return take_changed(names, false);
}

std::vector<CommonSurface::Rest> CommonSurface::take_all_changed() {
  Names names = std::exchange(waiting(), {});
  names.merge(std::exchange(differing_, {}));
  return take_changed(names, true);
}

std::vector<CommonSurface::Rest> CommonSurface::take_changed(const Names& names, bool also_little) {
  std::vector<Rest> changed;
  for (const Name& name : names) {
    differing_.erase(name);
    Patch* const patch = find(name);
    if (patch == nullptr) continue;
    std::vector<bool> is_covered = covered(*patch, name.session);
    double num_changed = 0.0;
    for (std::size_t i = 0; i < is_covered.size(); ++i) {
      if (is_covered[i] != patch->is_covered[i]) ++num_changed;
    }
    if (num_changed == 0.0) continue;
    const bool is_little = num_changed * num_changed <= static_cast<double>(is_covered.size());
    if (is_little && !also_little) {
      differing_.insert(name);
    } else {
      changed.push_back({name, rest(*patch, std::move(is_covered))});
    }
  }
  return changed;
}

std::vector<CloudPoint> CommonSurface::rest(Patch& patch, std::vector<bool> is_covered) {
  patch.is_covered = std::move(is_covered);
  std::vector<CloudPoint> rest;
  for (std::size_t i = 0; i < patch.points_P.size(); ++i) {
    if (!patch.is_covered[i]) rest.push_back(patch.points_P[i]);
  }
  return rest;
}

}  // namespace kintsugi::mapper
