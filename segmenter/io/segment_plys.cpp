#include "segmenter/io/segment_plys.hpp"

#include <string>
#include <unordered_map>
#include <vector>

#include "segmenter/io/ply/labelled_ply_writer.hpp"

namespace kintsugi::segmenter {
namespace {

struct PlacedPoint {
  PointIndex point;
  std::int32_t slice_id;
  bool is_in_volume;
};

void write_segment(const MapSnapshot& map, std::uint32_t segment_id,
                   const std::vector<PlacedPoint>& points, const std::filesystem::path& path) {
  LabelledPlyWriter writer(
      path, std::ssize(points),
      {"kintsugi segment " + std::to_string(segment_id) + ", frame W, metres"});
  for (const PlacedPoint& placed : points) {
    writer.append(map.state.points_W[placed.point], segment_id, placed.slice_id,
                  placed.is_in_volume);
  }
  writer.commit();
}

}  // namespace

void write_segment_plys(const MapSnapshot& map, std::span<const std::uint32_t> segment_ids,
                        const std::filesystem::path& folder) {
  std::unordered_map<std::uint32_t, std::vector<PlacedPoint>> points_of;
  for (const std::uint32_t id : segment_ids) points_of[id];
  for (const SliceRecord& slice : map.state.slices) {
    for (PointIndex i = slice.first; i < slice.first + slice.count; ++i) {
      const auto points = points_of.find(map.state.segment_ids[i]);
      if (points != points_of.end()) {
        points->second.push_back({i, slice.slice_id, slice.is_in_volume()});
      }
    }
  }
  for (const std::uint32_t id : segment_ids) {
    write_segment(map, id, points_of[id], folder / ("segment_" + std::to_string(id) + ".ply"));
  }
}

}  // namespace kintsugi::segmenter
