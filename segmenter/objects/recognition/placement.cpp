#include "segmenter/objects/recognition/placement.hpp"

#include <algorithm>
#include <cstddef>
#include <map>

#include "segmenter/objects/recognition/scene_surface.hpp"

namespace kintsugi::segmenter {

namespace {

// Enough for stable shares, as in the search.
constexpr std::size_t kModelSamples = 300;
constexpr std::size_t kSeenNormals = 100;

SceneSurface scene_around(const PreparedModel& model, const MapAccess& map, const Pose& X_WO) {
  const Eigen::Isometry3f X = X_WO.cast<float>();
  Eigen::AlignedBox3f box;
  for (const SurfacePoint& point : model.surface_O) box.extend(X * point.position);
  const float same_m = kSameDistance * model.spacing_m;
  const Eigen::Vector3f margin = Eigen::Vector3f::Constant(same_m);
  const MapExcerpt excerpt = map.points_in({box.min() - margin, box.max() + margin});
  return {excerpt.points_W, excerpt.segment_ids, map.resolution_m, same_m};
}

/// Whether the point of the map is surface of the object.
bool is_explained(const PreparedModel& model, const SurfacePoint& seen,
                  const Eigen::Isometry3f& X_OW, const LightChange& light) {
  const Eigen::Vector3f p = X_OW * seen.position;
  // The field knows quickly where there is nothing.
  if (model.field.nearest(p) < 0) return false;
  const SurfacePoint* const q = model.points_O.nearest_facing(p, X_OW.linear() * seen.normal);
  return q != nullptr && same_color(*q, seen, light);
}

/// Whether a surface with this normal was in view when the object was taught. Unknown views count
/// as all views.
bool was_in_view(const PreparedModel& model, const Eigen::Vector3f& normal_O) {
  const std::vector<Eigen::Vector3f>& views_O = model.object->views_O;
  return views_O.empty() || std::any_of(views_O.begin(), views_O.end(), [&](const auto& view_O) {
           return view_O.dot(normal_O) >= kGrazing;
         });
}

/// Whether a face with this normal is in view where the object is: something of it is in the map
/// that faces nearly the same way.
bool is_in_view(const std::vector<Eigen::Vector3f>& seen_normals_W,
                const Eigen::Vector3f& normal_W) {
  return std::any_of(seen_normals_W.begin(), seen_normals_W.end(),
                     [&](const auto& seen_W) { return seen_W.dot(normal_W) >= kSameNormal; });
}

enum class Evidence : std::uint8_t { kSeen, kContradicted, kUnknown };

Evidence evidence_at(const SurfacePoint& model_W, const SceneSurface& scene,
                     const ObservedSpace* observed, const LightChange& light) {
  const SurfacePoint* const seen = scene.nearest_facing(model_W.position, model_W.normal);
  if (seen != nullptr) {
    return same_color(model_W, *seen, light) ? Evidence::kSeen : Evidence::kContradicted;
  }
  // Another face of the same edge, or of something that touches the object.
  if (scene.nearest(model_W.position) != nullptr) return Evidence::kUnknown;
  if (observed == nullptr || observed->empty()) return Evidence::kUnknown;
  const Sights sights = observed->sights(model_W.position);
  return sights.through > sights.measured ? Evidence::kContradicted : Evidence::kUnknown;
}

}  // namespace

float Placement::score() const {
  const float visible = seen + contradicted;
  return visible > 0.0F ? seen / visible * explained * light_agreement : 0.0F;
}

Placement placement_of(const PreparedModel& model, const MapAccess& map,
                       const PoseHypothesis& hypothesis) {
  Placement placement;
  placement.X_WO = hypothesis.X_WO;
  placement.light = hypothesis.light;
  const SceneSurface scene = scene_around(model, map, hypothesis.X_WO);

  const Eigen::Isometry3f X_OW = hypothesis.X_WO.inverse().cast<float>();
  struct Counts {
    std::int64_t explained = 0;
    std::int64_t new_side = 0;  // not explained, but nothing is known of that side of the object
  };
  std::map<std::uint32_t, Counts> by_segment;
  std::vector<Eigen::Vector3f> seen_normals_W;
  for (std::size_t i = 0; i < scene.surface_W().size(); ++i) {
    const SurfacePoint& seen = scene.surface_W()[i];
    Counts& counts = by_segment[scene.segment_ids()[i]];
    if (is_explained(model, seen, X_OW, hypothesis.light)) {
      ++counts.explained;
      ++placement.points;
      seen_normals_W.push_back(seen.normal);
    } else if (!was_in_view(model, X_OW.linear() * seen.normal)) {
      ++counts.new_side;
    }
  }
  std::int64_t own = 0;
  std::int64_t own_explained = 0;
  for (const auto& [id, counts] : by_segment) {
    const std::int64_t all = map.num_points(id) - counts.new_side;
    if (id == kNoSegment || counts.explained == 0 || 2 * counts.explained <= all) continue;
    placement.segment_ids.push_back(id);
    own += all;
    own_explained += counts.explained;
  }
  if (own > 0) {
    placement.explained = static_cast<float>(own_explained) / static_cast<float>(own);
    placement.own = static_cast<float>(own_explained) / static_cast<float>(placement.points);
  }
  if (seen_normals_W.size() > kSeenNormals) {
    for (std::size_t i = 0; i < kSeenNormals; ++i) {
      seen_normals_W[i] = seen_normals_W[i * seen_normals_W.size() / kSeenNormals];
    }
    seen_normals_W.resize(kSeenNormals);
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
        if (map.observed == nullptr && is_in_view(seen_normals_W, point.normal)) {
          contradicted += 0.5F;
        }
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
