#include "segmenter/tools/export/html_scene.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "lcmtypes/base/atomic_file.hpp"
#include "lcmtypes/base/json_text.hpp"
#include "lcmtypes/scene/page.hpp"
#include "lcmtypes/scene/scene_json.hpp"
#include "lcmtypes/scene/up_direction.hpp"
#include "segmenter/core/points/admission.hpp"

namespace kintsugi::segmenter {
namespace {

using Json = nlohmann::json;
constexpr double kTile_vox = 64.0;

/// Part of the map, then the cube along x, y and z.
using Cube = std::array<std::int64_t, 4>;

struct CubePoints {
  std::vector<CloudPoint> points_W;
  std::vector<std::uint32_t> segment_ids;
};

Cube cube_of(const CloudPoint& point, std::int32_t part, double edge_m) {
  const auto index = [edge_m](float x) {
    return static_cast<std::int64_t>(std::floor(static_cast<double>(x) / edge_m));
  };
  return {part, index(point.x), index(point.y), index(point.z)};
}

Json parts_json(const MapSnapshot& map, std::span<const scene::Tile> tiles) {
  std::map<std::int32_t, std::pair<std::int64_t, UpDirection>> parts;
  for (const scene::Tile& tile : tiles) parts[tile.part].first += tile.points->count;
  for (const SliceRecord& slice : map.state.slices) {
    const auto of_part = parts.find(slice.place.part);
    if (of_part == parts.end()) continue;
    of_part->second.second.add(std::span(map.state.points_W).subspan(slice.first, slice.count));
  }
  Json json = Json::array();
  for (const auto& [part, of_part] : parts) {
    const Eigen::Vector3d up_W = of_part.second.up_W();
    json.push_back(
        {{"part", part}, {"points", of_part.first}, {"up", {up_W.x(), up_W.y(), up_W.z()}}});
  }
  return json;
}

/// The part with the most points is shown first.
std::int32_t largest_part(const Json& parts) {
  std::int64_t most = -1;
  std::int32_t largest = 0;
  for (const Json& part : parts) {
    if (part["points"].get<std::int64_t>() <= most) continue;
    most = part["points"];
    largest = part["part"];
  }
  return largest;
}

/// As the state of a viewer that has the whole map.
Json state_json(const MapSnapshot& map, std::span<const scene::Tile> tiles) {
  Json tile_entries = Json::array();
  std::int64_t num_points = 0;
  for (const scene::Tile& tile : tiles) {
    tile_entries.push_back(scene::tile_json(tile));
    num_points += tile.points->count;
  }
  const Json parts = parts_json(map, tiles);
  return {{"epoch", 1},
          {"version", 1},
          {"segments_version", 1},
          {"image_version", 0},
          {"path_version", 0},
          {"map", map.state.map_name},
          {"time_s", 0},
          {"points", num_points},
          {"segments", map.segments.size()},
          {"slices", map.state.slices.size()},
          {"lag", 0},
          {"final", map.is_complete},
          {"problem", ""},
          {"parts", parts},
          {"camera_part", largest_part(parts)},
          {"loops", Json::array()},
          {"objects", Json::array()},
          {"frustum", nullptr},
          {"tiles", std::move(tile_entries)},
          {"removed", Json::array()}};
}

nlohmann::ordered_json segment_json(const SegmentDescription& segment) {
  const PlaneFit& plane = segment.shape.plane;
  nlohmann::ordered_json json = scene::segment_json(
      segment.statistics, {plane.normal_W, plane.offset_m, plane.rms_m, segment.shape.is_planar});
  Json neighbours = Json::array();
  for (const SegmentNeighbour& neighbour : segment.neighbours) {
    neighbours.push_back({neighbour.segment_id, neighbour.num_pairs});
  }
  json["neighbours"] = neighbours;
  return json;
}

}  // namespace

std::vector<scene::Tile> tiles_of(const MapSnapshot& map) {
  const auto resolution_m = static_cast<float>(map.state.config.engine.resolution_m);
  std::map<Cube, CubePoints> cubes;
  for (const SliceRecord& slice : map.state.slices) {
    for (std::size_t i = slice.first; i < std::size_t{slice.first} + slice.count; ++i) {
      const CloudPoint& point = map.state.points_W[i];
      if (reason_to_reject_position(point).has_value()) continue;
      CubePoints& cube = cubes[cube_of(point, slice.place.part, kTile_vox * resolution_m)];
      cube.points_W.push_back(point);
      cube.segment_ids.push_back(map.state.segment_ids[i]);
    }
  }
  std::vector<scene::Tile> tiles;
  for (auto& [cube, points] : cubes) {
    scene::Tile tile;
    tile.id = static_cast<std::uint32_t>(tiles.size());
    tile.part = static_cast<std::int32_t>(cube[0]);
    tile.resolution_m = resolution_m;
    tile.points = std::make_shared<const scene::TilePoints>(scene::make_points(points.points_W, 1));
    tile.labels =
        std::make_shared<const scene::TileLabels>(scene::make_labels(points.segment_ids, 1));
    points = {};
    tiles.push_back(std::move(tile));
  }
  return tiles;
}

void write_html_scene(const MapSnapshot& map, std::span<const SegmentDescription> segments,
                      const std::filesystem::path& file) {
  const std::vector<scene::Tile> tiles = tiles_of(map);
  nlohmann::ordered_json entries = Json::array();
  for (const SegmentDescription& segment : segments) entries.push_back(segment_json(segment));
  nlohmann::ordered_json scene;
  scene["state"] = state_json(map, tiles);
  scene["segments"]["segments"] = std::move(entries);
  scene["segments"]["removed"] = Json::array();

  AtomicFile html(file);
  html.stream() << scene::file_begin() << scene::data_element("scene", json_text(scene));
  html.stream() << "<script type=\"text/plain\" id=\"tiles\">";
  const char* separator = "";
  for (const scene::Tile& tile : tiles) {
    std::string block;
    scene::append_block(tile, 0, tile.points->count, true, block);
    html.stream() << separator << scene::base64(block);
    separator = "\n";
  }
  html.stream() << "</script>\n" << scene::kFileEnd;
  html.commit();
}

}  // namespace kintsugi::segmenter
