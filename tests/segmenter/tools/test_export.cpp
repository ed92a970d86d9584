// kintsugi-export, run as a program.

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "segmenter/io/map_files.hpp"
#include "segmenter/io/ply/ply_reader.hpp"
#include "segmenter/io/saved_map.hpp"
#include "tests/segmenter/process/slice_session.hpp"
#include "tests/segmenter/tools/program.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

std::string contents(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// The text of the element with this id in a page.
std::string data_of(const std::string& html, const std::string& id) {
  const std::string begin = "id=\"" + id + "\">";
  const std::size_t from = html.find(begin) + begin.size();
  return html.substr(from, html.find("</script>", from) - from);
}

/// A saved map, and the files that the segmenter wrote of it.
class Export : public ::testing::Test {
 protected:
  Export() {
    auto slices = testing::wavy_session(4, 250);
    slices[1].points_W[7].x = NAN;
    SegmentMap map({}, 77, slices[0]);
    for (const CloudSlice& slice : slices) map.add({&slice, 1});
    map_ = take_snapshot(map);
    write_map_state(map.state(), folder_ / "map.kseg");
    write_map_files(map_, folder_.path(), "segments");
  }

  /// FOLDER stands for the test's folder.
  testing::ProgramResult run(std::string arguments) const {
    for (std::size_t at = 0; (at = arguments.find("FOLDER")) != std::string::npos;) {
      arguments.replace(at, 6, folder_.path().string());
    }
    return testing::run_program("kintsugi-export", arguments, folder_ / "log.txt");
  }
  void expect_success(const std::string& arguments) const {
    const auto result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.output;
  }
  void expect_error(const std::string& arguments, const std::string& reason) const {
    const auto result = run(arguments);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.output, HasSubstr(reason));
  }
  std::string read(const std::string& name) const { return contents(folder_ / name); }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }

  kintsugi::testing::TemporaryFolder folder_;
  MapSnapshot map_;
};

TEST_F(Export, OfASavedMapWritesWhatTheSegmenterDoes) {
  expect_success("FOLDER/map.kseg --json FOLDER/a.json --csv FOLDER/a.csv --ply FOLDER/a.ply");
  EXPECT_EQ(read("a.json"), read("segments.json"));
  EXPECT_EQ(read("a.csv"), read("segments.csv"));
  EXPECT_EQ(read("a.ply"), read("segments.ply"));
}

TEST_F(Export, OfALabelledPlyTellsTheSameOfEachSegment) {
  expect_success(
      "FOLDER/segments.ply --resolution 0.01 --json FOLDER/a.json --graph FOLDER/a.graphml");
  expect_success("FOLDER/map.kseg --graph FOLDER/b.graphml");
  EXPECT_EQ(read("a.graphml"), read("b.graphml"));
  json expected = json::parse(read("segments.json")).at("segments");
  for (json& segment : expected) segment["last_change"] = {{"slice", -1}, {"utime", 0}};
  EXPECT_EQ(json::parse(read("a.json")).at("segments"), expected);
}

TEST_F(Export, SegsAreOfTheVerticesOfThePly) {
  expect_success("FOLDER/map.kseg --ply FOLDER/a.ply --segs FOLDER/scene0001_00.segs.json");
  const json root = json::parse(read("scene0001_00.segs.json"));
  EXPECT_EQ(root.at("sceneId"), "scene0001_00");
  EXPECT_EQ(root.at("params").at("kThresh"), 0.0005);
  const PlyCloud ply = read_ply(folder_ / "a.ply");
  EXPECT_EQ(root.at("segIndices").get<std::vector<std::uint32_t>>(), ply.segment_ids);

  expect_success("FOLDER/a.ply --resolution 0.01 --scene-id x --segs FOLDER/b.segs.json");
  const json of_ply = json::parse(read("b.segs.json"));
  EXPECT_EQ(of_ply.at("segIndices"), root.at("segIndices"));
  EXPECT_EQ(of_ply.at("sceneId"), "x");
  EXPECT_EQ(of_ply.at("params"), json::object());
  expect_error("FOLDER/map.kseg --segs FOLDER/c.segs.json", "give --ply or --mesh");
}

TEST_F(Export, MeshVerticesGetTheSegmentOfTheNearestPoint) {
  std::ofstream mesh(folder_ / "mesh.ply");
  const auto& points = map_.state.points_W;
  mesh << "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
       << "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
       << std::setprecision(9);
  for (const std::size_t i : {std::size_t{900}, std::size_t{3}, std::size_t{400}}) {
    mesh << points[i].x << ' ' << points[i].y << ' ' << points[i].z << '\n';
  }
  mesh << points[0].x << ' ' << points[0].y << ' ' << points[0].z + 5.0F << "\n3 0 1 2\n";
  mesh.close();
  expect_success("FOLDER/map.kseg --mesh FOLDER/mesh.ply --segs FOLDER/mesh.segs.json");
  const auto& ids = map_.state.segment_ids;
  EXPECT_EQ(json::parse(read("mesh.segs.json")).at("segIndices"),
            json({ids[900], ids[3], ids[400], 0}));
}

TEST_F(Export, APageHasTheMapAndLoadsNothing) {
  expect_success("FOLDER/map.kseg --html FOLDER/scene.html");
  const std::string html = read("scene.html");
  EXPECT_THAT(html, ::testing::StartsWith("<!doctype html>"));
  EXPECT_THAT(html, HasSubstr("default-src 'none'"));
  for (const char* const loading :
       {"http://", "https://", "src=\"page", "href=\"page", "@import"}) {
    EXPECT_THAT(html, ::testing::Not(HasSubstr(loading)));
  }
  const json scene = json::parse(data_of(html, "scene"));
  EXPECT_EQ(scene.at("segments").at("segments").size(), map_.segments.size());
  std::size_t points = 0;
  for (const json& tile : scene.at("state").at("tiles")) points += tile.at(3).get<std::size_t>();
  EXPECT_EQ(points, map_.state.points_W.size());
  const std::string blocks = data_of(html, "tiles");
  EXPECT_EQ(std::count(blocks.begin(), blocks.end(), '\n') + 1,
            static_cast<std::ptrdiff_t>(scene.at("state").at("tiles").size()));
  EXPECT_EQ(blocks.substr(0, 5), "S1RMM");  // "KTL1" in base 64

  expect_success("FOLDER/segments.ply --resolution 0.01 --html FOLDER/of_ply.html");
  expect_error("FOLDER/map.kseg --html FOLDER/absent/a.html", "there is no folder");
}

// The page looks at all that it has.
TEST_F(Export, APageLeavesPointsOutThatCannotBeSegmented) {
  std::ofstream ply(folder_ / "far.ply");
  ply << "ply\nformat ascii 1.0\nelement vertex 7\nproperty float x\nproperty float y\n"
      << "property float z\nproperty int segment_id\nend_header\n"
      << "nan nan nan 0\nnan 0 0 0\ninf 0 0 0\n1e30 0 0 0\n"
      << "5 5 5 1\n5.01 5 5 1\n5 5.01 5 1\n";
  ply.close();
  expect_success("FOLDER/far.ply --resolution 0.01 --html FOLDER/far.html");
  const json state = json::parse(data_of(read("far.html"), "scene")).at("state");
  EXPECT_EQ(state.at("points"), 3);
  ASSERT_EQ(state.at("tiles").size(), 1U);
  EXPECT_EQ(state.at("tiles").at(0).at(3), 3);
  ASSERT_EQ(state.at("parts").size(), 1U);
  EXPECT_EQ(state.at("parts").at(0).at("points"), 3);
}

TEST_F(Export, OneFileForEachChosenSegment) {
  const std::uint32_t first = map_.segments.at(0).segment_id;
  const std::uint32_t third = map_.segments.at(2).segment_id;
  expect_success("FOLDER/map.kseg --segment-plys FOLDER/parts --segments " + std::to_string(third) +
                 "," + std::to_string(first));
  EXPECT_EQ(
      read_ply(folder_ / "parts" / ("segment_" + std::to_string(third) + ".ply")).points_W.size(),
      map_.segments[2].num_points);
  EXPECT_TRUE(exists("parts/segment_" + std::to_string(first) + ".ply"));
  const auto count = [&] {
    const std::filesystem::directory_iterator files(folder_ / "parts");
    return std::distance(begin(files), end(files));
  };
  EXPECT_EQ(count(), 2);
  std::filesystem::remove_all(folder_ / "parts");
  expect_success("FOLDER/map.kseg --segment-plys FOLDER/parts --min-points 20");
  EXPECT_EQ(count(), std::count_if(map_.segments.begin(), map_.segments.end(),
                                   [](const auto& s) { return s.num_points >= 20; }));
}

TEST_F(Export, SaysWhatIsWrongAndWritesNothing) {
  expect_error("FOLDER/map.kseg", "nothing to write");
  expect_error("FOLDER/map.kseg --json FOLDER/map.kseg", "the same file as that of MAP");
  expect_error("FOLDER/map.kseg --json FOLDER/a --csv FOLDER/a", "the same file as that of --json");
  expect_error("FOLDER/map.kseg --csv FOLDER/absent/a.csv", "there is no folder");
  expect_error("FOLDER/map.kseg --csv FOLDER/a.csv --segment-plys FOLDER/map.kseg/parts",
               "cannot be made");
  const std::string unknown = std::to_string(map_.state.next_id);
  expect_error("FOLDER/map.kseg --csv FOLDER/a.csv --segment-plys FOLDER --segments " + unknown,
               "there is no segment " + unknown);
  expect_error("FOLDER/map.kseg --csv FOLDER/a.csv --segment-plys FOLDER --segments 0",
               "there is no segment 0");
  expect_error("FOLDER/map.kseg --csv FOLDER/a.csv --resolution 0.01", "has its own resolution");
  expect_error("FOLDER/absent.ply --csv FOLDER/a.csv", "absent.ply");
  expect_error("FOLDER/log.txt --csv FOLDER/a.csv", "is no saved segment map");
  expect_error("FOLDER/map.kseg --csv FOLDER/a.csv --mesh FOLDER/segments.ply",
               "of no use without --segs");
  EXPECT_THAT(run("FOLDER/map.kseg --csv FOLDER/a.csv --scene-id x").output,
              HasSubstr("--scene-id requires --segs"));
  std::ofstream(folder_ / "plain.ply") << "ply\nformat ascii 1.0\nelement vertex 1\n"
                                       << "property float x\nproperty float y\n"
                                       << "property float z\nend_header\n0 0 0\n";
  expect_error("FOLDER/plain.ply --csv FOLDER/a.csv", "segment_id");
  std::ofstream(folder_ / "far.ply") << "ply\nformat ascii 1.0\nelement vertex 1\n"
                                     << "property float x\nproperty float y\nproperty float z\n"
                                     << "property int segment_id\nend_header\n0 1e9 0 3\n";
  expect_error("FOLDER/far.ply --resolution 0.01 --csv FOLDER/a.csv", "point 0");
  EXPECT_FALSE(exists("a.csv"));
}

TEST_F(Export, OnAFullDiskLeavesWhatWasThere) {
  const std::string before = read("segments.csv");
  const kintsugi::testing::FileSizeLimit limit(1000);  // the program inherits it
  expect_error("FOLDER/map.kseg --csv FOLDER/segments.csv", (folder_ / "segments.csv").string());
  EXPECT_EQ(read("segments.csv"), before);
}

}  // namespace
}  // namespace kintsugi::segmenter
