#include "segmenter/tools/export/mesh_segments.hpp"

#include <stdexcept>
#include <string>

#include "segmenter/core/points/admission.hpp"
#include "segmenter/io/ply/ply_reader.hpp"
#include "segmenter/preprocess/nearest_neighbours.hpp"

namespace kintsugi::segmenter {

std::vector<std::uint32_t> mesh_segments(const MapSnapshot& map,
                                         const std::filesystem::path& mesh) {
  const std::vector<CloudPoint> vertices_W = read_ply(mesh).points_W;
  for (std::size_t i = 0; i < vertices_W.size(); ++i) {
    if (const auto reason = reason_to_reject_position(vertices_W[i]); reason.has_value()) {
      throw std::runtime_error(mesh.string() + ": vertex " + std::to_string(i) + ": " +
                               std::string(*reason));
    }
  }
  std::vector<CloudPoint> points_W;
  std::vector<std::uint32_t> ids;
  for (std::size_t i = 0; i < map.state.points_W.size(); ++i) {
    if (map.state.segment_ids[i] == kNoSegment) continue;
    points_W.push_back(map.state.points_W[i]);
    ids.push_back(map.state.segment_ids[i]);
  }
  NearestNeighbours::Result nearest;
  NearestNeighbours(points_W).find(vertices_W, 1, nearest);
  const float radius_m = map.state.config.engine.radius_m();
  std::vector<std::uint32_t> segments(vertices_W.size(), kNoSegment);
  for (std::size_t i = 0; i < nearest.indices.size(); ++i) {
    if (nearest.squared_distances[i] < radius_m * radius_m) segments[i] = ids[nearest.indices[i]];
  }
  return segments;
}

}  // namespace kintsugi::segmenter
