// kintsugi-diff, as a user runs it.

#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/segmenter/objects/saved_room.hpp"
#include "tests/segmenter/objects/toy_room.hpp"
#include "tests/segmenter/tools/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::save;
using testing::ToyRoom;

class DiffProgram : public ::testing::Test {
 protected:
  testing::ProgramResult run(const std::string& arguments) {
    return testing::run_program("kintsugi-diff", arguments, folder_ / "log");
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  kintsugi::testing::TemporaryFolder folder_;
};

TEST_F(DiffProgram, TellsWhatHasComeAndGone) {
  ToyRoom was = testing::furnished_room();
  ToyRoom is = was;
  was.boxes.push_back({.center_S = {1.6, 1.2, 0.9}, .size_m = {0.3, 0.24, 0.3}});
  is.boxes.push_back(
      {.center_S = {2.8, 2.75, 0.7}, .size_m = {0.6, 0.3, 0.4}, .color = {9, 9, 90}});
  save(was, testing::walk_through(was), folder_ / "before");
  save(is, testing::walk_through(is, 1.0), folder_ / "after");
  const auto result = run(path("before") + " " + path("after") + " --out " + path("out"));
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output,
              AllOf(HasSubstr("2 changes"), HasSubstr("new"), HasSubstr("gone"), HasSubstr("rms")));
  std::ifstream file(folder_ / "out" / "changes.json");
  const auto json = nlohmann::json::parse(file);
  ASSERT_EQ(json["changes"].size(), 2U);
  EXPECT_EQ(json["changes"][0]["kind"], "new");
  EXPECT_EQ(json["changes"][1]["kind"], "gone");
  for (const char* name : {"change_1.ply", "change_2.ply", "changes.png"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / name)) << name;
  }
}

TEST_F(DiffProgram, RefusesByNameAndWritesNothing) {
  const ToyRoom room = testing::furnished_room();
  ToyRoom other;
  other.size_m = {6.0, 2.2, 2.4};
  save(room, testing::walk_through(room), folder_ / "room");
  save(other, testing::walk_through(other), folder_ / "other");
  const auto refusal = [&](const std::string& maps) {
    const auto result = run(maps + " --out " + path("out"));
    EXPECT_EQ(result.exit_code, 1) << result.output;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
    return result.output;
  };
  EXPECT_THAT(refusal(path("room") + " " + path("other")),
              AllOf(HasSubstr(path("room")), HasSubstr("the maps do not fit")));
  EXPECT_THAT(refusal(path("room") + " " + path("absent")), HasSubstr(path("absent")));
  std::ofstream(folder_ / "room.views") << "KVIEWS cut";
  EXPECT_THAT(refusal(path("other") + " " + path("room")), HasSubstr(path("room") + ".views"));
  EXPECT_GE(run(path("room")).exit_code, 100);
  for (const char* live : {"--exit-on-final", "--every 5", "--map-name map"}) {
    EXPECT_GE(run(path("room") + " " + path("room") + " --out x " + live).exit_code, 100) << live;
  }
}

}  // namespace
}  // namespace kintsugi::segmenter
