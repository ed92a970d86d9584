#include "segmenter/tools/export/exported_map.hpp"

#include <array>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

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

/// Runs of vertices with the same slice_id and in_volume, in the order of the file; an id can have
/// several.
std::vector<SliceRecord> slices_of(const PlyCloud& cloud) {
  std::vector<SliceRecord> slices;
  for (PointIndex i = 0; i < cloud.points_W.size(); ++i) {
    const std::int32_t id = cloud.slice_ids.empty() ? 0 : cloud.slice_ids[i];
    const bool is_in_volume = !cloud.in_volume.empty() && cloud.in_volume[i] != 0;
    if (slices.empty() || slices.back().slice_id != id ||
        slices.back().is_in_volume() != is_in_volume) {
      SliceRecord& slice = slices.emplace_back();
      slice.slice_id = id;
      if (is_in_volume) slice.patch = PatchState::kInVolume;
      slice.first = i;
    }
    ++slices.back().count;
    ++slices.back().num_points;
  }
  return slices;
}

/// Makes the length of each normal 1, or 0 where it cannot be used.
void make_usable(PlyCloud& cloud) {
  normalize_normals(cloud.points_W);
  for (CloudPoint& p : cloud.points_W) {
    const float squared_length = p.nx * p.nx + p.ny * p.ny + p.nz * p.nz;
    if (!(squared_length > 0.5F && squared_length < 2.0F)) p.nx = p.ny = p.nz = 0.0F;
  }
}

SegmentMapState state_of(PlyCloud cloud, double resolution_m) {
  if (cloud.segment_ids.empty()) {
    throw std::runtime_error("has no points with segment_id: expected a labelled PLY file");
  }
  make_usable(cloud);
  if (resolution_m == 0.0) resolution_m = usable_spacing_m(cloud.points_W);
  if (!(resolution_m > 0.0)) {
    throw std::runtime_error("too few points to estimate the resolution from: give --resolution");
  }
  SegmentMapState state;
  state.config.engine.resolution_m = resolution_m;
  state.slices = slices_of(cloud);
  state.points_W = std::move(cloud.points_W);
  state.segment_ids = std::move(cloud.segment_ids);
  return state;
}

}  // namespace

ExportedMap read_labelled_map(const std::filesystem::path& path, double resolution_m) {
  if (!is_ply(path)) {
    SegmentMapState state = read_map_state(path);  // its errors name the file
    if (resolution_m != 0.0) {
      throw std::runtime_error("'" + path.string() + "': a saved map has its own resolution");
    }
    try {
      return {make_snapshot(std::move(state)), true};
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error("'" + path.string() + "': " + error.what());
    }
  }
  PlyCloud cloud = read_ply(path);
  try {
    return {make_snapshot(state_of(std::move(cloud), resolution_m)), false};
  } catch (const std::exception& error) {
    throw std::runtime_error(path.string() + ": " + error.what());
  }
}

}  // namespace kintsugi::segmenter
