#include "segmenter/tools/objects/object_text.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>

#include <spdlog/fmt/fmt.h>

#include "lcmtypes/base/logger.hpp"

namespace kintsugi::segmenter {
namespace {

std::string ids_text(const std::vector<std::uint32_t>& ids) {
  return fmt::format("{}", fmt::join(ids, ","));
}

std::string parameters_text(const EngineConfig& config) {
  return fmt::format("--threshold {:g} --scale {:g} --color-weight {:g}", config.threshold,
                     config.scale, config.color_weight);
}

}  // namespace

std::string size_text(const ObjectModel& model) {
  Eigen::AlignedBox3f box_O;
  for (const CloudPoint& p : model.points_O) box_O.extend(Eigen::Vector3f(p.x, p.y, p.z));
  const Eigen::Vector3f size_m = box_O.sizes();
  return fmt::format("{:.2f} x {:.2f} x {:.2f} m", size_m.x(), size_m.y(), size_m.z());
}

std::string summary_text(const KnownObject& object) {
  return fmt::format("{}: {} points, {}, taught {} {}, {:.0f} % whole with {}", object.model.name,
                     object.model.points_O.size(), size_text(object.model),
                     object.model.times_taught, object.model.times_taught == 1 ? "time" : "times",
                     100.0 * object.wholeness, parameters_text(object.model.parameters));
}

std::string summary_text(const Refinement& refinement) {
  return fmt::format("{}; {} points are new, {:.0f} % of the sides that both have agree",
                     summary_text(refinement.object), refinement.num_added,
                     100.0 * refinement.fit.agreement);
}

std::string table_text(const ObjectLibrary& library) {
  std::size_t width = 6;
  for (const KnownObject& object : library.objects()) {
    width = std::max(width, object.model.name.size());
  }
  std::string text = fmt::format("{:<{}}  {:>7}  {:>20}  {:>6}  {:>5}  {:>6}\n", "object", width,
                                 "points", "size along x, y, z", "taught", "views", "whole");
  for (const KnownObject& object : library.objects()) {
    const ObjectModel& model = object.model;
    text += fmt::format("{:<{}}  {:>7}  {:>20}  {:>6}  {:>5}  {:>4.0f} %\n", model.name, width,
                        model.points_O.size(), size_text(model), model.times_taught,
                        model.views_O.size(), 100.0 * object.wholeness);
  }
  return text;
}

std::string details_text(const KnownObject& object) {
  const ObjectModel& model = object.model;
  std::string text = summary_text(object) + "\n";
  text +=
      fmt::format("resolution {:g} m, seen from {} directions, {}\n", model.resolution_m,
                  model.views_O.size(), model.has_up ? "z is up" : "which way is up is unknown");
  for (const Lesson& lesson : object.lessons) {
    text += fmt::format("taught from map '{}', session {}, segments {}\n", lesson.map_name,
                        lesson.map_session, ids_text(lesson.segment_ids));
  }
  return text;
}

void warn_of_refusals(const ObjectLibrary& library) {
  for (const RefusedObject& refused : library.refusals()) {
    spdlog::warn("'{}' is not used: {}", refused.name, refused.reason);
  }
}

const KnownObject& require_object(const ObjectLibrary& library, const std::string& name) {
  if (const KnownObject* const object = library.find(name)) return *object;
  for (const RefusedObject& refused : library.refusals()) {
    if (refused.name == name) throw std::runtime_error(refused.reason);
  }
  std::string known;
  for (const KnownObject& object : library.objects()) {
    known += (known.empty() ? "" : ", ") + object.model.name;
  }
  throw std::runtime_error(library.folder().string() + ": there is no object '" + name + "'; " +
                           (known.empty() ? "it has none" : "it has " + known));
}

}  // namespace kintsugi::segmenter
