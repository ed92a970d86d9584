// kintsugi-evaluate as a program: the tables and figures of the paper.

#include <fstream>
#include <iomanip>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segmenter/evaluation/paper/evaluation.hpp"
#include "tests/segmenter/evaluation/session/log_of_slices.hpp"
#include "tests/segmenter/process/slice_session.hpp"
#include "tests/segmenter/tools/evaluate_program.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class EvaluateProgram : public testing::EvaluateProgram {
 protected:
  void write_session_log(int num_slices) {
    testing::LogMessages messages;
    testing::append_slices(testing::wavy_session(num_slices, 200), messages);
    testing::write_log(path("in.lcm"), messages);
  }

  void write_ply(bool with_slice_ids, bool with_normals) {
    const auto slices = testing::wavy_session(3, 200);
    std::ofstream out(path("in.ply"));
    out << "ply\nformat ascii 1.0\nelement vertex 600\nproperty float x\nproperty float y\n"
           "property float z\n";
    if (with_normals) out << "property float nx\nproperty float ny\nproperty float nz\n";
    if (with_slice_ids) out << "property int slice_id\n";
    out << "end_header\n" << std::setprecision(9);
    for (const CloudSlice& slice : slices) {
      for (const CloudPoint& p : slice.points_W) {
        out << p.x << ' ' << p.y << ' ' << p.z;
        if (with_normals) out << ' ' << p.nx << ' ' << p.ny << ' ' << p.nz;
        if (with_slice_ids) out << ' ' << slice.id;
        out << '\n';
      }
    }
  }
};

TEST_F(EvaluateProgram, WritesTablesAndPageOfALog) {
  write_session_log(4);
  const auto result = run(path("in.lcm") + " --out " + path("out"));
  EXPECT_EQ(result.exit_code, expected_exit_code()) << result.output;
  const auto num_modes = evaluation_modes().size();
  EXPECT_EQ(lines_of("table1.csv").size(), 1 + num_modes);
  EXPECT_EQ(lines_of("table2.csv").size(), 1 + num_modes);
  EXPECT_EQ(lines_of("agreement.csv").size(), 1 + 2 * num_modes);
  for (const std::string& mode : evaluation_modes()) {
    EXPECT_EQ(lines_of("slices_" + mode + ".csv").size(), 5U);
    EXPECT_THAT(result.output, HasSubstr(mode + ": slice 4 of 4, 800 points"));
  }
  EXPECT_GT(lines_of("index.html").size(), 50U);
  EXPECT_THAT(lines_of("index.html"), Contains(HasSubstr("src=\"data:image/png;base64,")));
  EXPECT_THAT(lines_of("index.html"), Contains(HasSubstr("<dt>Preset</dt><dd>paper")));
  EXPECT_GT(std::filesystem::file_size(path("out/map.png")), 100U);
  EXPECT_THAT(result.output, HasSubstr("memory:"));
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "out")) {
    EXPECT_EQ(entry.path().string().find("partial"), std::string::npos) << entry.path();
  }
}

TEST_F(EvaluateProgram, SaysThatTheRunHadOtherParameters) {
  testing::LogMessages messages;
  const auto slices = testing::wavy_session(2, 200);
  testing::append_slices(slices, messages);
  SegmenterStatus status;
  status.session = 1;
  status.map_session = slices.front().session;
  status.finished = true;
  status.segments = 123'456;
  messages.emplace_back(channels::kSegmenterStatus, encode(status));
  testing::write_log(path("in.lcm"), messages);
  EXPECT_THAT(run("--modes batch " + path("in.lcm") + " --out " + path("out")).output,
              HasSubstr("123,456 segments"));
}

TEST_F(EvaluateProgram, TakesModesInTheOrderGiven) {
  write_session_log(2);
  run("--segments 2 --modes batch,voting " + path("in.lcm") + " --out " + path("out"));
  const auto lines = lines_of("table1.csv");
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[1].rfind("batch,400,2,", 0), 0U) << lines[1];
  EXPECT_EQ(lines[2].rfind("voting,400,2,", 0), 0U) << lines[2];
}

TEST_F(EvaluateProgram, EvaluatesAPlyFileBySliceWithoutTimes) {
  write_ply(true, true);
  const auto result =
      run(path("in.ply") + " --resolution 0.01 --modes voting,batch --out " + path("out"));
  EXPECT_EQ(result.exit_code, expected_exit_code()) << result.output;
  EXPECT_THAT(result.output, HasSubstr("Table II are left out"));
  const auto lines = lines_of("table1.csv");
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[1].rfind("voting,600,3,,,3,", 0), 0U) << lines[1];
  EXPECT_THAT(lines_of("table2.csv"), IsEmpty());
}

TEST_F(EvaluateProgram, SaysThatACloudWithoutSlicesIsOne) {
  write_ply(false, false);
  const auto result = run(path("in.ply") + " --resolution 0.01 --out " + path("out"));
  EXPECT_EQ(result.exit_code, expected_exit_code()) << result.output;
  EXPECT_THAT(result.output, AllOf(HasSubstr("evaluated as a single slice"), HasSubstr("normals")));
  EXPECT_EQ(lines_of("slices_batch.csv").size(), 2U);
}

TEST_F(EvaluateProgram, EvaluatesWhatADamagedLogHoldsAndEndsWith1) {
  write_session_log(4);
  std::filesystem::resize_file(path("in.lcm"), std::filesystem::file_size(path("in.lcm")) - 100);
  const auto result = run(path("in.lcm") + " --out " + path("out"));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.output, AllOf(HasSubstr("is damaged at byte"), HasSubstr("written:")));
  EXPECT_THAT(lines_of("index.html"), Contains(HasSubstr("is damaged at byte")));
}

TEST_F(EvaluateProgram, NamesWhatIsWrongAndWritesNoPage) {
  write_session_log(2);
  const auto expect_error = [&](const std::string& arguments, const std::string& message) {
    const auto result = run(arguments);
    EXPECT_NE(result.exit_code, 0) << arguments;
    EXPECT_THAT(result.output, HasSubstr(message));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out" / "index.html"));
  };
  const std::string out = " --out " + path("out");
  expect_error(path("in.lcm"), "--out is required");
  expect_error(path("absent.lcm") + out, "absent.lcm");
  expect_error(path("in.lcm") + " --modes quick" + out, "mode is 'quick', must be one of");
  expect_error(path("in.lcm") + " --batch-budget 0" + out, "batch_budget_s");
  expect_error(path("in.lcm") + " --segments 0" + out, "rank 0");
  std::ofstream(path("file")) << "x";
  expect_error(path("in.lcm") + " --out " + path("file"), path("file"));
  expect_error(path("in.lcm") + " --out /proc/kintsugi", "/proc/kintsugi");

  testing::LogMessages messages;
  testing::append_pose(testing::pose_at(0.0, 1), messages);
  testing::write_log(path("poses.lcm"), messages);
  expect_error(path("poses.lcm") + out, "holds no slice that could be read on CLOUD_SLICE");
}

}  // namespace
}  // namespace kintsugi::segmenter
