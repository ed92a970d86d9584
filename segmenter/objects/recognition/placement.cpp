#include "segmenter/objects/recognition/placement.hpp"

#include <algorithm>
#include <cstddef>
#include <map>

namespace kintsugi::segmenter {

namespace {

// Enough for stable shares, as in the search.
constexpr std::size_t kModelSamples = 300;

struct Counts {
  int all = 0;
  int explained = 0;
};

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
                     const ObservedSpace* observed, const LightChange& light, float same_m) {
  const std::int32_t nearest = scene.field().nearest(model_W.position);
  if (nearest >= 0) {
    const SurfacePoint& seen = scene.surface_W()[static_cast<std::size_t>(nearest)];
    if ((seen.position - model_W.position).squaredNorm() <= same_m * same_m) {
      if (!same_color(model_W, seen, light)) return Evidence::kContradicted;
      // Another face of the same edge, or of something that touches the object.
      if (model_W.normal.dot(seen.normal) < kSameNormal) return Evidence::kUnknown;
      return Evidence::kSeen;
    }
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

Placement placement_of(const PreparedModel& model, const SceneSurface& scene,
                       const ObservedSpace* observed, const PoseHypothesis& hypothesis) {
  Placement placement;
  placement.X_WO = hypothesis.X_WO;
  placement.light = hypothesis.light;

  const Eigen::Isometry3f X_OW = hypothesis.X_WO.inverse().cast<float>();
  std::map<std::uint32_t, Counts> by_segment;
  for (std::size_t i = 0; i < scene.surface_W().size(); ++i) {
    Counts& counts = by_segment[scene.segment_ids()[i]];
    ++counts.all;
    if (is_explained(model, scene.surface_W()[i], X_OW, hypothesis.light)) ++counts.explained;
  }
  Counts own;
  for (const auto& [id, counts] : by_segment) {
    placement.points += counts.explained;
    if (id == 0 || 2 * counts.explained <= counts.all) continue;
    placement.segment_ids.push_back(id);
    own.all += counts.all;
    own.explained += counts.explained;
  }
  if (own.all > 0) {
    placement.explained = static_cast<float>(own.explained) / static_cast<float>(own.all);
    placement.own = static_cast<float>(own.explained) / static_cast<float>(placement.points);
  }

  const Surface samples_W =
      transformed(every_few(model.surface_O, kModelSamples), hypothesis.X_WO);
  const float same_m = kSameDistance * model.spacing_m;
  float seen = 0.0F;
  float contradicted = 0.0F;
  for (const SurfacePoint& point : samples_W) {
    const Evidence evidence = evidence_at(point, scene, observed, hypothesis.light, same_m);
    if (evidence == Evidence::kSeen) seen += 1.0F;
    if (evidence == Evidence::kContradicted) contradicted += 1.0F;
    if (evidence == Evidence::kUnknown && observed == nullptr) contradicted += 0.5F;
  }
  if (!samples_W.empty()) {
    placement.seen = seen / static_cast<float>(samples_W.size());
    placement.contradicted = contradicted / static_cast<float>(samples_W.size());
  }
  return placement;
}

}  // namespace kintsugi::segmenter
