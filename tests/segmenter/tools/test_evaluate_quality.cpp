// kintsugi-evaluate --ground-truth as a program.

#include <fstream>
#include <iomanip>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/segmenter/evaluation/comparison/room_with_truth.hpp"
#include "tests/segmenter/tools/evaluate_program.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::make_room;
using testing::Room;
using ::testing::SizeIs;
using ::testing::StartsWith;

class QualityProgram : public testing::EvaluateProgram {
 protected:
  /// The room, labelled as it is but for the box, which is in two halves.
  void write_room(const std::string& name, const std::string& comments) {
    const Room room = make_room();
    std::ofstream out(path(name));
    out << "ply\nformat ascii 1.0\n" << comments << "element vertex 1200\n";
    for (const char* property : {"x", "y", "z", "nx", "ny", "nz"}) {
      out << "property float " << property << '\n';
    }
    out << "property uint instance_id\nproperty uint segment_id\nend_header\n"
        << std::setprecision(9);
    for (std::size_t i = 0; i < room.truth.points_W.size(); ++i) {
      const CloudPoint& p = room.truth.points_W[i];
      out << p.x << ' ' << p.y << ' ' << p.z << ' ' << p.nx << ' ' << p.ny << ' ' << p.nz << ' '
          << room.truth.instance_ids[i] << ' ' << (i < 1000 ? room.truth.instance_ids[i] : 8)
          << '\n';
    }
  }
};

TEST_F(QualityProgram, WritesTablesAndPage) {
  write_room("room.ply",
             "comment instance 5 structure floor\ncomment instance 6 structure wall\n"
             "comment instance 7 object box\n");
  const auto result = run(path("room.ply") + " --resolution 0.01 --ground-truth " +
                          path("room.ply") + " --presets labels,paper --out " + path("out"));
  EXPECT_EQ(result.exit_code, expected_exit_code()) << result.output;
  const auto rows = lines_of("quality.csv");
  ASSERT_THAT(rows, SizeIs(3));
  EXPECT_THAT(rows[1], StartsWith("labels,,1,,,,,,0.5000,0.8333,1,1,3,1.0000,0.0000,1.0000,"));
  EXPECT_THAT(rows[2], StartsWith("paper,,1,0.001,0.0005,0,0,2,1.0000,1.0000,1,1,3,"));
  EXPECT_THAT(lines_of("instances.csv"),
              ElementsAre("instance,kind,name,points,labels_iou,paper_iou",
                          "5,structure,floor,400,1.0000,1.0000",
                          "6,structure,wall,400,1.0000,1.0000", "7,object,box,400,0.5000,1.0000"));
  EXPECT_THAT(result.output, HasSubstr("2 of 2: paper: mean best IoU 1.000, 1 of 1 objects found"));
  EXPECT_THAT(lines_of("index.html"), ::testing::Contains(HasSubstr("Quality of room.ply")));
}

TEST_F(QualityProgram, ScoresTheParametersOfFlags) {
  write_room("room.ply", "");
  run(path("room.ply") + " --resolution 0.01 --ground-truth " + path("room.ply") +
      " --presets flags --scale 0.25 --out " + path("out"));
  EXPECT_THAT(lines_of("quality.csv")[1], StartsWith("flags,,1,0.001,0.25,"));
}

TEST_F(QualityProgram, NamesWhatIsWrong) {
  write_room("room.ply", "comment instance 5 structure floor\n");
  const std::string in_and_out = path("room.ply") + " --out " + path("out");
  const auto expect_error = [&](const std::string& arguments, const std::string& message) {
    const auto result = run(in_and_out + arguments);
    EXPECT_NE(result.exit_code, 0) << arguments;
    EXPECT_THAT(result.output, HasSubstr(message));
    EXPECT_THAT(lines_of("index.html"), SizeIs(0));
  };
  const std::string truth = " --ground-truth " + path("room.ply");
  expect_error(" --presets paper", "--presets requires --ground-truth");
  expect_error(truth, "no line 'comment instance 6 structure|object NAME'");
  expect_error(truth + " --presets cups", "preset is 'cups'");
  expect_error(truth + " --min-instance-points 0", "min_instance_points is 0");
  expect_error(" --ground-truth " + path("absent.ply"), "absent.ply: no such file");
}

}  // namespace
}  // namespace kintsugi::segmenter
