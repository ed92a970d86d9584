#include "segmenter/objects/maps/map_agreement.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "segmenter/core/points/transformed_points.hpp"
#include "segmenter/objects/maps/surface_samples.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr double kCoarse_m = 0.06;  // some thousand samples of a room
constexpr double kFine_m = 0.025;
// From the mean of a coarse sample to that of the nearest fine one of the same surface: less than
// half the diagonal of a fine cell; as much again for the alignment and the noise of both maps.
constexpr float kReach_m = 0.045F;
constexpr float kAlike = 0.5F;  // cosine between normals: 60 degrees
constexpr std::size_t kLeastColored = 100;

struct Pair {
  CloudPoint a;
  CloudPoint b;
};

Support support_of(const std::vector<CloudPoint>& samples, const ComparedMap& other,
                   std::vector<Pair>* pairs) {
  const auto nearest = other.surface.nearest(samples);
  std::vector<Eigen::Vector3f> lost;
  std::size_t num_found = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const CloudPoint& there = other.surface.samples()[nearest[i].index];
    const bool is_found =
        nearest[i].distance_m <= kReach_m && normal_of(there).dot(normal_of(samples[i])) >= kAlike;
    if (!is_found) {
      lost.push_back(position_of(samples[i]));
      continue;
    }
    ++num_found;
    if (pairs != nullptr) pairs->push_back({there, samples[i]});
  }
  const std::vector<Sights> sights = other.space.sights(lost);
  const auto num_free = std::ranges::count_if(
      sights, [](const Sights& s) { return s.through > 0 && s.through > 2 * s.measured; });
  const auto all = static_cast<double>(std::max<std::size_t>(1, samples.size()));
  return {static_cast<double>(num_found) / all, static_cast<double>(num_free) / all};
}

double correlation_of(std::span<const Pair> pairs, std::uint8_t CloudPoint::*channel) {
  double a = 0.0;
  double b = 0.0;
  double aa = 0.0;
  double bb = 0.0;
  double ab = 0.0;
  for (const Pair& pair : pairs) {
    const double x = pair.a.*channel;
    const double y = pair.b.*channel;
    a += x;
    b += y;
    aa += x * x;
    bb += y * y;
    ab += x * y;
  }
  const auto n = static_cast<double>(pairs.size());
  const double spread = std::sqrt((aa - a * a / n) * (bb - b * b / n));
  return spread > 0.0 ? (ab - a * b / n) / spread : 0.0;
}

double color_agreement(std::vector<Pair> pairs) {
  std::erase_if(pairs, [](const Pair& pair) { return !has_color(pair.a) || !has_color(pair.b); });
  if (pairs.size() < kLeastColored) return 0.0;
  return (correlation_of(pairs, &CloudPoint::red) + correlation_of(pairs, &CloudPoint::green) +
          correlation_of(pairs, &CloudPoint::blue)) /
         3.0;
}

double agreement_of(const Support& support) {
  const double seen = support.found + support.contradicted;
  return seen > 0.0 ? support.found / seen : 0.0;
}

}  // namespace

ComparedMap::ComparedMap(const ObservedMap& map)
    : samples(surface_samples(map.points_W, kCoarse_m)),
      surface(surface_samples(map.points_W, kFine_m)),
      space(map.resolution_m) {
  for (const MapView& view : map.views) space.add(view);
}

double MapAgreement::overlap() const { return std::max(of_before.found, of_after.found); }

double MapAgreement::agreement() const {
  return std::min(agreement_of(of_before), agreement_of(of_after));
}

double MapAgreement::score() const { return overlap() * agreement() * (1.0 + color); }

MapAgreement compare(const ComparedMap& before, const ComparedMap& after, const Pose& X_AB) {
  MapAgreement result;
  std::vector<Pair> pairs;
  result.of_before = support_of(transformed(X_AB, before.samples), after, &pairs);
  result.of_after =
      support_of(transformed(X_AB.inverse(Eigen::Isometry), after.samples), before, nullptr);
  result.color = color_agreement(std::move(pairs));
  return result;
}

}  // namespace kintsugi::segmenter
