// kintsugi-evaluate --trajectory, run as a program.

#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/lcmtypes/example_paths.hpp"
#include "tests/segmenter/tools/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter {
namespace {

using kintsugi::testing::TemporaryFolder;
using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;

class EvaluateTrajectory : public ::testing::Test {
 protected:
  /// 90 poses, 10 cm apart; the estimate 1 % too long.
  EvaluateTrajectory() {
    Trajectory truth = kintsugi::testing::helix(90);
    write("truth.txt", truth);
    for (StampedPose& pose : truth) pose.X_WC.translation() *= 1.01;
    write("estimate.txt", truth);
  }

  void write(const std::string& name, const Trajectory& trajectory) {
    std::ofstream out(folder_ / name);
    write_tum(out, trajectory);
  }
  void write_text(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
  }
  std::string read(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(folder_ / name).rdbuf();
    return text.str();
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string paths() const {
    return "--trajectory " + path("estimate.txt") + " --truth " + path("truth.txt");
  }
  testing::ProgramResult run(const std::string& arguments) {
    return testing::run_program("kintsugi-evaluate", arguments, folder_ / "output.txt");
  }

  TemporaryFolder folder_;
};

TEST_F(EvaluateTrajectory, TellsTheErrorsToAPerson) {
  const auto result = run(paths());
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.output, AllOf(HasSubstr("estimate.txt, 90 poses"), HasSubstr("ATE, m"),
                                   HasSubstr("RPE, 1 s, m"), HasSubstr("RPE, 1 s, deg"),
                                   HasSubstr("RPE, 1 m of path, m"), HasSubstr("% of the path")));
}

TEST_F(EvaluateTrajectory, WritesTheSameAsJsonAndCsv) {
  const auto result =
      run(paths() + " --json " + path("errors.json") + " --csv " + path("errors.csv"));
  ASSERT_EQ(result.exit_code, 0) << result.output;
  const auto json = nlohmann::json::parse(read("errors.json"));
  EXPECT_EQ(json["poses"], 90);
  EXPECT_EQ(json["delta"], "1 s");
  EXPECT_EQ(json["ate_m"]["pairs"], 90);
  // Steps of 10.2 cm (a chord of the unit circle and 2 cm up); nine decimals are written.
  const double step_m = std::hypot(2.0 * std::sin(0.05), 0.02);
  EXPECT_NEAR(json["path_length_m"].get<double>(), 89 * step_m, 1e-6);
  const double end_m = std::hypot(2.0 * std::sin(89 * 0.05), 89 * 0.02);
  EXPECT_NEAR(json["end_translation_m"].get<double>(), 0.01 * end_m, 1e-6);
  EXPECT_NEAR(json["drift_percent"].get<double>(), end_m / (89 * step_m), 1e-4);
  EXPECT_NEAR(json["rpe_deg"]["max"].get<double>(), 0.0, 1e-5);

  std::istringstream csv(read("errors.csv"));
  std::string header;
  std::string row;
  ASSERT_TRUE(std::getline(csv, header) && std::getline(csv, row));
  EXPECT_THAT(header, HasSubstr(",ate_m_rmse,ate_m_mean,ate_m_median,ate_m_std,ate_m_min,"));
  EXPECT_THAT(row, HasSubstr(",90,1 s,"));
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), std::count(row.begin(), row.end(), ','));
}

TEST_F(EvaluateTrajectory, TakesTheIntervalInAnyUnit) {
  EXPECT_THAT(run(paths() + " --delta 10 --delta-unit f").output, HasSubstr("RPE, 10 f, m"));
  EXPECT_THAT(run(paths() + " --delta 0.5 --delta-unit m").output, HasSubstr("RPE, 0.5 m, deg"));
  EXPECT_THAT(run(paths() + " --delta 45 --delta-unit deg").output, HasSubstr("RPE, 45 deg, m"));
  EXPECT_THAT(run(paths() + " --all-pairs").output, ContainsRegex("RPE, all pairs, m +8100 "));
}

TEST_F(EvaluateTrajectory, NamesWhatIsWrongAndWritesNothing) {
  const auto expect_error = [&](const std::string& arguments, const std::string& message) {
    const auto result = run(arguments + " --csv " + path("errors.csv"));
    EXPECT_NE(result.exit_code, 0) << arguments;
    EXPECT_THAT(result.output, HasSubstr(message));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "errors.csv"));
  };
  const std::string estimate = "--trajectory " + path("estimate.txt");
  const std::string truth = " --truth " + path("truth.txt");
  expect_error(estimate, "--trajectory requires --truth");
  expect_error(truth, "--truth requires --trajectory");
  expect_error(paths() + " in.lcm", "--trajectory excludes IN");
  expect_error(paths() + " --delta 0", "delta is 0.0");
  expect_error(paths() + " --delta 1000", "0 motions over the given delta");
  expect_error(paths() + " --delta-unit h", "--delta-unit");
  expect_error("--trajectory " + path("absent.txt") + truth, "absent.txt: No such file");
  expect_error("--trajectory " + folder_.path().string() + truth, "cannot be read");
  for (const auto& [text, message] : std::vector<std::pair<std::string, std::string>>{
           {"", "bad.txt: holds no pose"},
           {"1 0 0 0 0 0 0\n", "bad.txt:1: 7 fields"},
           {std::string("\0\xff\x01 2 3", 7), "bad.txt:1: "},
           {"1 1e200 0 0 0 0 0 1\n", "field 2 '1e200' is farther than 1e9 m"},
           {"-9e18 0 0 0 0 0 0 1\n", "timestamp '-9e18'"},
           {"9000000000000 0 0 0 0 0 0 1\n", "timestamp '9000000000000'"},
           {"1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n", "2 poses have a true pose within 20 ms"}}) {
    write_text("bad.txt", text);
    expect_error("--trajectory " + path("bad.txt") + truth, message);
  }
  EXPECT_NE(run(paths() + " --json /proc/kintsugi.json").exit_code, 0);
}

}  // namespace
}  // namespace kintsugi::segmenter
