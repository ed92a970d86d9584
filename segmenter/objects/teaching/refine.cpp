#include "segmenter/objects/teaching/refine.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "segmenter/core/points/transformed_points.hpp"
#include "segmenter/objects/library/object_check.hpp"
#include "segmenter/objects/model/empty_space.hpp"
#include "segmenter/objects/model/make_model.hpp"
#include "segmenter/objects/model/merged_points.hpp"
#include "segmenter/objects/model/object_views.hpp"
#include "segmenter/objects/model/shortest_rotation.hpp"
#include "segmenter/objects/recognition/agreement.hpp"
#include "segmenter/objects/recognition/lit_model.hpp"
#include "segmenter/objects/recognition/pose_refinement.hpp"
#include "segmenter/objects/recognition/pose_search.hpp"
#include "segmenter/objects/recognition/prepared_model.hpp"
#include "segmenter/objects/teaching/slide.hpp"

namespace kintsugi::segmenter {
namespace {

/// With less in both, an observation of another side could lie anywhere.
constexpr double kLeastCommon = 1.0 / 3;
/// In two recordings of the synthetic office, 23 of 25 pairs of segments of one thing agree so far,
/// and none of 39 pairs of different things. The other two were divided differently: to refuse them
/// is better than to spoil a model.
constexpr double kLeastAgreement = 0.75;
/// Cosine of 25 degrees: a side of an object is flat, or nearly so.
constexpr float kSameSide = 0.9F;
constexpr std::size_t kHypotheses = 4;  ///< a box looks alike after a quarter of a turn

/// Turns O so that z is up.
Pose leveling(const ObjectModel& model) {
  Pose X_LO = Pose::Identity();
  if (!model.has_up) {
    X_LO.linear() =
        shortest_rotation(-Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  }
  return X_LO;
}

ObjectModel leveled(const ObjectModel& model, const Pose& X_LO) {
  ObjectModel level = model;
  for (CloudPoint& p : level.points_O) p = transformed(p, X_LO);
  return level;
}

/// Directions in which an observation has surface: those of at least one of a hundred points.
std::vector<Eigen::Vector3f> sides_of(const Surface& surface) {
  std::vector<std::pair<Eigen::Vector3f, std::size_t>> sides;
  for (const SurfacePoint& point : surface) {
    const auto same = std::find_if(sides.begin(), sides.end(), [&](const auto& side) {
      return side.first.dot(point.normal) > 0.95F;
    });
    if (same == sides.end()) {
      sides.emplace_back(point.normal, 1);
    } else {
      ++same->second;
    }
  }
  std::vector<Eigen::Vector3f> normals;
  for (const auto& [normal, count] : sides) {
    if (100 * count >= surface.size()) normals.push_back(normal);
  }
  return normals;
}

struct Counts {
  std::int64_t points = 0;
  std::int64_t comparable = 0;  ///< on sides that the other observation has, too
  std::int64_t same = 0;        ///< that the other has, too
};

/// Compares the surface `seen` with that of the model, which is at X_SO in its frame.
Counts compare(const PreparedModel& model, const Surface& seen, const Pose& X_SO,
               const LightChange& light, const std::vector<Eigen::Vector3f>& sides_O) {
  const Eigen::Isometry3f X_OS = X_SO.inverse().cast<float>();
  const float reach_m = kSameDistance * model.spacing_m;
  LitModel lit(model.surface_O, light);
  Counts counts;
  for (const SurfacePoint& point : seen) {
    const Eigen::Vector3f p_O = X_OS * point.position;
    const Eigen::Vector3f n_O = X_OS.linear() * point.normal;
    ++counts.points;
    const std::int32_t nearest = model.field.nearest(p_O);
    const SurfacePoint* const other =
        nearest < 0 ? nullptr : &model.surface_O[static_cast<std::size_t>(nearest)];
    const bool is_same = other != nullptr && (other->position - p_O).norm() <= reach_m &&
                         other->normal.dot(n_O) >= kSameNormal &&
                         lit.same_color(static_cast<std::size_t>(nearest), point);
    if (is_same) ++counts.same;
    if (is_same || std::any_of(sides_O.begin(), sides_O.end(), [&](const Eigen::Vector3f& side) {
          return side.dot(n_O) > kSameSide;
        })) {
      ++counts.comparable;
    }
  }
  return counts;
}

double share(std::int64_t part, std::int64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

/// Two observations, each in a level frame of its own.
class FitSearch {
 public:
  FitSearch(const ObjectModel& known, const ObjectModel& lesson, float spacing_m)
      : known_(known, spacing_m),
        lesson_(lesson, spacing_m),
        known_sides_(sides_of(known_.surface_O)),
        lesson_sides_(sides_of(lesson_.surface_O)) {}

  /// X_OL between the level frames.
  [[nodiscard]] ObservationFit best() const {
    ObservationFit best;
    const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    const auto consider = [&](const Pose& X_OL, const LightChange& light) {
      const ObservationFit fit = fit_at(X_OL, light);
      if (fit.common * fit.agreement > best.common * best.agreement) best = fit;
    };
    // Of a hypothesis W is the frame of what is seen, and `light` what that has more.
    for (const PoseHypothesis& found : upright_poses(known_, lesson_.surface_O, up, kHypotheses)) {
      const PoseHypothesis fine = refined_pose(known_, lesson_.surface_O, found.X_WO);
      consider(fine.X_WO.inverse(), fine.light);
    }
    for (const PoseHypothesis& found : upright_poses(lesson_, known_.surface_O, up, kHypotheses)) {
      const PoseHypothesis fine = refined_pose(lesson_, known_.surface_O, found.X_WO);
      LightChange light;
      light.log_gain = -fine.light.log_gain;
      consider(fine.X_WO, light);
    }
    if (!best.is_one_object()) return best;
    return fit_at(slid(known_.object->points_O, lesson_.object->points_O, best.X_OL, best.light,
                       known_.spacing_m),
                  best.light);
  }

 private:
  /// @param light what the lesson has more
  [[nodiscard]] ObservationFit fit_at(const Pose& X_OL, const LightChange& light) const {
    LightChange back;
    back.log_gain = -light.log_gain;
    const Counts lesson = compare(known_, lesson_.surface_O, X_OL.inverse(), light, known_sides_);
    const Counts known = compare(lesson_, known_.surface_O, X_OL, back, lesson_sides_);
    ObservationFit fit;
    fit.X_OL = X_OL;
    fit.light = light;
    fit.common = std::max(share(lesson.same, lesson.points), share(known.same, known.points));
    fit.agreement = share(lesson.same + known.same, lesson.comparable + known.comparable);
    return fit;
  }

  PreparedModel known_;
  PreparedModel lesson_;
  std::vector<Eigen::Vector3f> known_sides_;
  std::vector<Eigen::Vector3f> lesson_sides_;
};

std::string percent(double share) { return std::to_string(std::lround(100.0 * share)) + " %"; }

/// @param X_OL of the lesson's frame in the object's
void add_lesson(KnownObject& object, const KnownObject& lesson, const Pose& X_OL) {
  if (lesson.wholeness > object.wholeness) {
    object.model.parameters = lesson.model.parameters;
    object.wholeness = lesson.wholeness;
  }
  for (Lesson added : lesson.lessons) {
    if (added.X_WO) added.X_WO = rows_of(pose_of(*added.X_WO) * X_OL.inverse());
    object.lessons.push_back(std::move(added));
  }
  const std::int64_t times = std::int64_t{object.model.times_taught} + lesson.model.times_taught;
  object.model.times_taught = static_cast<std::int32_t>(
      std::min<std::int64_t>(times, std::numeric_limits<std::int32_t>::max()));
}

}  // namespace

bool ObservationFit::is_one_object() const {
  return common >= kLeastCommon && agreement >= kLeastAgreement;
}

ObservationFit fit_observation(const ObjectModel& known, const ObjectModel& lesson) {
  const Pose X_known = leveling(known);
  const Pose X_lesson = leveling(lesson);
  const ObjectModel level_known = leveled(known, X_known);
  const ObjectModel level_lesson = leveled(lesson, X_lesson);
  ObservationFit fit =
      FitSearch(level_known, level_lesson, std::max(known.resolution_m, lesson.resolution_m))
          .best();
  fit.X_OL = X_known.inverse() * fit.X_OL * X_lesson;
  return fit;
}

Refinement refined(const KnownObject& known, const KnownObject& lesson) {
  Refinement refinement;
  refinement.object = known;
  refinement.fit = fit_observation(known.model, lesson.model);
  if (!refinement.fit.is_one_object()) {
    throw std::runtime_error(
        "does not fit what is known of '" + known.model.name +
        "': " + percent(refinement.fit.common) +
        " of the smaller surface lie on the other, at least " + percent(kLeastCommon) +
        " are needed; of the sides that both have seen " + percent(refinement.fit.agreement) +
        " agree, at least " + percent(kLeastAgreement) + " are needed");
  }
  ObjectModel& model = refinement.object.model;
  std::vector<CloudPoint> more_O;
  more_O.reserve(lesson.model.points_O.size());
  for (const CloudPoint& p : lesson.model.points_O) {
    more_O.push_back(transformed(p, refinement.fit.X_OL));
  }
  relight(more_O, (-refinement.fit.light.log_gain.array()).exp());
  refinement.num_added = merge_surface(
      model.points_O, more_O, std::max(known.model.resolution_m, lesson.model.resolution_m));
  std::vector<Eigen::Vector3f> views_O;
  views_O.reserve(lesson.model.views_O.size());
  for (const Eigen::Vector3f& view : lesson.model.views_O) {
    views_O.emplace_back(refinement.fit.X_OL.linear().cast<float>() * view);
  }
  merge_directions(model.views_O, views_O);
  model.empty_O =
      merged(model.points_O, known.model.empty_O, lesson.model.empty_O, refinement.fit.X_OL);
  add_lesson(refinement.object, lesson, refinement.fit.X_OL);
  check_object(refinement.object);
  return refinement;
}

}  // namespace kintsugi::segmenter
