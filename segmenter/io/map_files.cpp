#include "segmenter/io/map_files.hpp"

#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "lcmtypes/base/atomic_file.hpp"
#include "lcmtypes/base/json_text.hpp"
#include "lcmtypes/client/statistics_json.hpp"
#include "segmenter/io/ply/labelled_ply_writer.hpp"
#include "segmenter/io/segments_csv.hpp"
#include "segmenter/map/map_parts.hpp"

namespace kintsugi::segmenter {
namespace {

using Json = nlohmann::ordered_json;  // keys in the order a person reads them

template <class Vector>
Json vector_json(const Vector& v) {
  const auto number = [&](int axis) { return readable(static_cast<float>(v[axis])); };
  return {number(0), number(1), number(2)};
}

Json box_json(const OrientedBox& box) {
  const Eigen::Matrix3d& R_WB = box.X_WB.linear();
  return {{"center", vector_json(box.X_WB.translation())},
          {"size", vector_json(box.size_m)},
          {"axes", {vector_json(R_WB.col(0)), vector_json(R_WB.col(1)), vector_json(R_WB.col(2))}}};
}

Json plane_json(const PlaneFit& plane) {
  const auto number = [](double value) { return readable(static_cast<float>(value)); };
  return {{"normal", vector_json(plane.normal_W)},
          {"offset", number(plane.offset_m)},
          {"rms", number(plane.rms_m)},
          {"inliers", number(plane.inlier_share)}};
}

Json neighbours_json(const std::vector<SegmentNeighbour>& neighbours) {
  Json list = Json::array();
  for (const SegmentNeighbour& neighbour : neighbours) {
    list.push_back({{"id", neighbour.segment_id}, {"pairs", neighbour.num_pairs}});
  }
  return list;
}

Json segment_json(const SegmentDescription& segment) {
  Json json = statistics_json(segment.statistics);
  json["last_change"] = {{"slice", segment.last_change.slice_id},
                         {"utime", segment.last_change.utime}};
  json["oriented_box"] = box_json(segment.shape.box);
  json["plane"] = plane_json(segment.shape.plane);
  json["planar"] = segment.shape.is_planar;
  json["neighbours"] = neighbours_json(segment.neighbours);
  return json;
}

/// Moves what a segment has of places by `origin_W`. In double: float32 would lose centimetres
/// there.
void move_by(const Eigen::Vector3d& origin_W, Json& segment) {
  // Whole micrometres, so that no digits appear that the float32 did not have.
  const auto moved = [](const Json& number, double by) {
    constexpr double kMicrometres = 1e6;
    return std::round((number.get<double>() + by) * kMicrometres) / kMicrometres;
  };
  const auto move_place = [&](Json& place) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      Json& number = place[static_cast<std::size_t>(axis)];
      number = moved(number, origin_W[axis]);
    }
  };
  for (const char* key : {"centroid", "box_min", "box_max"}) move_place(segment[key]);
  move_place(segment["oriented_box"]["center"]);
  Json& plane = segment["plane"];
  const Json& n = plane["normal"];
  const Eigen::Vector3d normal_W(n[0].get<double>(), n[1].get<double>(), n[2].get<double>());
  plane["offset"] = moved(plane["offset"], normal_W.dot(origin_W));
}

/// By name, and behind a parameter what follows from it. Lengths are given as the float32 that is
/// computed with.
Json parameters_json(const EngineConfig& engine) {
  Json json;
  for (const EngineParameter& parameter : kMapParameters) {
    if (parameter.value == &EngineConfig::resolution_m) {
      json["resolution"] = readable(static_cast<float>(engine.resolution_m));
    } else if (parameter.value == &EngineConfig::radius_factor) {
      json["radius"] = readable(engine.radius_m());
    } else {
      json[std::string(parameter.name)] = engine.*parameter.value;
    }
    if (parameter.value == &EngineConfig::min_points) {
      json["fragment_limit"] = engine.fragment_limit();
    }
  }
  json["neighbours"] = name_of(engine.neighbour_search);
  return json;
}

std::int64_t count_rejected(const std::vector<SliceRecord>& slices) {
  std::int64_t count = 0;
  for (const SliceRecord& slice : slices) count += std::ssize(slice.rejected);
  return count;
}

Json header_json(const MapSnapshot& map) {
  const SegmentMapState& state = map.state;
  return {{"mode", state.config.mode},
          {"parameters", parameters_json(state.config.engine)},
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

/// `head` and the segments behind it.
void write_json(const Json& head, std::span<const SegmentDescription> segments,
                const std::filesystem::path& path,
                const Eigen::Vector3d& origin_W = Eigen::Vector3d::Zero()) {
  AtomicFile file(path);
  std::ostream& out = file.stream();
  // One line for each segment: a person can read it, and the text of millions is never in memory.
  std::string text = json_text(head, 1);
  text.resize(text.rfind('\n'));
  out << text << ",\n \"segments\": [";
  const char* separator = "\n";
  for (const SegmentDescription& segment : segments) {
    Json json = segment_json(segment);
    if (!origin_W.isZero(0.0)) move_by(origin_W, json);
    out << separator << "  " << json.dump();
    separator = ",\n";
  }
  out << "\n ]\n}\n";
  file.commit();
}

constexpr char kPly[] = ".ply";
constexpr char kJson[] = ".json";
constexpr char kCsv[] = ".csv";
constexpr std::array kExtensions{kPly, kJson, kCsv};

/// Behind what `path` has already: that may contain dots.
std::filesystem::path with_extension(std::filesystem::path path, const char* extension) {
  return path += extension;
}

void write_files(const MapSnapshot& map, const std::filesystem::path& path) {
  write_map_ply(map, with_extension(path, kPly));
  const std::vector<SegmentDescription> segments = describe_segments(map);
  write_segments_json(map, segments, with_extension(path, kJson));
  write_segments_csv(segments, with_extension(path, kCsv));
}

}  // namespace

void write_map_ply(const MapSnapshot& map, const std::filesystem::path& path) {
  const SegmentMapState& state = map.state;
  LabelledPlyWriter writer(path, std::ssize(state.points_W),
                           {"kintsugi segment map, frame W, metres",
                            "map_session " + std::to_string(state.map_session)});
  for (const SliceRecord& slice : state.slices) {
    for (PointIndex i = slice.first; i < slice.first + slice.count; ++i) {
      writer.append(state.points_W[i], state.segment_ids[i], slice.slice_id, slice.is_in_volume());
    }
  }
  writer.commit();
}

void write_segments_json(const MapSnapshot& map, std::span<const SegmentDescription> segments,
                         const std::filesystem::path& path, const Eigen::Vector3d& origin_W) {
  Json head = header_json(map);
  if (!origin_W.isZero(0.0)) head["origin"] = {origin_W.x(), origin_W.y(), origin_W.z()};
  head["revisions"] = revisions_json(map.state.slices);
  head["rejected"] = rejected_json(map.state.slices);
  write_json(head, segments, path, origin_W);
}

void write_segments_json(const MapSnapshot& map, const std::filesystem::path& path,
                         const Eigen::Vector3d& origin_W) {
  write_segments_json(map, describe_segments(map), path, origin_W);
}

void write_segments_json(const LabelledCloud& cloud, std::span<const SegmentDescription> segments,
                         const std::filesystem::path& path) {
  const Json head = {
      {"parameters",
       {{"resolution", readable(cloud.resolution_m)}, {"radius", readable(cloud.radius_m)}}},
      {"num_points", cloud.points_W.size()},
      {"num_segments", segments.size()}};
  write_json(head, segments, path);
}

void write_map_files(const MapSnapshot& map, const std::filesystem::path& folder,
                     const std::string& stem) {
  std::filesystem::create_directories(folder);
  const std::set<std::int32_t> parts = parts_of(map);
  if (parts.size() == 1) return write_files(map, folder / stem);  // without a copy of the map
  for (const std::int32_t part : parts) {
    write_files(only_part(map, part), folder / part_stem(stem, part));
  }
}

void remove_map_files(const std::filesystem::path& folder, const std::string& stem,
                      std::int32_t part) {
  for (const char* const extension : kExtensions) {
    std::filesystem::remove(with_extension(folder / part_stem(stem, part), extension));
  }
}

std::string part_stem(const std::string& stem, std::int32_t part) {
  return part == 0 ? stem : stem + ".part" + std::to_string(part);
}

}  // namespace kintsugi::segmenter
