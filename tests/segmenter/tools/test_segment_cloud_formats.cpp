// kintsugi-segment-cloud, run as a program on clouds as they come.

#include <cmath>
#include <fstream>
#include <iomanip>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "segmenter/io/ply/ply_reader.hpp"
#include "segmenter/io/ply/ply_table.hpp"
#include "segmenter/io/points/file_bytes.hpp"
#include "tests/segmenter/io/formats/example_clouds.hpp"
#include "tests/segmenter/tools/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

using Position = std::array<double, 3>;

/// A horizontal and an upright plate, 1 cm between points, that do not touch. Around `origin`.
std::vector<Position> two_plates(const Position& origin = {0, 0, 0}) {
  std::vector<Position> points;
  for (int row = 0; row < 20; ++row) {
    for (int column = 0; column < 20; ++column) {
      const double u = 0.01 * row;
      const double v = 0.01 * column;
      points.push_back({origin[0] + u, origin[1] + v, origin[2]});
      points.push_back({origin[0] - 0.5, origin[1] + u, origin[2] + v});
    }
  }
  return points;
}

class SegmentCloudFormats : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string out() const { return path("out.ply"); }

  testing::ProgramResult run(const std::string& arguments) {
    return testing::run_program("kintsugi-segment-cloud", arguments, folder_ / "log.txt");
  }

  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
  }

  /// Expects two segments, each a plate.
  PointTable expect_two_plates(const std::string& input, const std::string& arguments = "") {
    const auto result = run(input + " " + out() + " --resolution 0.01 " + arguments);
    EXPECT_EQ(result.exit_code, 0) << result.output;
    EXPECT_THAT(result.output, HasSubstr("2 segments of 800 points"));
    PointTable table = parse_ply_table(read_file_bytes(out()), "out.ply");
    EXPECT_EQ(table.size(), 800U);
    EXPECT_NE(value(table, 0, "segment_id"), value(table, 1, "segment_id"));
    EXPECT_EQ(table.fields()[*table.find("segment_id")].type, ScalarType::kInt32);
    return table;
  }

  static double value(const PointTable& table, std::size_t point, const std::string& column) {
    const auto field = table.find(column);
    EXPECT_TRUE(field) << column;
    return field ? table.value(point, *field) : 0.0;
  }

  kintsugi::testing::TemporaryFolder folder_;
};

std::string text_of(const std::vector<Position>& points, const std::string& rest = "") {
  std::ostringstream text;
  text << std::setprecision(12);
  for (const Position& p : points) text << p[0] << ' ' << p[1] << ' ' << p[2] << rest << '\n';
  return text.str();
}

std::string ply_of(const std::vector<Position>& points, const std::string& properties,
                   const std::string& rest) {
  return "ply\nformat ascii 1.0\ncomment of the user\nelement vertex " +
         std::to_string(points.size()) +
         "\nproperty double x\nproperty double y\nproperty double z\n" + properties +
         "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
         text_of(points, rest) + "3 0 1 2\n";
}

TEST_F(SegmentCloudFormats, ReadsTextNpyPcdAndLas) {
  const auto points = two_plates();
  expect_two_plates(write("a.xyz", text_of(points)));
  expect_two_plates(write("a.pts", "800\n" + text_of(points, " -500 10 20 30")));
  expect_two_plates(write("a.csv", "X Y Z R G B\n" + text_of(points, " 10 20 30")));
  std::string npy = testing::npy_header("<f8", "800, 3");
  for (const Position& p : points) npy += testing::bytes_of(p);
  expect_two_plates(write("a.npy", npy));
  std::string pcd = "FIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nPOINTS 800\nDATA binary\n";
  for (const Position& p : points) pcd += testing::bytes_of(p);
  expect_two_plates(write("a.pcd", pcd));
  EXPECT_THAT(run(write("far.las", testing::las_cloud(7)) + " " + out()).output,
              AllOf(HasSubstr("read as LAS with the columns x y z red green blue intensity"),
                    HasSubstr("relative to (691000, 5334000, 500) m")));
}

TEST_F(SegmentCloudFormats, KeepsEveryPropertyInItsType) {
  const auto points = two_plates({0.123456789012, 0, 0});
  const auto table = expect_two_plates(
      write("a.ply", ply_of(points,
                            "property uchar diffuse_red\nproperty uchar diffuse_green\n"
                            "property uchar diffuse_blue\nproperty uint segment_id\n"
                            "property short label\nproperty double time\n",
                            " 200 10 20 77 -3 0.1")));
  std::string names;
  for (const PointField& field : table.fields()) {
    names += std::string(name_of(field.type)) + " " + field.name + ", ";
  }
  EXPECT_EQ(names,
            "double x, double y, double z, uchar diffuse_red, uchar diffuse_green, "
            "uchar diffuse_blue, short label, double time, float nx, float ny, float nz, "
            "int segment_id, ");
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_DOUBLE_EQ(value(table, i, "x"), points[i][0]);
    EXPECT_EQ(value(table, i, "diffuse_red"), 200);
    EXPECT_EQ(value(table, i, "label"), -3);
    EXPECT_EQ(value(table, i, "time"), 0.1);
  }
  const std::string bytes = read_file_bytes(out());
  EXPECT_THAT(bytes, AllOf(HasSubstr("comment of the user"),
                           HasSubstr("element face 1\nproperty list uchar int vertex_indices")));
  EXPECT_TRUE(bytes.ends_with("\x03" + testing::bytes_of(std::array<int, 3>{0, 1, 2})));
  EXPECT_THAT(run(path("a.ply") + " " + out()).output, Not(HasSubstr("without colour")));
  // A labelled cloud again: its labels and normals are replaced, not doubled.
  std::filesystem::rename(out(), path("again.ply"));
  EXPECT_EQ(expect_two_plates(path("again.ply")).fields().size(), table.fields().size());
}

TEST_F(SegmentCloudFormats, SegmentsByColoursOfEachName) {
  // One plate, half of it red.
  std::ostringstream rows;
  for (int row = 0; row < 20; ++row) {
    for (int column = 0; column < 60; ++column) {
      rows << 0.01 * column << ' ' << 0.01 * row << " 0 0 0 1 " << (column < 30 ? 200 : 1)
           << " 1 1\n";
    }
  }
  for (const std::string prefix : {"diffuse_red diffuse_green diffuse_blue", "r g b"}) {
    std::istringstream names(prefix);
    std::ostringstream properties;
    for (std::string name; names >> name;) properties << "property uchar " << name << '\n';
    write("a.ply",
          "ply\nformat ascii 1.0\nelement vertex 1200\nproperty float x\nproperty float y\n"
          "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n" +
              properties.str() + "end_header\n" + rows.str());
    EXPECT_THAT(run(path("a.ply") + " " + out()).output, HasSubstr("2 segments of 1200 points"));
  }
}

TEST_F(SegmentCloudFormats, ComputesNormalsThatAreZeroOrNan) {
  const std::string normals = "property float nx\nproperty float ny\nproperty float nz\n";
  for (const std::string nothing : {" 0 0 0", " nan nan nan"}) {
    const auto table = expect_two_plates(write("a.ply", ply_of(two_plates(), normals, nothing)));
    EXPECT_NEAR(std::abs(value(table, 0, "nz")), 1.0, 1e-6);  // float32
    EXPECT_NEAR(std::abs(value(table, 1, "nx")), 1.0, 1e-6);
  }
}

TEST_F(SegmentCloudFormats, KeepsCoordinatesFarFromTheOrigin) {
  const Position utm{691'012.3, 5'334'034.5, 512.0};
  const auto points = two_plates(utm);
  const std::string json = path("out.json");
  const auto table = expect_two_plates(write("utm.xyz", text_of(points)), "--json " + json);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(value(table, i, "y"), points[i][1], 1e-6);  // 12 digits in the text
  }
  const auto root = nlohmann::json::parse(std::ifstream(json));
  EXPECT_EQ(root["origin"], (std::vector<double>{691'000, 5'334'000, 500}));
  const auto& segment = root["segments"][0];
  const std::vector<double> centroid = segment["centroid"];
  const std::vector<double> normal = segment["plane"]["normal"];
  EXPECT_NEAR(centroid[1], utm[1] + 0.095, 1e-4);  // float32 near the origin
  EXPECT_NEAR(segment["box_min"][1], utm[1], 1e-4);
  EXPECT_NEAR(segment["oriented_box"]["center"][1], utm[1] + 0.095, 1e-4);
  const double offset = normal[0] * centroid[0] + normal[1] * centroid[1] + normal[2] * centroid[2];
  EXPECT_NEAR(segment["plane"]["offset"], offset, 1e-3);
}

TEST_F(SegmentCloudFormats, RefusesToOverwriteItsInput) {
  const std::string text = text_of(two_plates());
  const std::string input = write("a.ply", text);
  std::filesystem::create_symlink(input, path("link.ply"));
  std::filesystem::create_hard_link(input, path("hard.ply"));
  const std::string arguments = input + " ";
  const std::string with_json = arguments + out() + " --json ";
  for (const std::string& other :
       {input, path("link.ply"), path("hard.ply"), (folder_ / "." / "a.ply").string()}) {
    const auto result = run(arguments + other);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.output, HasSubstr("the same file as"));
    const auto as_json = run(with_json + other);
    EXPECT_THAT(as_json.output, HasSubstr("--json is " + other));
  }
  EXPECT_THAT(run(with_json + out()).output, HasSubstr("the same file as"));
  EXPECT_EQ(read_file_bytes(input), text);
  EXPECT_FALSE(std::filesystem::exists(out()));
}

TEST_F(SegmentCloudFormats, RefusesAnOutputThatIsNamedAsAnotherFormat) {
  const auto result = run(write("a.xyz", text_of(two_plates())) + " " + path("out.pcd"));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.output, HasSubstr("is written as PLY: let its name end in .ply"));
}

TEST_F(SegmentCloudFormats, FailsWithoutUsablePoints) {
  const auto result =
      run(write("a.xyz", text_of(two_plates({1e9, 0, 0}))) + " " + out() + " --resolution 0.01");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.output, HasSubstr("none of its 800 points can be segmented"));
  // On a line no point has a normal.
  std::string line;
  for (int i = 0; i < 100; ++i) line += std::to_string(0.01 * i) + " 0 0\n";
  const auto on_a_line = run(write("line.xyz", line) + " " + out() + " --resolution 0.01");
  EXPECT_EQ(on_a_line.exit_code, 1);
  EXPECT_FALSE(std::filesystem::exists(out()));
}

TEST_F(SegmentCloudFormats, DividesACubeIntoItsFaces) {
  constexpr int kSide = 32;
  std::set<Position> points;  // those on edges once
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i <= kSide; ++i) {
      for (int j = 0; j <= kSide; ++j) {
        Position p{};
        p.at((axis + 1) % 3) = i / double{kSide};
        p.at((axis + 2) % 3) = j / double{kSide};
        points.insert(p);
        p.at(axis) = 1.0;
        points.insert(p);
      }
    }
  }
  const std::string input = write("cube.xyz", text_of({points.begin(), points.end()}));
  EXPECT_THAT(run(input + " " + out()).output, HasSubstr("6 segments of 6146 points"));
}

TEST_F(SegmentCloudFormats, AsksForTheUnitOfMillimetres) {
  auto points = two_plates();
  for (Position& p : points) {
    for (double& coordinate : p) coordinate *= 1000.0;
  }
  const std::string input = write("mm.xyz", text_of(points));
  EXPECT_THAT(run(input + " " + out()).output,
              AllOf(HasSubstr("--unit mm"), HasSubstr("--unit m")));
  EXPECT_THAT(run(input + " " + out() + " --unit m").output, Not(HasSubstr("--unit")));
  const auto in_mm = run(input + " " + out() + " --unit mm");
  EXPECT_THAT(in_mm.output, AllOf(HasSubstr("resolution 0.01"), HasSubstr("2 segments of 800"),
                                  Not(HasSubstr("--unit"))));
  const auto table = expect_two_plates(input, "--unit mm");
  EXPECT_EQ(value(table, 798, "x"), 190.0);                               // as the file has it
  EXPECT_EQ(run(input + " " + out() + " --unit parsec").exit_code, 105);  // CLI11: not in the set
}

// The file that --unit mm has written tells the unit in its header.
TEST_F(SegmentCloudFormats, TakesTheUnitThatTheHeaderTells) {
  auto points = two_plates();
  for (Position& p : points) {
    for (double& coordinate : p) coordinate *= 1000.0;
  }
  const std::string in_mm = (folder_ / "mm.ply").string();
  ASSERT_EQ(run(write("mm.xyz", text_of(points)) + " " + in_mm + " --unit mm").exit_code, 0);
  EXPECT_EQ(read_ply(in_mm).points_W[798].x, 0.19F);
  EXPECT_THAT(run(in_mm + " " + out()).output,
              AllOf(HasSubstr("its header tells the unit: mm"), HasSubstr("resolution 0.0100"),
                    Not(HasSubstr("--unit"))));
  EXPECT_THAT(run(in_mm + " " + out() + " --unit m").output, HasSubstr("resolution 10.0"));

  const auto exported = testing::run_program(
      "kintsugi-export", in_mm + " --json " + (folder_ / "mm.json").string(), folder_ / "log.txt");
  EXPECT_THAT(exported.output, HasSubstr("resolution 0.0100"));
}

}  // namespace
}  // namespace kintsugi::segmenter
