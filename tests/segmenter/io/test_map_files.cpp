#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "segmenter/io/map_files.hpp"
#include "segmenter/io/ply/labelled_ply_writer.hpp"
#include "segmenter/io/ply/ply_reader.hpp"
#include "tests/segmenter/changed_parameters.hpp"
#include "tests/segmenter/process/slice_session.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter {
namespace {

using kintsugi::testing::TemporaryFolder;
using ::testing::HasSubstr;

std::string contents(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

std::size_t num_files(const std::filesystem::path& folder) {
  const std::filesystem::directory_iterator files(folder);
  return static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

// Three slices, two rejected points, one empty slice.
std::unique_ptr<SegmentMap> small_map() {
  auto slices = testing::wavy_session(3, 80);
  slices[0].points_W[5].x = std::numeric_limits<float>::infinity();
  slices[2].points_W[79].ny = std::numeric_limits<float>::quiet_NaN();
  slices[1].points_W.clear();
  for (CloudPoint& p : slices[0].points_W) {
    p.red = 200;
    p.weight = 2.5F;
  }
  auto map = std::make_unique<SegmentMap>(SegmentMapConfig{}, 77, slices[0]);
  map->add(slices);
  return map;
}

TEST(MapFiles, PlyHoldsExactlyWhatWasSegmented) {
  const TemporaryFolder folder;
  const auto map = small_map();
  write_map_ply(take_snapshot(*map), folder / "map.ply");
  const PlyCloud cloud = read_ply(folder / "map.ply");
  const auto points_W = map->cloud().points_W();
  EXPECT_EQ(cloud.points_W, std::vector<CloudPoint>(points_W.begin(), points_W.end()));
  EXPECT_EQ(cloud.points_W.size(), 158U);
  const auto ids = map->segment_ids().ids();
  EXPECT_EQ(cloud.segment_ids, std::vector<std::uint32_t>(ids.begin(), ids.end()));
  EXPECT_EQ(cloud.slice_ids.front(), 0);
  EXPECT_EQ(cloud.slice_ids.back(), 2);
}

TEST(MapFiles, PlyHasTheDocumentedProperties) {
  const TemporaryFolder folder;
  write_map_ply(take_snapshot(*small_map()), folder / "map.ply");
  const std::string text = contents(folder / "map.ply");
  EXPECT_THAT(text,
              HasSubstr("element vertex 158\n"
                        "property float x\nproperty float y\nproperty float z\n"
                        "property float nx\nproperty float ny\nproperty float nz\n"
                        "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                        "property int segment_id\nproperty int slice_id\nproperty float weight\n"
                        "property uchar in_volume\n"
                        "end_header\n"));
  EXPECT_EQ(text.size(), text.find("end_header\n") + 11 + std::size_t{158} * 40);
}

TEST(MapFiles, JsonTellsEveryParameterThatDecidesThePartition) {
  const TemporaryFolder folder;
  const auto parameters_of = [&](const EngineConfig& engine) {
    MapSnapshot map;
    map.state.config.engine = engine;
    write_segments_json(map, folder / "map.json");
    return nlohmann::json::parse(contents(folder / "map.json"))["parameters"];
  };
  const auto usual = parameters_of({});
  for (const auto& [parameter, engine] : testing::changed_parameters()) {
    EXPECT_NE(parameters_of(engine), usual) << parameter.name;
  }
}

TEST(MapFiles, JsonHasItsParametersInTheDocumentedOrder) {
  const TemporaryFolder folder;
  MapSnapshot map;
  map.state.config.engine.min_points = 50.0;
  write_segments_json(map, folder / "map.json");
  EXPECT_THAT(contents(folder / "map.json"),
              HasSubstr("\"parameters\": {\n  \"threshold\": 0.001,\n  \"scale\": 0.0005,\n"
                        "  \"color_weight\": 0.0,\n  \"min_points\": 50.0,\n"
                        "  \"fragment_limit\": 50,\n  \"beta\": 0.85,\n"
                        "  \"resolution\": 0.01,\n  \"radius\": 0.02,\n"
                        "  \"neighbours\": \"grid\"\n }"));
}

TEST(MapFiles, JsonTellsOfEverySegment) {
  const TemporaryFolder folder;
  const auto map = small_map();
  write_segments_json(take_snapshot(*map), folder / "map.json");
  const auto root = nlohmann::json::parse(contents(folder / "map.json"));
  EXPECT_EQ(root["mode"], "exact");
  EXPECT_EQ(root["parameters"]["threshold"], 0.001);
  EXPECT_EQ(root["parameters"]["resolution"], 0.01);
  EXPECT_EQ(root["parameters"]["radius"], 0.02);
  EXPECT_EQ(root["map_session"], 5);
  EXPECT_EQ(root["session"], 77);
  EXPECT_EQ(root["complete"], true);
  EXPECT_EQ(root["num_slices"], 3);
  EXPECT_EQ(root["num_points"], 158);
  EXPECT_EQ(root["num_points_rejected"], 2);
  EXPECT_EQ(root["rejected"][0]["slice"], 0);
  EXPECT_EQ(root["rejected"][0]["points"], nlohmann::json({5}));
  EXPECT_EQ(root["rejected"][1]["points"], nlohmann::json({79}));

  const auto statistics = map->statistics().all();
  ASSERT_EQ(root["segments"].size(), statistics.size());
  EXPECT_EQ(root["num_segments"], statistics.size());
  std::int64_t num_points = 0;
  for (std::size_t i = 0; i < statistics.size(); ++i) {
    const auto& segment = root["segments"][i];
    EXPECT_EQ(segment["id"], statistics[i].segment_id);
    EXPECT_EQ(segment["box_max"][1].get<float>(), statistics[i].box_max_W[1]);
    EXPECT_EQ(segment["centroid"][2].get<float>(), statistics[i].centroid_W[2]);
    EXPECT_EQ(segment["mean_normal"][0].get<float>(), statistics[i].mean_normal_W[0]);
    EXPECT_EQ(segment["mean_color"][0], statistics[i].mean_color[0]);
    EXPECT_EQ(segment["area"].get<float>(), statistics[i].area_m2);
    EXPECT_EQ(segment["first_slice"], statistics[i].first_slice);
    EXPECT_EQ(segment["last_slice"], statistics[i].last_slice);
    num_points += segment["points"].get<std::int64_t>();
  }
  EXPECT_EQ(num_points, 158);
}

TEST(MapFiles, OfAMapWithoutPointsAreValid) {
  const TemporaryFolder folder;
  auto slices = testing::wavy_session(1, 1);
  slices[0].points_W.clear();
  SegmentMap map({}, 1, slices[0]);
  map.add(slices);
  write_map_files(take_snapshot(map), folder / "new" / "folder", "empty");
  EXPECT_TRUE(read_ply(folder / "new" / "folder" / "empty.ply").points_W.empty());
  const auto root = nlohmann::json::parse(contents(folder / "new" / "folder" / "empty.json"));
  EXPECT_TRUE(root["segments"].empty());
}

TEST(MapFiles, AreTheSameBytesForTheSameMap) {
  const TemporaryFolder folder;
  write_map_files(take_snapshot(*small_map()), folder.path(), "a");
  write_map_files(take_snapshot(*small_map()), folder.path(), "b");
  EXPECT_EQ(contents(folder / "a.ply"), contents(folder / "b.ply"));
  EXPECT_EQ(contents(folder / "a.json"), contents(folder / "b.json"));
  EXPECT_EQ(contents(folder / "a.csv"), contents(folder / "b.csv"));
  EXPECT_EQ(num_files(folder.path()), 6U);  // nothing partial is left
}

TEST(MapFiles, AreASetForEachPart) {
  const TemporaryFolder folder;
  const auto slices = testing::session_in_two_parts();
  SegmentMap map({}, 77, slices[0]);
  map.add(slices);
  write_map_files(take_snapshot(map), folder.path(), "map");
  EXPECT_EQ(num_files(folder.path()), 6U);
  EXPECT_EQ(read_ply(folder / "map.ply").slice_ids.back(), 1);
  const PlyCloud part1 = read_ply(folder / "map.part1.ply");
  EXPECT_EQ(part1.slice_ids.front(), 2);
  EXPECT_EQ(part1.slice_ids.back(), 3);
  EXPECT_GT(part1.points_W.front().x, 900.0F) << "in the coordinates of the map";
  const auto json = nlohmann::json::parse(contents(folder / "map.part1.json"));
  EXPECT_EQ(json["num_points"], part1.points_W.size());
  EXPECT_EQ(json["num_segments"], json["segments"].size());
  EXPECT_EQ(json["rejected"].size(), 2U);
  EXPECT_GE(json["segments"][0]["first_slice"], 2);
  EXPECT_THAT(contents(folder / "map.part1.csv"),
              HasSubstr("\n" + json["segments"][0]["id"].dump() + ","));
}

TEST(MapFiles, OfOnePartAreRemoved) {
  const TemporaryFolder folder;
  const auto slices = testing::session_in_two_parts();
  SegmentMap map({}, 77, slices[0]);
  map.add(slices);
  write_map_files(take_snapshot(map), folder.path(), "map");
  remove_map_files(folder.path(), "map", 1);
  EXPECT_EQ(num_files(folder.path()), 3U);
  EXPECT_TRUE(std::filesystem::exists(folder / "map.ply"));
  remove_map_files(folder.path(), "map", 1);  // nothing is there
  remove_map_files(folder.path(), "map", 0);
  EXPECT_EQ(num_files(folder.path()), 0U);
}

TEST(MapFiles, OfLaterPartsHaveTheNumberInTheirNames) {
  EXPECT_EQ(part_stem("segments", 0), "segments");
  EXPECT_EQ(part_stem("segments_5", 2), "segments_5.part2");
}

TEST(MapFiles, NameTheFileThatCannotBeWritten) {
  const TemporaryFolder folder;
  std::ofstream(folder / "taken") << "a file, not a folder";
  EXPECT_THROW(write_map_files(take_snapshot(*small_map()), folder / "taken", "map"),
               std::runtime_error);
  try {
    write_map_ply(take_snapshot(*small_map()), folder / "absent" / "map.ply");
    FAIL() << "wrote into a folder that is not there";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr((folder / "absent" / "map").string()));
  }
}

TEST(LabelledPlyWriter, LeavesNothingWithoutCommit) {
  const TemporaryFolder folder;
  {
    LabelledPlyWriter writer(folder / "map.ply", 2, {});
    writer.append({}, 1, 0);
    EXPECT_THROW(writer.commit(), std::logic_error);  // one point is missing
  }
  EXPECT_EQ(num_files(folder.path()), 0U);
}

}  // namespace
}  // namespace kintsugi::segmenter
