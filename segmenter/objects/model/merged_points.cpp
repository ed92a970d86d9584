#include "segmenter/objects/model/merged_points.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <tuple>
#include <unordered_map>

#include <Eigen/Core>

#include "segmenter/core/points/admission.hpp"

namespace kintsugi::segmenter {
namespace {

Eigen::Vector3f position_of(const CloudPoint& p) { return {p.x, p.y, p.z}; }
Eigen::Vector3f normal_of(const CloudPoint& p) { return {p.nx, p.ny, p.nz}; }

/// A point that was never observed counts once.
double weight_of(const CloudPoint& p) { return p.weight > 0.0F ? p.weight : 1.0; }

bool has_color(const CloudPoint& p) { return p.red != 0 || p.green != 0 || p.blue != 0; }

/// Finds the nearest of the points added so far, in a grid of cells as wide as the reach.
class NearestInReach {
 public:
  explicit NearestInReach(float reach_m) : reach_m_(reach_m) {}

  void add(const CloudPoint& point, std::size_t index) {
    cells_[key(cell_of(position_of(point)))].push_back({point, index});
  }

  /// The index of the nearest point within reach that is of one surface with `point`.
  [[nodiscard]] std::optional<std::size_t> find(const CloudPoint& point) const {
    const Eigen::Vector3i cell = cell_of(position_of(point));
    float nearest_m2 = reach_m_ * reach_m_;
    std::optional<std::size_t> found;
    for (int dz = -1; dz <= 1; ++dz) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const auto entries = cells_.find(key(cell + Eigen::Vector3i(dx, dy, dz)));
          if (entries == cells_.end()) continue;
          for (const Entry& entry : entries->second) {
            if (normal_of(entry.point).dot(normal_of(point)) < kOneSurface) continue;
            const float distance_m2 =
                (position_of(entry.point) - position_of(point)).squaredNorm();
            if (!(distance_m2 < nearest_m2)) continue;
            nearest_m2 = distance_m2;
            found = entry.index;
          }
        }
      }
    }
    return found;
  }

 private:
  struct Entry {
    CloudPoint point;  ///< as it was added
    std::size_t index;
  };

  [[nodiscard]] Eigen::Vector3i cell_of(const Eigen::Vector3f& p) const {
    // Beyond, cells would not fit; such points are far from any object.
    constexpr float kMaxCell = 1e9F;
    const Eigen::Array3f cell = (p / reach_m_).array().floor();
    return cell.max(-kMaxCell).min(kMaxCell).matrix().cast<int>();
  }
  static std::uint64_t key(const Eigen::Vector3i& cell) {
    constexpr std::uint64_t kMask = (std::uint64_t{1} << 21U) - 1;
    const auto part = [](int index) { return static_cast<std::uint64_t>(index) & kMask; };
    return part(cell.x()) << 42U | part(cell.y()) << 21U | part(cell.z());
  }

  float reach_m_;
  std::unordered_map<std::uint64_t, std::vector<Entry>> cells_;
};

/// The mean of points by weight.
class Mean {
 public:
  void add(const CloudPoint& p) {
    const double w = weight_of(p);
    weight_ += w;
    position_ += w * position_of(p).cast<double>();
    normal_ += w * normal_of(p).cast<double>();
    if (!has_color(p)) return;
    color_weight_ += w;
    color_ += w * Eigen::Vector3d(p.red, p.green, p.blue);
  }

  [[nodiscard]] CloudPoint point() const {
    CloudPoint p;
    const Eigen::Vector3f position = (position_ / weight_).cast<float>();
    const Eigen::Vector3f normal = normal_.normalized().cast<float>();
    std::tie(p.x, p.y, p.z) = std::tuple(position.x(), position.y(), position.z());
    std::tie(p.nx, p.ny, p.nz) = std::tuple(normal.x(), normal.y(), normal.z());
    if (color_weight_ > 0.0) {
      const Eigen::Vector3d color = color_ / color_weight_;
      p.red = static_cast<std::uint8_t>(std::lround(color.x()));
      p.green = static_cast<std::uint8_t>(std::lround(color.y()));
      p.blue = static_cast<std::uint8_t>(std::lround(color.z()));
    }
    p.weight = static_cast<float>(weight_);
    return p;
  }

 private:
  double weight_ = 0.0;
  double color_weight_ = 0.0;
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d color_ = Eigen::Vector3d::Zero();
};

auto order_of(const CloudPoint& p) {
  return std::tuple(p.z, p.y, p.x, p.nx, p.ny, p.nz, p.red, p.green, p.blue, p.weight);
}

void sort_by_place(std::vector<CloudPoint>& points) {
  std::sort(points.begin(), points.end(), [](const CloudPoint& a, const CloudPoint& b) {
    return order_of(a) < order_of(b);
  });
}

/// Moves `point` along its normal to the mean of both by weight. Along the surface it stays, so that
/// the points stay evenly spaced.
void average(CloudPoint& point, const CloudPoint& other) {
  Mean mean;
  mean.add(point);
  mean.add(other);
  const CloudPoint both = mean.point();
  const Eigen::Vector3f n = normal_of(point);
  const Eigen::Vector3f moved =
      position_of(point) + n * n.dot(position_of(both) - position_of(point));
  point = both;
  std::tie(point.x, point.y, point.z) = std::tuple(moved.x(), moved.y(), moved.z());
}

}  // namespace

std::vector<CloudPoint> merged_points(std::span<const CloudPoint> points, float reach_m) {
  std::vector<CloudPoint> sorted;
  sorted.reserve(points.size());
  for (const CloudPoint& p : points) {
    if (!reason_to_reject(p).has_value()) sorted.push_back(p);
  }
  sort_by_place(sorted);
  NearestInReach seeds(reach_m);
  std::vector<Mean> means;
  for (const CloudPoint& p : sorted) {
    const std::optional<std::size_t> seed = seeds.find(p);
    if (!seed.has_value()) {
      seeds.add(p, means.size());
      means.emplace_back();
    }
    means[seed.value_or(means.size() - 1)].add(p);
  }
  std::vector<CloudPoint> merged;
  merged.reserve(means.size());
  for (const Mean& mean : means) merged.push_back(mean.point());
  sort_by_place(merged);
  return merged;
}

std::size_t merge_surface(std::vector<CloudPoint>& points, std::span<const CloudPoint> more,
                          float reach_m) {
  NearestInReach nearest(reach_m);
  for (std::size_t i = 0; i < points.size(); ++i) nearest.add(points[i], i);
  const std::size_t before = points.size();
  for (const CloudPoint& p : more) {
    const std::optional<std::size_t> same = nearest.find(p);
    if (same.has_value()) {
      average(points[*same], p);
    } else {
      points.push_back(p);
    }
  }
  return points.size() - before;
}

}  // namespace kintsugi::segmenter
