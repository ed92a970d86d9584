#include "segmenter/io/map_files.hpp"

#include <charconv>
#include <string_view>

#include <nlohmann/json.hpp>

#include "lcmtypes/atomic_file.hpp"
#include "segmenter/io/labelled_ply_writer.hpp"

namespace kintsugi::segmenter {
namespace {

using Json = nlohmann::ordered_json;  // keys in the order a person reads them

// The double with the shortest decimals that mean this float: 0.01 instead of 0.00999999977.
double readable(float value) {
  char text[32];
  const auto end = std::to_chars(std::begin(text), std::end(text), value).ptr;
  double result = 0.0;
  std::from_chars(std::begin(text), end, result);
  return result;
}

Json vector_json(const float (&v)[3]) { return {readable(v[0]), readable(v[1]), readable(v[2])}; }

Json segment_json(const SegmentStatistics& s) {
  return {{"id", s.segment_id},
          {"points", s.num_points},
          {"box_min", vector_json(s.box_min_W)},
          {"box_max", vector_json(s.box_max_W)},
          {"centroid", vector_json(s.centroid_W)},
          {"mean_normal", vector_json(s.mean_normal_W)},
          {"mean_color", {s.mean_color[0], s.mean_color[1], s.mean_color[2]}},
          {"area", readable(s.area_m2)},
          {"first_slice", s.first_slice},
          {"last_slice", s.last_slice}};
}

std::string_view name_of(NeighbourSearch search) {
  return search == NeighbourSearch::kGrid ? "grid" : "flann";
}

Json header_json(const SegmentMap& map) {
  const EngineConfig& engine = map.config().engine;
  return {{"mode", map.config().mode},
          {"parameters",
           {{"threshold", engine.threshold},
            {"scale", engine.scale},
            {"beta", engine.beta},
            {"resolution", readable(static_cast<float>(engine.resolution_m))},
            {"radius", readable(engine.radius_m())},
            {"neighbours", name_of(engine.neighbour_search)}}},
          {"map_name", map.map_name()},
          {"map_session", map.map_session()},
          {"session", map.session()},
          {"complete", map.is_complete()},
          {"num_slices", map.cloud().slices().size()},
          {"num_points", map.cloud().num_live()},
          {"num_points_rejected", map.cloud().num_rejected()},
          {"num_segments", map.segment_ids().num_segments()}};
}

Json rejected_json(const PointCloud& cloud) {
  Json slices = Json::array();
  for (const SliceRecord& slice : cloud.slices()) {
    if (!slice.rejected.empty()) {
      slices.push_back({{"slice", slice.slice_id}, {"points", slice.rejected}});
    }
  }
  return slices;
}

}  // namespace

void write_map_ply(const SegmentMap& map, const std::filesystem::path& path) {
  const PointCloud& cloud = map.cloud();
  LabelledPlyWriter writer(path, cloud.num_live(),
                           {"kintsugi segment map, frame W, metres",
                            "map_session " + std::to_string(map.map_session())});
  const auto ids = map.segment_ids().ids();
  for (const SliceRecord& slice : cloud.slices()) {
    for (PointIndex i = slice.first; i < slice.first + slice.count; ++i) {
      writer.append(cloud[i], ids[i], slice.slice_id);
    }
  }
  writer.commit();
}

void write_segments_json(const SegmentMap& map, const std::filesystem::path& path) {
  Json root = header_json(map);
  root["rejected"] = rejected_json(map.cloud());
  AtomicFile file(path);
  std::ostream& out = file.stream();
  // One line for each segment: a person can read it, and the text of millions is never in memory.
  std::string head = root.dump(1);
  head.resize(head.rfind('\n'));
  out << head << ",\n \"segments\": [";
  const char* separator = "\n";
  for (const SegmentStatistics& segment : map.statistics().all()) {
    out << separator << "  " << segment_json(segment).dump();
    separator = ",\n";
  }
  out << "\n ]\n}\n";
  file.commit();
}

void write_map_files(const SegmentMap& map, const std::filesystem::path& folder,
                     const std::string& stem) {
  std::filesystem::create_directories(folder);
  write_map_ply(map, folder / (stem + ".ply"));
  write_segments_json(map, folder / (stem + ".json"));
}

}  // namespace kintsugi::segmenter
