#include "segmenter/objects/recognition/placement.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "segmenter/objects/recognition/flat_patch.hpp"
#include "segmenter/objects/recognition/lit_model.hpp"

namespace kintsugi::segmenter {

namespace {

// Enough for stable shares, as in the search.
constexpr std::size_t kModelSamples = 300;
constexpr std::size_t kSeenNormals = 100;

// What an absent surface counts that may be there and hidden.
constexpr float kDoubtful = 0.5F;

/// Where points of the map may be surface of the object.
Eigen::AlignedBox3f box_around(const PreparedModel& model, const Pose& X_WO) {
  const Eigen::Isometry3f X = X_WO.cast<float>();
  Eigen::AlignedBox3f box_W;
  for (const SurfacePoint& point : model.surface_O) box_W.extend(X * point.position);
  const Eigen::Vector3f margin = Eigen::Vector3f::Constant(kSameDistance * model.spacing_m);
  return {box_W.min() - margin, box_W.max() + margin};
}

/// From the object's colour to that of a point of the map; nothing where the object has no surface.
std::optional<Eigen::Vector3f> color_difference_at(const PreparedModel& model,
                                                   const SurfacePoint& seen,
                                                   const Eigen::Isometry3f& X_OW, LitModel& lit) {
  const Eigen::Vector3f p = X_OW * seen.position;
  // The field knows quickly where there is nothing.
  if (model.field.nearest(p) < 0) return std::nullopt;
  const Eigen::Vector3f normal = X_OW.linear() * seen.normal;
  const NearestPoint nearest =
      model.grid_O.nearest(p, kSameDistance * model.spacing_m, facing(normal));
  if (nearest.index < 0) return std::nullopt;
  return lit.color_difference(static_cast<std::size_t>(nearest.index), seen);
}

/// Whether a surface with this normal was in view when the object was taught. Unknown views count
/// as all views.
bool was_in_view(const PreparedModel& model, const Eigen::Vector3f& normal_O) {
  const std::vector<Eigen::Vector3f>& views_O = model.object->views_O;
  return views_O.empty() || std::any_of(views_O.begin(), views_O.end(), [&](const auto& view_O) {
           return view_O.dot(normal_O) >= kGrazing;
         });
}

/// Whether the object would have this surface if it were its: it was in view when the object was
/// taught, and where it would be there was nothing.
bool speaks_against(const PreparedModel& model, const Eigen::Vector3f& p_O,
                    const Eigen::Vector3f& normal_O) {
  const EmptySpace& empty_O = model.object->empty_O;
  return empty_O.is_unknown() ? was_in_view(model, normal_O) : empty_O.contains(p_O);
}

/// Whether a face with this normal is in view where the object is: something of it is in the map
/// that faces nearly the same way.
bool is_in_view(const Surface& seen_W, const Eigen::Vector3f& normal_W) {
  return std::ranges::any_of(seen_W, facing(normal_W));
}

enum class Evidence : std::uint8_t {
  kSeen,
  kContradicted,
  kCovered,  ///< by something so near that the object would reach into it, or touch it
  kUnknown,
};

/// @param model_W the point of this number of the model, where the hypothesis puts it
/// @param views of the scene that may show the object, or what covers it
Evidence evidence_at(const PreparedModel& model, std::size_t model_point,
                     const SurfacePoint& model_W, const Scene& scene,
                     std::span<const std::size_t> views, LitModel& lit) {
  const SceneSurface& surface_W = scene.surface();
  const float within_m = kSameDistance * model.spacing_m;
  const SurfacePoint* const seen =
      surface_W.nearest(model_W.position, within_m, facing(model_W.normal));
  if (seen != nullptr) {
    return lit.same_color(model_point, *seen) ? Evidence::kSeen : Evidence::kContradicted;
  }
  // Another face of the same edge, or of something that touches the object.
  if (surface_W.nearest(model_W.position, within_m, any_point) != nullptr) {
    return Evidence::kUnknown;
  }
  if (views.empty()) return Evidence::kUnknown;
  const ObservedSpace& observed = *scene.observed();
  const auto [sights, is_covered] =
      observed.sights(model_W.position, model_W.normal, kGrazing, model.radius_m, views);
  if (sights.through > sights.measured) return Evidence::kContradicted;
  return is_covered ? Evidence::kCovered : Evidence::kUnknown;
}

/// The views that may show an object there, or what covers it.
std::vector<std::size_t> views_of(const PreparedModel& model, const Scene& scene,
                                  const Pose& X_WO) {
  if (scene.observed() == nullptr) return {};
  const Eigen::AlignedBox3f box_W = box_around(model, X_WO);
  return scene.observed()->views_of(box_W.center(), 0.5F * box_W.diagonal().norm(), model.radius_m);
}

/// Counts of points of the map.
struct Counts {
  std::int64_t explained = 0;
  std::int64_t new_side = 0;     // not explained, but nothing is known of that side of the object
  std::int64_t other_color = 0;  // on its surface, and counted there (Evidence::kContradicted)
};

struct SeenSurface {
  std::map<std::uint32_t, Counts> by_segment;
  Surface explained_W;
  std::vector<std::uint32_t> segments;                          // of each point of `explained_W`
  Eigen::Vector3f color_differences = Eigen::Vector3f::Zero();  // their sum
};

SeenSurface seen_surface(const PreparedModel& model, const Scene& scene, const Pose& X_WO,
                         LitModel& lit) {
  SeenSurface result;
  const Eigen::Isometry3f X_OW = X_WO.inverse().cast<float>();
  Counts* counts = nullptr;
  std::uint32_t last = kNoSegment;
  scene.surface().visit(
      box_around(model, X_WO), [&](const SurfacePoint& seen, std::uint32_t segment) {
        if (counts == nullptr || segment != last) counts = &result.by_segment[segment];
        last = segment;
        const std::optional difference = color_difference_at(model, seen, X_OW, lit);
        if (!difference) {
          if (!speaks_against(model, X_OW * seen.position, X_OW.linear() * seen.normal)) {
            ++counts->new_side;
          }
        } else if (!is_same_color(*difference)) {
          ++counts->other_color;
        } else {
          ++counts->explained;
          result.explained_W.push_back(seen);
          result.segments.push_back(segment);
          result.color_differences += *difference;
        }
      });
  return result;
}

/// What belongs to these segments.
Surface explained_of(const SeenSurface& seen, const std::vector<std::uint32_t>& segments) {
  Surface surface;
  for (std::size_t i = 0; i < seen.explained_W.size(); ++i) {
    if (std::ranges::binary_search(segments, seen.segments[i])) {
      surface.push_back(seen.explained_W[i]);
    }
  }
  return surface;
}

/// The segments most of whose points are explained, and what is said of them.
void add_segments(const SeenSurface& seen, const LabelledMap& map, Placement& placement) {
  std::int64_t own = 0;
  std::int64_t own_explained = 0;
  for (const auto& [id, counts] : seen.by_segment) {
    const std::int64_t all = map.num_points(id) - counts.new_side;
    if (id == kNoSegment || counts.explained == 0 || 2 * counts.explained <= all) continue;
    placement.segment_ids.push_back(id);
    own += all - counts.other_color;
    own_explained += counts.explained;
  }
  if (own == 0) return;
  placement.explained = static_cast<float>(own_explained) / static_cast<float>(own);
  placement.own = static_cast<float>(own_explained) / static_cast<float>(placement.points);
}

/// Shares of the model's surface that are in the map, and that should be.
void add_evidence(const PreparedModel& model, const Scene& scene, const Surface& explained_W,
                  LitModel& lit, Placement& placement) {
  const Surface seen_W = every_few(explained_W, kSeenNormals);
  const Eigen::Isometry3f X_WO = placement.X_WO.cast<float>();
  const std::vector<std::size_t> views = views_of(model, scene, placement.X_WO);
  const std::size_t samples = std::min(kModelSamples, model.surface_O.size());
  float seen = 0.0F;
  float contradicted = 0.0F;
  for (std::size_t k = 0; k < samples; ++k) {
    const std::size_t i = k * model.surface_O.size() / samples;
    SurfacePoint point_W = model.surface_O[i];
    point_W.position = X_WO * point_W.position;
    point_W.normal = X_WO.linear() * point_W.normal;
    switch (evidence_at(model, i, point_W, scene, views, lit)) {
      case Evidence::kSeen:
        seen += 1.0F;
        break;
      case Evidence::kContradicted:
        contradicted += 1.0F;
        break;
      case Evidence::kCovered:
        contradicted += kDoubtful;
        break;
      case Evidence::kUnknown:
        if (scene.observed() == nullptr && is_in_view(seen_W, point_W.normal)) {
          contradicted += kDoubtful;
        }
        break;
    }
  }
  if (samples == 0) return;
  placement.seen = seen / static_cast<float>(samples);
  placement.contradicted = contradicted / static_cast<float>(samples);
}

}  // namespace

float Placement::score() const {
  const float visible = seen + contradicted;
  return visible > 0.0F ? seen / visible * explained * light_agreement : 0.0F;
}

Placement placement_of(const PreparedModel& model, const Scene& scene,
                       const PoseHypothesis& hypothesis) {
  Placement placement;
  placement.X_WO = hypothesis.X_WO;
  placement.light = hypothesis.light;
  LitModel lit(model.surface_O, hypothesis.light);
  const SeenSurface seen = seen_surface(model, scene, hypothesis.X_WO, lit);
  placement.points = static_cast<std::int32_t>(seen.explained_W.size());
  placement.color_difference =
      seen.color_differences.norm() / static_cast<float>(std::max(placement.points, 1));
  add_segments(seen, scene.map(), placement);
  // Normals of its own segments, since what is beside a flat thing faces elsewhere; colours of all,
  // since what has another colour is often another segment.
  const Surface own_W = explained_of(seen, placement.segment_ids);
  placement.is_distinct = !own_W.empty() && !(is_flat(SurfaceMoments(own_W)) &&
                                              is_plain(SurfaceMoments(seen.explained_W)));
  add_evidence(model, scene, seen.explained_W, lit, placement);
  return placement;
}

std::set<std::uint32_t> segments_around(const PreparedModel& model, const Scene& scene,
                                        const Pose& X_WO) {
  std::set<std::uint32_t> segments;
  std::uint32_t last = kNoSegment;
  scene.surface().visit(box_around(model, X_WO), [&](const SurfacePoint&, std::uint32_t segment) {
    if (segment != last) segments.insert(segment);
    last = segment;
  });
  segments.erase(kNoSegment);
  return segments;
}

}  // namespace kintsugi::segmenter
