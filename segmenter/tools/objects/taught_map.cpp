#include "segmenter/tools/objects/taught_map.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "segmenter/io/ply/ply_reader.hpp"
#include "segmenter/objects/maps/observed_map_file.hpp"
#include "segmenter/objects/maps/surface_samples.hpp"
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
  const bool has_normals = std::ranges::any_of(cloud.points_W, [](const CloudPoint& p) {
    return normal_of(p).squaredNorm() > 0.0F;  // also of none that is NaN
  });
  if (!has_normals) {
    throw std::runtime_error(path.string() + ": none of its " +
                             std::to_string(cloud.points_W.size()) +
                             " points has a normal (nx, ny, nz), by which objects are known");
  }
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

}  // namespace

ObservedMap read_taught_map(const std::filesystem::path& path) {
  return is_ply(path) ? read_labelled_ply(path) : read_observed_map(path);
}

}  // namespace kintsugi::segmenter
