// The files that tell of segments, read back against the map they are of.

#include <cmath>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "segmenter/io/graph_file.hpp"
#include "segmenter/io/map_files.hpp"
#include "segmenter/io/ply/ply_reader.hpp"
#include "segmenter/io/scannet_segments.hpp"
#include "segmenter/io/segment_plys.hpp"
#include "segmenter/io/segments_csv.hpp"
#include "segmenter/map/segment_map.hpp"
#include "tests/segmenter/process/slice_session.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter {
namespace {

using kintsugi::testing::FileSizeLimit;
using kintsugi::testing::TemporaryFolder;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string contents(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

std::size_t num_files(const std::filesystem::path& folder) {
  const std::filesystem::directory_iterator files(folder);
  return static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

/// A map with a corrected slice and a rejected point.
MapSnapshot example_map() {
  auto slices = testing::wavy_session(5, 200);
  slices[1].points_W[7].x = NAN;
  SegmentMap map({}, 77, slices[0]);
  for (const CloudSlice& slice : slices) map.add({&slice, 1});
  slices[2].revision = 1;
  map.add({&slices[2], 1});
  return take_snapshot(map);
}

class SegmentFiles : public ::testing::Test {
 protected:
  SegmentFiles()
      : segments_(describe_segments(map_)), graph_(adjacency_graph(labelled_cloud(map_))) {}

  json read_json() const { return json::parse(contents(file())); }
  std::filesystem::path file() const { return folder_ / "file"; }

  TemporaryFolder folder_;
  MapSnapshot map_ = example_map();
  std::vector<SegmentDescription> segments_;
  AdjacencyGraph graph_;
};

TEST_F(SegmentFiles, ScanNetHasTheSegmentOfEachVertexOfThePly) {
  write_map_ply(map_, folder_ / "scene.ply");
  write_scannet_segments("scene \"7\"", ScanNetParameters{0.0005, 20}, map_.state.segment_ids,
                         file());
  const PlyCloud ply = read_ply(folder_ / "scene.ply");
  const json root = read_json();
  EXPECT_EQ(root.size(), 3U);
  EXPECT_EQ(root.at("sceneId"), "scene \"7\"");
  EXPECT_EQ(root.at("params"), (json{{"kThresh", 0.0005}, {"segMinVerts", 20}}));
  EXPECT_TRUE(root.at("params").at("segMinVerts").is_number_integer());
  EXPECT_EQ(root.at("segIndices").get<std::vector<std::uint32_t>>(), ply.segment_ids);
  ASSERT_EQ(root.at("segIndices").size(), ply.points_W.size());
  EXPECT_EQ(ply.points_W, map_.state.points_W);
  for (const json& index : root.at("segIndices")) ASSERT_TRUE(index.is_number_unsigned());
}

TEST_F(SegmentFiles, ScanNetWithoutParametersOrPointsIsValid) {
  write_scannet_segments("", std::nullopt, {}, file());
  EXPECT_EQ(read_json(), json::parse(R"({"params": {}, "sceneId": "", "segIndices": []})"));
}

std::map<std::string, std::vector<std::string>> read_csv(const std::filesystem::path& path) {
  std::ifstream in(path);
  const auto split = [](const std::string& line) {
    std::vector<std::string> fields(1);
    for (const char c : line) {
      if (c == ',') {
        fields.emplace_back();
      } else {
        fields.back() += c;
      }
    }
    return fields;
  };
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> names = split(line);
  std::map<std::string, std::vector<std::string>> columns;
  while (std::getline(in, line)) {
    const std::vector<std::string> fields = split(line);
    EXPECT_EQ(fields.size(), names.size());
    for (std::size_t i = 0; i < names.size(); ++i) columns[names[i]].push_back(fields.at(i));
  }
  return columns;
}

TEST_F(SegmentFiles, CsvAndJsonTellTheSame) {
  write_segments_csv(segments_, folder_ / "csv");
  write_segments_json(map_, segments_, file());
  const auto csv = read_csv(folder_ / "csv");
  const json root = read_json();
  ASSERT_EQ(root["segments"].size(), segments_.size());
  const auto expect_vector = [&](const json& v, const std::string& name, std::size_t row) {
    const char* const suffixes[] = {"_x", "_y", "_z"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(std::stof(csv.at(name + suffixes[axis])[row]), v[axis].get<float>()) << name;
    }
  };
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const json& segment = root["segments"][i];
    for (const char* const name : {"id", "points", "area", "first_slice", "last_slice"}) {
      EXPECT_EQ(std::stod(csv.at(name)[i]), segment[name].get<double>()) << name;
    }
    expect_vector(segment["centroid"], "centroid", i);
    expect_vector(segment["mean_normal"], "mean_normal", i);
    expect_vector(segment["box_min"], "box_min", i);
    expect_vector(segment["box_max"], "box_max", i);
    expect_vector(segment["oriented_box"]["center"], "oriented_center", i);
    expect_vector(segment["oriented_box"]["size"], "oriented_size", i);
    expect_vector(segment["plane"]["normal"], "plane_normal", i);
    EXPECT_EQ(std::stof(csv.at("plane_offset")[i]), segment["plane"]["offset"].get<float>());
    EXPECT_EQ(csv.at("planar")[i] == "1", segment["planar"].get<bool>());
    EXPECT_EQ(std::stoi(csv.at("green")[i]), segment["mean_color"][1]);
    EXPECT_EQ(std::stoll(csv.at("changed_utime")[i]), segment["last_change"]["utime"]);
    EXPECT_EQ(std::stoi(csv.at("changed_slice")[i]), segment["last_change"]["slice"]);
    std::string neighbours;
    for (const json& neighbour : segment["neighbours"]) {
      if (!neighbours.empty()) neighbours += ' ';
      neighbours += neighbour["id"].dump();
    }
    EXPECT_EQ(csv.at("neighbours")[i], neighbours);
  }
}

TEST_F(SegmentFiles, JsonHasTheDescription) {
  write_segments_json(map_, segments_, file());
  const json root = read_json();
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const SegmentDescription& expected = segments_[i];
    const json& segment = root["segments"][i];
    const OrientedBox& box = expected.shape.box;
    EXPECT_EQ(segment["id"], expected.statistics.segment_id);
    for (int axis = 0; axis < 3; ++axis) {
      const auto place = static_cast<std::size_t>(axis);
      EXPECT_EQ(segment["oriented_box"]["size"][place].get<float>(),
                static_cast<float>(box.size_m[axis]));
      EXPECT_EQ(segment["oriented_box"]["axes"][0][place].get<float>(),
                static_cast<float>(box.X_WB.linear()(axis, 0)));
    }
    EXPECT_EQ(segment["plane"]["rms"].get<float>(), static_cast<float>(expected.shape.plane.rms_m));
    EXPECT_EQ(segment["plane"]["inliers"].get<float>(),
              static_cast<float>(expected.shape.plane.inlier_share));
    ASSERT_EQ(segment["neighbours"].size(), expected.neighbours.size());
    for (std::size_t k = 0; k < expected.neighbours.size(); ++k) {
      EXPECT_EQ(segment["neighbours"][k]["pairs"], expected.neighbours[k].num_pairs);
    }
    EXPECT_EQ(segment["last_change"]["slice"], expected.last_change.slice_id);
  }
}

TEST_F(SegmentFiles, GraphHasEveryNodeAndEdge) {
  write_graph(graph_, segments_, file());
  const std::string text = contents(file());
  EXPECT_THAT(text, StartsWith("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<graphml"));
  EXPECT_THAT(text, HasSubstr("edgedefault=\"undirected\""));
  AdjacencyGraph read;
  const std::regex node(R"re(<node id="(\d+)"><data key="points">(\d+)</data>.*</node>)re");
  const std::regex edge(
      R"re(<edge source="(\d+)" target="(\d+)"><data key="pairs">(\d+)</data></edge>)re");
  std::istringstream lines(text);
  std::smatch match;
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_search(line, match, node)) {
      EXPECT_EQ(std::stoul(match[2]), segments_[read.segment_ids.size()].statistics.num_points);
      read.segment_ids.push_back(static_cast<std::uint32_t>(std::stoul(match[1])));
    } else if (std::regex_search(line, match, edge)) {
      read.edges.push_back({static_cast<std::uint32_t>(std::stoul(match[1])),
                            static_cast<std::uint32_t>(std::stoul(match[2])),
                            std::stoll(match[3])});
    }
  }
  EXPECT_EQ(read, graph_);
  EXPECT_GT(graph_.edges.size(), 5U);
}

TEST_F(SegmentFiles, APlyForEachSegmentHoldsItsPoints) {
  std::vector<std::uint32_t> chosen;
  for (std::size_t i = 0; i < map_.segments.size(); i += 2) {
    chosen.push_back(map_.segments[i].segment_id);
  }
  write_segment_plys(map_, chosen, folder_.path());
  EXPECT_EQ(num_files(folder_.path()), chosen.size());
  for (const std::uint32_t id : chosen) {
    const PlyCloud ply = read_ply(folder_ / ("segment_" + std::to_string(id) + ".ply"));
    std::vector<CloudPoint> expected_W;
    for (std::size_t i = 0; i < map_.state.points_W.size(); ++i) {
      if (map_.state.segment_ids[i] == id) expected_W.push_back(map_.state.points_W[i]);
    }
    EXPECT_EQ(ply.points_W, expected_W);
    EXPECT_EQ(std::set(ply.segment_ids.begin(), ply.segment_ids.end()), std::set{id});
  }
}

TEST_F(SegmentFiles, OnAFullDiskAreNotThereAndTheReasonNamesThem) {
  const FileSizeLimit limit(100);
  const auto expect_failure = [&](const auto& write) {
    try {
      write();
      ADD_FAILURE() << "was written";
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), HasSubstr(folder_.path().string()));
    }
    EXPECT_EQ(num_files(folder_.path()), 0U);
  };
  expect_failure([&] { write_segments_csv(segments_, file()); });
  expect_failure([&] { write_segments_json(map_, segments_, file()); });
  expect_failure([&] { write_graph(graph_, segments_, file()); });
  expect_failure(
      [&] { write_scannet_segments("scene", std::nullopt, map_.state.segment_ids, file()); });
  expect_failure([&] { write_segment_plys(map_, graph_.segment_ids, folder_.path()); });
}

}  // namespace
}  // namespace kintsugi::segmenter
