// kintsugi-query of a saved map, run as a program.

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segmenter/io/saved_map.hpp"
#include "tests/segmenter/process/slice_session.hpp"
#include "tests/segmenter/tools/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::HasSubstr;

class QueryOfASavedMap : public ::testing::Test {
 protected:
  QueryOfASavedMap() {
    const auto slices = testing::wavy_session(2, 250);
    SegmentMap map({}, 77, slices[0]);
    for (const CloudSlice& slice : slices) map.add({&slice, 1});
    write_map_state(map.state(), folder_ / "map.kseg");
  }

  testing::ProgramResult run(const std::string& arguments) const {
    return testing::run_program("kintsugi-query",
                                "--map " + (folder_ / "map.kseg").string() + " " + arguments,
                                folder_ / "log.txt");
  }
  void expect_error(const std::string& arguments, const std::string& reason) const {
    const auto result = run(arguments);
    EXPECT_NE(result.exit_code, 0) << arguments;
    EXPECT_THAT(result.output, HasSubstr(reason)) << arguments;
  }

  kintsugi::testing::TemporaryFolder folder_;
};

TEST_F(QueryOfASavedMap, RefusesIntrinsicsOfNoCamera) {
  const auto looking = [](const std::string& intrinsics) {
    return "--pixel 10 10 --pose 0 0 1 0 0 0 1 --intrinsics " + intrinsics;
  };
  EXPECT_EQ(run(looking("525 525 319.5 239.5 640 480")).exit_code, 0);
  expect_error(looking("-525 525 319.5 239.5 640 480"), "--intrinsics: FX is -525");
  expect_error(looking("525 0 319.5 239.5 640 480"), "--intrinsics: FY is 0");
  expect_error(looking("525 525 319.5 239.5 1e20 480"), "--intrinsics: WIDTH is 1e+20");
  expect_error(looking("525 525 319.5 239.5 640 0"), "--intrinsics: HEIGHT is 0");
  expect_error(looking("525 525 319.5 239.5 640.7 480"), "must be a whole number");
  expect_error(looking("525 525 319.5 239.5 nan 480"), "'nan' is no finite number");
}

TEST_F(QueryOfASavedMap, RefusesPlacesThatAreNotFinite) {
  expect_error("--at 0 nan 0", "'nan' is no finite number");
  expect_error("--ray 0 0 0 0 0 nan", "'nan' is no finite number");
  expect_error("--ray 0 0 0 0 0 0", "DX DY DZ are all 0");
  expect_error("--box 0 0 0 1 1 inf", "'inf' is no finite number");
  expect_error("--pixel 1 1 --pose 0 0 1 nan 0 0 1", "'nan' is no finite number");
}

// An empty variable of a script would ask the bus.
TEST_F(QueryOfASavedMap, RefusesAMapWithoutAName) {
  const auto result = testing::run_program(
      "kintsugi-query", "--map '' --lcm-url memq:// --timeout 0.01", folder_ / "log.txt");
  EXPECT_EQ(result.exit_code, 105) << result.output;  // CLI11: a check has failed
  EXPECT_THAT(result.output, HasSubstr("--map: is empty"));
}

}  // namespace
}  // namespace kintsugi::segmenter
