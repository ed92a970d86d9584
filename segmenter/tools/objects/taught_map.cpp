#include "segmenter/tools/objects/taught_map.hpp"

#include <array>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "segmenter/io/ply/ply_reader.hpp"
#include "segmenter/io/saved_map.hpp"
#include "segmenter/preprocess/cloud_preparation.hpp"

namespace kintsugi::segmenter {
namespace {

bool is_ply(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 3> start{};
  file.read(start.data(), start.size());
  return std::string_view(start.data(), start.size()) == "ply";
}

ObservedMap read_labelled_ply(const std::filesystem::path& path) {
  PlyCloud cloud = read_ply(path);
  if (cloud.segment_ids.empty()) {
    throw std::runtime_error(path.string() +
                             ": has no points with segment_id: expected a labelled PLY file");
  }
  normalize_normals(cloud.points_W);
  ObservedMap map;
  map.source = path.string();
  map.resolution_m = usable_spacing_m(cloud.points_W);
  if (!(map.resolution_m > 0.0F)) {
    throw std::runtime_error(path.string() + ": too few points to estimate the resolution from");
  }
  map.config.engine.resolution_m = map.resolution_m;
  map.points_W = std::move(cloud.points_W);
  map.segment_ids = std::move(cloud.segment_ids);
  return map;
}

ObservedMap read_saved_map(const std::filesystem::path& path) {
  SegmentMapState state = read_map_state(path);
  ObservedMap map;
  map.source = path.string();
  map.map_name = std::move(state.map_name);
  map.map_session = state.map_session;
  map.resolution_m = static_cast<float>(state.config.engine.resolution_m);
  map.config = std::move(state.config);
  map.points_W = std::move(state.points_W);
  map.segment_ids = std::move(state.segment_ids);
  return map;
}

}  // namespace

ObservedMap read_taught_map(const std::filesystem::path& path) {
  return is_ply(path) ? read_labelled_ply(path) : read_saved_map(path);
}

}  // namespace kintsugi::segmenter
