#include "segmenter/objects/recognition/placement.hpp"

#include <cstddef>
#include <map>

#include "segmenter/objects/recognition/scene_surface.hpp"

namespace kintsugi::segmenter {

namespace {

// Enough for stable shares, as in the search.
constexpr std::size_t kModelSamples = 300;

SceneSurface scene_around(const PreparedModel& model, const MapAccess& map, const Pose& X_WO) {
  const Eigen::Isometry3f X = X_WO.cast<float>();
  Eigen::AlignedBox3f box;
  for (const SurfacePoint& point : model.surface_O) box.extend(X * point.position);
  const float same_m = kSameDistance * model.spacing_m;
  const Eigen::Vector3f margin = Eigen::Vector3f::Constant(same_m);
  const MapExcerpt excerpt = map.points_in({box.min() - margin, box.max() + margin});
  return {excerpt.points_W, excerpt.segment_ids, same_m};
}

/// Whether the point of the map is surface of the object.
bool is_explained(const PreparedModel& model, const SurfacePoint& seen,
                  const Eigen::Isometry3f& X_OW, const LightChange& light) {
  const Eigen::Vector3f p = X_OW * seen.position;
  const std::int32_t nearest = model.field.nearest(p);
  if (nearest < 0) return false;
  const SurfacePoint& q = model.surface_O[static_cast<std::size_t>(nearest)];
  const float same_m = kSameDistance * model.spacing_m;
  return (p - q.position).squaredNorm() <= same_m * same_m &&
         q.normal.dot(X_OW.linear() * seen.normal) >= kSameNormal && same_color(q, seen, light);
}

enum class Evidence : std::uint8_t { kSeen, kContradicted, kUnknown };

Evidence evidence_at(const SurfacePoint& model_W, const SceneSurface& scene,
                     const ObservedSpace* observed, const LightChange& light) {
  const SurfacePoint* seen = scene.nearest(model_W.position);
  if (seen != nullptr) {
    if (!same_color(model_W, *seen, light)) return Evidence::kContradicted;
    // Another face of the same edge, or of something that touches the object.
    if (model_W.normal.dot(seen->normal) < kSameNormal) return Evidence::kUnknown;
    return Evidence::kSeen;
  }
  if (observed == nullptr || observed->empty()) return Evidence::kUnknown;
  const Sights sights = observed->sights(model_W.position);
  return sights.through > sights.measured ? Evidence::kContradicted : Evidence::kUnknown;
}

}  // namespace

float Placement::score() const {
  const float visible = seen + contradicted;
  return visible > 0.0F ? seen / visible * explained : 0.0F;
}

Placement placement_of(const PreparedModel& model, const MapAccess& map,
                       const PoseHypothesis& hypothesis) {
  Placement placement;
  placement.X_WO = hypothesis.X_WO;
  placement.light = hypothesis.light;
  const SceneSurface scene = scene_around(model, map, hypothesis.X_WO);

  const Eigen::Isometry3f X_OW = hypothesis.X_WO.inverse().cast<float>();
  std::map<std::uint32_t, std::int64_t> explained;  // points of each segment
  for (std::size_t i = 0; i < scene.surface_W().size(); ++i) {
    if (!is_explained(model, scene.surface_W()[i], X_OW, hypothesis.light)) continue;
    ++explained[scene.segment_ids()[i]];
    ++placement.points;
  }
  std::int64_t own = 0;
  std::int64_t own_explained = 0;
  for (const auto& [id, count] : explained) {
    const std::int64_t all = map.num_points(id);
    if (id == kNoSegment || 2 * count <= all) continue;
    placement.segment_ids.push_back(id);
    own += all;
    own_explained += count;
  }
  if (own > 0) {
    placement.explained = static_cast<float>(own_explained) / static_cast<float>(own);
    placement.own = static_cast<float>(own_explained) / static_cast<float>(placement.points);
  }

  const Surface samples_W = transformed(every_few(model.surface_O, kModelSamples), hypothesis.X_WO);
  float seen = 0.0F;
  float contradicted = 0.0F;
  for (const SurfacePoint& point : samples_W) {
    switch (evidence_at(point, scene, map.observed, hypothesis.light)) {
      case Evidence::kSeen:
        seen += 1.0F;
        break;
      case Evidence::kContradicted:
        contradicted += 1.0F;
        break;
      case Evidence::kUnknown:
        if (map.observed == nullptr) contradicted += 0.5F;
        break;
    }
  }
  if (!samples_W.empty()) {
    placement.seen = seen / static_cast<float>(samples_W.size());
    placement.contradicted = contradicted / static_cast<float>(samples_W.size());
  }
  return placement;
}

}  // namespace kintsugi::segmenter
