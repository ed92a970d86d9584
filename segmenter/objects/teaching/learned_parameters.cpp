#include "segmenter/objects/teaching/learned_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "segmenter/core/make_engine.hpp"
#include "segmenter/core/parameters/presets.hpp"
#include "segmenter/core/points/admission.hpp"
#include "segmenter/core/points/point_cloud.hpp"

namespace kintsugi::segmenter {
namespace {

/// Differences of a share below this are noise.
constexpr double kNoDifference = 0.01;

Eigen::Vector3f position_of(const CloudPoint& p) { return {p.x, p.y, p.z}; }

/// The object and what is around it, half of its diagonal wide on every side.
struct Surroundings {
  PointCloud cloud;
  std::vector<bool> is_object;  ///< by index in the cloud
  std::int64_t num_object = 0;
};

Surroundings surroundings_of(const ObservedMap& map, const TaughtSurface& surface) {
  Eigen::AlignedBox3f box_W;
  for (const std::uint32_t i : surface.indices) {
    if (!reason_to_reject(map.points_W[i])) box_W.extend(position_of(map.points_W[i]));
  }
  Surroundings around;
  if (box_W.isEmpty()) return around;
  const Eigen::Vector3f margin_m = Eigen::Vector3f::Constant(box_W.diagonal().norm() / 2);
  const Eigen::AlignedBox3f wide_W(box_W.min() - margin_m, box_W.max() + margin_m);
  std::vector<CloudPoint> points_W;
  for (std::size_t i = 0; i < map.points_W.size(); ++i) {
    const CloudPoint& p = map.points_W[i];
    if (!wide_W.contains(position_of(p)) || reason_to_reject(p).has_value()) continue;
    const bool is_object = std::binary_search(surface.indices.begin(), surface.indices.end(),
                                              static_cast<std::uint32_t>(i));
    points_W.push_back(p);
    around.is_object.push_back(is_object);
    if (is_object) ++around.num_object;
  }
  around.cloud.add_slice(0, points_W);
  return around;
}

/// The share of the segment that is most like the object: points in both, of those in one of them.
double wholeness(const Surroundings& around, std::span<const ComponentId> components) {
  struct Counts {
    std::int64_t points = 0;
    std::int64_t of_object = 0;
  };
  std::unordered_map<ComponentId, Counts> segments;
  for (std::size_t i = 0; i < components.size(); ++i) {
    Counts& counts = segments[components[i]];
    ++counts.points;
    if (around.is_object[i]) ++counts.of_object;
  }
  double best = 0.0;
  for (const auto& [component, counts] : segments) {
    const std::int64_t in_one = around.num_object + counts.points - counts.of_object;
    best = std::max(best, static_cast<double>(counts.of_object) / static_cast<double>(in_one));
  }
  return best;
}

struct Candidate {
  EngineConfig parameters;
  double distance = 0.0;  ///< from the preset, in factors of two
};

/// By distance from the preset.
std::vector<Candidate> candidates(const EngineConfig& preset) {
  constexpr double kNoColor = 2.0;  // as far as a factor of four
  std::vector<Candidate> all;
  for (const double scale : {1.0, 0.5, 2.0, 0.25, 4.0}) {
    for (const double color : {1.0, 0.5, 2.0, 4.0, 0.0}) {
      for (const double threshold : {1.0, 0.5, 2.0}) {
        Candidate& candidate = all.emplace_back(Candidate{preset, 0.0});
        candidate.parameters.scale *= scale;
        candidate.parameters.color_weight *= color;
        candidate.parameters.threshold *= threshold;
        candidate.distance = std::abs(std::log2(scale)) + std::abs(std::log2(threshold)) +
                             (color > 0.0 ? std::abs(std::log2(color)) : kNoColor);
      }
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) {
    return a.distance < b.distance;
  });
  return all;
}

}  // namespace

LearnedParameters learned_parameters(const ObservedMap& map, const TaughtSurface& surface) {
  EngineConfig start = preset("objects");
  start.resolution_m = map.resolution_m;
  LearnedParameters best{start, 0.0};
  const Surroundings around = surroundings_of(map, surface);
  if (around.num_object == 0) return best;
  std::vector<LearnedParameters> tried;
  for (const Candidate& candidate : candidates(start)) {
    const auto engine = make_engine("batch", around.cloud, candidate.parameters);
    engine->update(around.cloud.everything());
    const LearnedParameters& learned =
        tried.emplace_back(LearnedParameters{candidate.parameters,
                                             wholeness(around, engine->components())});
    best.wholeness = std::max(best.wholeness, learned.wholeness);
    if (learned.wholeness >= 1.0 - kNoDifference) break;  // none can be better
  }
  return *std::find_if(tried.begin(), tried.end(), [&](const LearnedParameters& learned) {
    return learned.wholeness >= best.wholeness - kNoDifference;
  });
}

}  // namespace kintsugi::segmenter
