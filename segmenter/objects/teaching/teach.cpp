#include "segmenter/objects/teaching/teach.hpp"

#include <Eigen/Core>
#include <optional>
#include <stdexcept>
#include <utility>

#include "lcmtypes/scene/up_direction.hpp"
#include "segmenter/core/parameters/presets.hpp"
#include "segmenter/objects/library/object_check.hpp"
#include "segmenter/objects/model/empty_space.hpp"
#include "segmenter/objects/model/make_model.hpp"
#include "segmenter/objects/model/object_views.hpp"
#include "segmenter/objects/teaching/learned_parameters.hpp"
#include "segmenter/views/observed_space.hpp"

namespace kintsugi::segmenter {
namespace {

std::optional<Eigen::Vector3d> up_of(const ObservedMap& map) {
  UpDirection up;
  up.add(map.points_W);
  if (!up.is_supported()) return std::nullopt;
  return up.up_W();
}

void check_size(const ObservedMap& map, std::size_t num_points) {
  EngineConfig config = preset("objects");
  config.resolution_m = map.resolution_m;
  const auto fewest = static_cast<std::size_t>(config.fragment_limit());
  if (num_points >= fewest) return;
  throw std::runtime_error("has " + std::to_string(num_points) + " points, at least " +
                           std::to_string(fewest) +
                           " are needed: a smaller segment is joined to its neighbour, so that "
                           "the object would never be found");
}

}  // namespace

KnownObject taught_object(const std::string& name, const ObservedMap& map,
                          std::span<const CloudPoint> points_W, const TaughtSurface& surface,
                          std::int64_t time_s) {
  check_size(map, points_W.size());
  MadeModel made = make_model(name, points_W, map.resolution_m, up_of(map));
  KnownObject object;
  object.model = std::move(made.model);
  object.model.views_O =
      directions_of_views(object.model.points_O, made.X_WO, map.views, map.resolution_m);
  ObservedSpace observed(map.resolution_m);
  for (const MapView& view : map.views) observed.add(view);
  object.model.empty_O = empty_space(object.model.points_O, made.X_WO, observed);
  const LearnedParameters learned = learned_parameters(map, surface);
  object.model.parameters = learned.parameters;
  object.wholeness = learned.wholeness;
  object.lessons = {{.map_name = map.map_name,
                     .map_session = map.map_session,
                     .segment_ids = surface.segment_ids,
                     .time_s = time_s,
                     .X_WO = rows_of(made.X_WO)}};
  check_object(object);
  return object;
}

}  // namespace kintsugi::segmenter
