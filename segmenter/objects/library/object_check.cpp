#include "segmenter/objects/library/object_check.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>

#include "lcmtypes/base/argument_check.hpp"
#include "segmenter/core/points/admission.hpp"
#include "segmenter/objects/library/object_name.hpp"

namespace kintsugi::segmenter {
namespace {

void check_count(std::string_view field, std::size_t count, std::size_t lowest,
                 std::size_t highest) {
  check_range("the number of " + std::string(field), count, lowest, highest);
}

void check_point(std::size_t index, const CloudPoint& point, float reach_m) {
  const std::string place = "point " + std::to_string(index);
  if (const auto reason = reason_to_reject(point); reason.has_value()) {
    throw std::runtime_error(place + ": " + std::string(*reason));
  }
  const float farthest = std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)});
  require(farthest <= reach_m, place + " lies far outside", farthest,
          "at most " + std::to_string(reach_m) + " m from the origin");
  require(point.weight >= 0.0F && std::isfinite(point.weight), place + ": weight", point.weight,
          ">= 0 and finite");
}

void check(const KnownObject& object) {
  const ObjectModel& model = object.model;
  if (const auto reason = reason_to_refuse_name(model.name)) throw std::runtime_error(*reason);
  require(model.resolution_m >= 1e-4F && model.resolution_m <= 1.0F, "resolution_m",
          model.resolution_m, "within 0.0001 and 1 m");
  require(model.times_taught >= 1, "times_taught", model.times_taught, ">= 1");
  check_range("wholeness", object.wholeness, 0.0, 1.0);
  model.parameters.validate();
  check_count("points", model.points_O.size(), 1, kMaxObjectPoints);
  check_count("views", model.views_O.size(), 0, kMaxObjectViews);
  for (const Lesson& lesson : object.lessons) {
    // Years have four digits in the text.
    check_range<std::int64_t>("the time of a lesson", lesson.time_s, 0, 253'402'300'799);
    check_range<std::int64_t>("the session of a lesson", lesson.map_session, 0,
                              std::numeric_limits<std::int64_t>::max());
  }
  for (const Eigen::Vector3f& view_O : model.views_O) {
    require(std::abs(view_O.norm() - 1.0F) < kNormalLengthTolerance, "the length of a view",
            view_O.norm(), "1");
  }
  Eigen::AlignedBox3f box_O;
  for (std::size_t i = 0; i < model.points_O.size(); ++i) {
    const CloudPoint& point = model.points_O[i];
    check_point(i, point, kMaxObjectVoxels * model.resolution_m);
    box_O.extend(Eigen::Vector3f(point.x, point.y, point.z));
  }
  const float radius_m = box_O.diagonal().norm() / 2;
  require(radius_m <= kMaxObjectRadius_m, "half the diagonal of its box", radius_m,
          "at most " + std::to_string(kMaxObjectRadius_m) + " m");
}

}  // namespace

void check_object(const KnownObject& object) {
  try {
    check(object);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(error.what());
  }
}

}  // namespace kintsugi::segmenter
