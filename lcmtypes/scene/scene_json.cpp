#include "lcmtypes/scene/scene_json.hpp"

#include "lcmtypes/client/statistics_json.hpp"

namespace kintsugi::scene {

nlohmann::json tile_json(const Tile& tile) {
  const TilePoints& points = *tile.points;
  nlohmann::json json = {tile.id,      points.revision, tile.labels->revision,
                         points.count, tile.part,       readable(tile.resolution_m)};
  for (int axis = 0; axis < 3; ++axis) json.push_back(readable(points.box_min_P[axis]));
  for (int axis = 0; axis < 3; ++axis) json.push_back(readable(points.box_size_P[axis]));
  for (const float t : tile.X_WP.t_WP) json.push_back(readable(t));
  for (const float q : tile.X_WP.q_WP) json.push_back(readable(q));
  return json;
}

nlohmann::ordered_json segment_json(const SegmentStatistics& statistics,
                                    const SegmentPlane& plane) {
  nlohmann::ordered_json json = statistics_json(statistics);
  json["planar"] = plane.is_planar;
  if (plane.normal_W.isZero()) return json;
  const Eigen::Vector3f normal_W = plane.normal_W.cast<float>();
  json["plane"] = {
      {"normal", {readable(normal_W.x()), readable(normal_W.y()), readable(normal_W.z())}},
      {"offset", readable(static_cast<float>(plane.offset_m))},
      {"rms", readable(static_cast<float>(plane.rms_m))}};
  return json;
}

}  // namespace kintsugi::scene
