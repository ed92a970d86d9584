// kintsugi-segment-cloud, run as a program.

#include <cmath>
#include <fstream>
#include <functional>
#include <iomanip>
#include <limits>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "segmenter/io/ply/ply_reader.hpp"
#include "tests/segmenter/process/slice_session.hpp"
#include "tests/segmenter/tools/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class SegmentCloud : public ::testing::Test {
 protected:
  testing::ProgramResult run(const std::string& arguments) {
    return testing::run_program("kintsugi-segment-cloud", arguments, folder_ / "log.txt");
  }

  std::string in() const { return (folder_ / "in.ply").string(); }
  std::string out() const { return (folder_ / "out.ply").string(); }
  std::string json() const { return (folder_ / "out.json").string(); }

  void write_input(const std::string& text) const { std::ofstream(in()) << text; }

  void write_input(const std::vector<CloudPoint>& points, bool normals,
                   const std::function<int(std::size_t)>& slice_of = {}) const {
    std::ofstream out(in());
    out << "ply\nformat ascii 1.0\nelement vertex " << points.size()
        << "\nproperty float x\nproperty float y\nproperty float z\n";
    if (normals) out << "property float nx\nproperty float ny\nproperty float nz\n";
    out << "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    if (slice_of) out << "property int slice_id\n";
    out << "end_header\n" << std::setprecision(9);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const CloudPoint& p = points[i];
      out << p.x << ' ' << p.y << ' ' << p.z;
      if (normals) out << ' ' << p.nx << ' ' << p.ny << ' ' << p.nz;
      out << ' ' << int{p.red} << ' ' << int{p.green} << ' ' << int{p.blue};
      if (slice_of) out << ' ' << slice_of(i);
      out << '\n';
    }
  }

  bool has_output() const { return std::filesystem::exists(out()); }

  kintsugi::testing::TemporaryFolder folder_;
};

// Two square plates, one metre apart, 0.01 m between points.
std::vector<CloudPoint> two_plates() {
  std::vector<CloudPoint> points;
  for (int plate = 0; plate < 2; ++plate) {
    for (int row = 0; row < 20; ++row) {
      for (int column = 0; column < 20; ++column) {
        points.push_back(testing::make_point(0.01 * column, 0.01 * row, 1.0 * plate, 0, 0, 1));
      }
    }
  }
  return points;
}

std::set<std::uint32_t> distinct(const std::vector<std::uint32_t>& labels) {
  return {labels.begin(), labels.end()};
}

TEST_F(SegmentCloud, FindsTheTwoPlatesWithAndWithoutNormalsInBothModes) {
  for (const bool normals : {true, false}) {
    for (const std::string mode : {"batch", "voting"}) {
      for (const std::string neighbours : {"grid", "flann"}) {
        write_input(two_plates(), normals);
        std::string arguments = in() + " " + out();
        arguments.append(" --mode ").append(mode).append(" --neighbours ").append(neighbours);
        const auto result = run(arguments + " --json " + json());
        ASSERT_EQ(result.exit_code, 0) << result.output;
        const PlyCloud cloud = read_ply(out());
        ASSERT_EQ(cloud.points_W.size(), 800U);
        EXPECT_EQ(distinct(cloud.segment_ids).size(), 2U) << result.output;
        EXPECT_EQ(cloud.segment_ids[0], cloud.segment_ids[399]);
        EXPECT_NE(cloud.segment_ids[399], cloud.segment_ids[400]);
        EXPECT_EQ(cloud.points_W[7].x, 0.07F);
        const auto root = nlohmann::json::parse(std::ifstream(json()));
        EXPECT_EQ(root["mode"], mode);
        EXPECT_EQ(root["segments"].size(), 2U);
        EXPECT_THAT(result.output, HasSubstr("resolution 0.0100"));
      }
    }
  }
}

TEST_F(SegmentCloud, TakesSlicesInOrderOfTheirIdsAndKeepsTheOrderOfPoints) {
  const auto slices = testing::wavy_session(5, 150);
  // Points interleaved over the slices, ids that count backwards in the file and have gaps.
  std::vector<CloudPoint> points;
  std::vector<int> ids;
  for (std::size_t i = 0; i < 150; ++i) {
    for (int s = 4; s >= 0; --s) {
      points.push_back(slices[static_cast<std::size_t>(s)].points_W[i]);
      ids.push_back(10 * s);
    }
  }
  write_input(points, true, [&](std::size_t i) { return ids[i]; });
  const auto result = run(in() + " " + out() + " --mode voting --preset paper --resolution 0.01");
  ASSERT_EQ(result.exit_code, 0) << result.output;

  SegmentMapConfig config;
  config.mode = "voting";
  SegmentMap map(config, 1, slices[0]);
  for (const CloudSlice& slice : slices) {
    map.add({&slice, 1});
  }
  const auto expected = testing::labels_of(map);
  const PlyCloud cloud = read_ply(out());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(cloud.slice_ids[i], ids[i]);
    EXPECT_EQ(cloud.points_W[i].x, points[i].x);
    EXPECT_EQ(cloud.segment_ids[i], expected.at(ids[i] / 10)[i / 5]);
  }
}

TEST_F(SegmentCloud, PartsWhatDiffersInColorAlone) {
  // A plate, one half red, the other blue, and one without colour.
  std::vector<CloudPoint> plate;
  for (int row = 0; row < 20; ++row) {
    for (int column = 0; column < 60; ++column) {
      CloudPoint p = testing::make_point(0.01 * column, 0.01 * row, 0, 0, 0, 1);
      if (column < 20) p.red = 200;
      if (column >= 20 && column < 40) p.blue = 200;
      plate.push_back(p);
    }
  }
  write_input(plate, true);
  const auto num_segments = [&](const std::string& arguments) {
    const auto result = run(in() + " " + out() + " --resolution 0.01 " + arguments);
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return distinct(read_ply(out()).segment_ids).size();
  };
  // Between the blue half and the part without colour only normals count.
  EXPECT_EQ(num_segments("--mode batch"), 2U);
  EXPECT_EQ(num_segments("--mode batch --color-weight 0"), 1U);
  EXPECT_EQ(num_segments("--mode batch --preset paper"), 1U);
}

TEST_F(SegmentCloud, TellsThatACloudHasNoColor) {
  write_input(two_plates(), true);
  EXPECT_THAT(run(in() + " " + out()).output, HasSubstr("without colour"));
}

TEST_F(SegmentCloud, AveragesNormalsWhenAsked) {
  auto points = two_plates();
  points[210].nx = 0.6F;
  points[210].nz = 0.8F;
  write_input(points, true);
  run(in() + " " + out() + " --resolution 0.009");
  EXPECT_EQ(read_ply(out()).points_W[210].nz, 0.8F);
  run(in() + " " + out() + " --resolution 0.009 --average-normals");
  // Neighbours closer than 1.8 cm: 8 upright ones.
  const double length = std::hypot(0.6, 8.8);
  EXPECT_NEAR(read_ply(out()).points_W[210].nx, 0.6 / length, 1e-6);  // float32
  EXPECT_NEAR(read_ply(out()).points_W[210].nz, 8.8 / length, 1e-6);
}

TEST_F(SegmentCloud, RejectsPointsItCannotUseAndGoesOn) {
  auto points = two_plates();
  points[3].x = std::numeric_limits<float>::quiet_NaN();
  points[5].z = 1e9F;
  points[8].nz = 0.0F;
  points[9].nz = 2.0F;  // scaled
  write_input(points, true);
  const auto result = run(in() + " " + out() + " --resolution 0.01");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.output,
              AllOf(HasSubstr("1 points rejected: its position is not finite"),
                    HasSubstr("the first is vertex 3"), HasSubstr("more than 1000 km"),
                    HasSubstr("1 normals are zero or not finite: they are computed"),
                    HasSubstr("1 normals were not of unit length and have been scaled")));
  const PlyCloud cloud = read_ply(out());
  ASSERT_EQ(cloud.points_W.size(), 800U);
  for (const std::size_t i : {3, 5}) {
    EXPECT_EQ(cloud.segment_ids[i], kNoSegment);
  }
  EXPECT_NEAR(cloud.points_W[8].nz, 1.0, 1e-6);  // as its neighbours'; float32
  EXPECT_EQ(cloud.points_W[9].nz, 1.0F);
  EXPECT_EQ(distinct(cloud.segment_ids).size(), 3U);
}

TEST_F(SegmentCloud, NamesWhatIsWrongWithTheInputAndWritesNothing) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n";
  const auto expect_error = [&](const std::string& text, const std::string& message) {
    write_input(text);
    const auto result = run(in() + " " + out());
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.output, AllOf(HasSubstr(in()), HasSubstr(message)));
    EXPECT_FALSE(has_output());
  };
  expect_error("", "line 1: not a PLY file");
  expect_error("solid a\n", "line 1: not a PLY file");
  expect_error(header + "0 0 0.00\n1 1\n", "line 9, row 1 of element 'vertex'");
  expect_error(header + "0 0 0\n", "claims 2 rows");
  expect_error(header + "0 0 0\n1 1 1\n", "give --resolution");
  expect_error(
      "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n",
      "holds no points");
  EXPECT_THAT(run((folder_ / "absent.ply").string() + " " + out()).output,
              HasSubstr("absent.ply: no such file"));
}

TEST_F(SegmentCloud, RefusesParametersOutOfRange) {
  write_input(two_plates(), true);
  const auto expect_error = [&](const std::string& option, const std::string& message) {
    const auto result = run(in() + " " + out() + " " + option);
    EXPECT_NE(result.exit_code, 0) << option;
    EXPECT_THAT(result.output, HasSubstr(message));
    EXPECT_FALSE(has_output());
  };
  expect_error("--threshold 0", "threshold");
  expect_error("--scale -1", "scale");
  expect_error("--beta 1.5", "beta");
  expect_error("--resolution -0.01", "--resolution: Value -0.01 not in range");
  expect_error("--resolution nan", "--resolution: 'nan' is no number");
  expect_error("--radius-factor nan", "radius_factor");
  expect_error("--color-weight -1", "color_weight");
  expect_error("--min-points -1", "min_points");
  expect_error("--preset desks", "desks");
  expect_error("--mode exact-ish", "mode is 'exact-ish', must be one of: exact, batch, voting");
  expect_error("--neighbours tree", "--neighbours");
  expect_error("--normals-k 2", "num_neighbours is 2, must be >= 3");
  expect_error("--viewpoint 1 2", "--viewpoint");
  expect_error("--surprise", "--surprise");
}

TEST_F(SegmentCloud, NamesAnOutputItCannotWrite) {
  write_input(two_plates(), true);
  const auto absent = run(in() + " " + (folder_ / "absent").string() + "/out.ply");
  EXPECT_EQ(absent.exit_code, 1);
  EXPECT_THAT(absent.output, HasSubstr("there is no folder"));
  if (std::filesystem::is_directory("/proc/self")) {  // where no file can be made
    const auto special = run(in() + " /proc/out.ply");
    EXPECT_EQ(special.exit_code, 1);
    EXPECT_THAT(special.output, HasSubstr("/proc/out"));
  }
}

}  // namespace
}  // namespace kintsugi::segmenter
