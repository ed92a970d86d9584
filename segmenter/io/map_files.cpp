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

std::int64_t count_rejected(const std::vector<SliceRecord>& slices) {
  std::int64_t count = 0;
  for (const SliceRecord& slice : slices) count += std::ssize(slice.rejected);
  return count;
}

Json header_json(const MapSnapshot& map) {
  const SegmentMapState& state = map.state;
  const EngineConfig& engine = state.config.engine;
  return {{"mode", state.config.mode},
          {"parameters",
           {{"threshold", engine.threshold},
            {"scale", engine.scale},
            {"color_weight", engine.color_weight},
            {"min_points", engine.min_points},
            {"fragment_limit", engine.fragment_limit()},
            {"beta", engine.beta},
            {"resolution", readable(static_cast<float>(engine.resolution_m))},
            {"radius", readable(engine.radius_m())},
            {"neighbours", name_of(engine.neighbour_search)}}},
          {"map_name", state.map_name},
          {"map_session", state.map_session},
          {"session", state.session},
          {"complete", map.is_complete},
          {"num_slices", state.slices.size()},
          {"num_points", state.points_W.size()},
          {"num_points_rejected", count_rejected(state.slices)},
          {"num_segments", map.segments.size()}};
}

Json rejected_json(const std::vector<SliceRecord>& records) {
  Json slices = Json::array();
  for (const SliceRecord& slice : records) {
    if (!slice.rejected.empty()) {
      slices.push_back({{"slice", slice.slice_id}, {"points", slice.rejected}});
    }
  }
  return slices;
}

Json revisions_json(const std::vector<SliceRecord>& records) {
  Json slices = Json::array();
  for (const SliceRecord& slice : records) {
    if (slice.revision > 0) {
      slices.push_back({{"slice", slice.slice_id}, {"revision", slice.revision}});
    }
  }
  return slices;
}

}  // namespace

void write_map_ply(const MapSnapshot& map, const std::filesystem::path& path) {
  const SegmentMapState& state = map.state;
  LabelledPlyWriter writer(path, std::ssize(state.points_W),
                           {"kintsugi segment map, frame W, metres",
                            "map_session " + std::to_string(state.map_session)});
  for (const SliceRecord& slice : state.slices) {
    for (PointIndex i = slice.first; i < slice.first + slice.count; ++i) {
      writer.append(state.points_W[i], state.segment_ids[i], slice.slice_id);
    }
  }
  writer.commit();
}

void write_segments_json(const MapSnapshot& map, const std::filesystem::path& path) {
  Json root = header_json(map);
  root["revisions"] = revisions_json(map.state.slices);
  root["rejected"] = rejected_json(map.state.slices);
  AtomicFile file(path);
  std::ostream& out = file.stream();
  // One line for each segment: a person can read it, and the text of millions is never in memory.
  std::string head = root.dump(1);
  head.resize(head.rfind('\n'));
  out << head << ",\n \"segments\": [";
  const char* separator = "\n";
  for (const SegmentStatistics& segment : map.segments) {
    out << separator << "  " << segment_json(segment).dump();
    separator = ",\n";
  }
  out << "\n ]\n}\n";
  file.commit();
}

void write_map_files(const MapSnapshot& map, const std::filesystem::path& folder,
                     const std::string& stem) {
  std::filesystem::create_directories(folder);
  write_map_ply(map, folder / (stem + ".ply"));
  write_segments_json(map, folder / (stem + ".json"));
}

}  // namespace kintsugi::segmenter
