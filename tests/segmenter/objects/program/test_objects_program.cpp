// kintsugi-objects, run as a user runs it.

#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "lcmtypes/base/ply_writer.hpp"
#include "segmenter/core/points/transformed_points.hpp"
#include "segmenter/io/ply/labelled_ply_writer.hpp"
#include "segmenter/objects/library/object_library.hpp"
#include "segmenter/objects/model/make_model.hpp"
#include "tests/segmenter/objects/box_on_table.hpp"
#include "tests/segmenter/objects/saved_room.hpp"
#include "tests/segmenter/tools/program.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::box_on_table;
using ::testing::HasSubstr;
using ::testing::Not;

void write_map(const ObservedMap& map, const fs::path& path) {
  LabelledPlyWriter writer(path, std::ssize(map.points_W), {});
  for (std::size_t i = 0; i < map.points_W.size(); ++i) {
    writer.append(map.points_W[i], map.segment_ids[i], 0);
  }
  writer.commit();
}

void write_text(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }

class Objects : public ::testing::Test {
 protected:
  Objects() {
    write_map(box_on_table(), folder_ / "hall.ply");
    write_map(box_on_table({"z", "-y", "-x"}, {-0.15F, 0.1F, 0.0F}, 0.7F), folder_ / "room.ply");
  }

  /// FOLDER stands for the test's folder; the library is in it.
  testing::ProgramResult run(std::string arguments) const {
    arguments += " --library FOLDER/objects";
    for (std::size_t at = 0; (at = arguments.find("FOLDER")) != std::string::npos;) {
      arguments.replace(at, 6, folder_.path().string());
    }
    return testing::run_program("kintsugi-objects", arguments, folder_ / "log.txt");
  }
  std::string expect_success(const std::string& arguments) const {
    const auto result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return result.output;
  }
  void expect_error(const std::string& arguments, const std::string& reason) const {
    const auto result = run(arguments);
    EXPECT_EQ(result.exit_code, 1) << result.output;
    EXPECT_THAT(result.output, HasSubstr("kintsugi-objects: "));
    EXPECT_THAT(result.output, HasSubstr(reason));
  }
  ObjectLibrary library() const { return ObjectLibrary::read(folder_ / "objects"); }

  /// What kintsugi-diff writes: the box came, the ball went.
  void write_difference(const Pose& X_AB = Pose::Identity()) const {
    const fs::path diff = folder_ / "diff";
    fs::create_directory(diff);
    const json root = {
        {"before", (folder_ / "hall.ply").string()},
        {"after", (folder_ / "room.ply").string()},
        {"X_AB", rows_of(X_AB)},
        {"changes",
         {{{"id", 1}, {"kind", "new"}, {"before_segments", json::array()}, {"after_segments", {2}}},
          {{"id", 2},
           {"kind", "gone"},
           {"before_segments", {3}},
           {"after_segments", json::array()}},
          {{"id", 3}, {"kind", "unseen"}}}}};
    write_text(diff / "changes.json", root.dump());
    write_change(diff / "change_1.ply", box_on_table({"z", "-y", "-x"}, {-0.15F, 0.1F, 0.0F}, 0.7F),
                 testing::kBox, 0);
    ObservedMap before = box_on_table();
    for (CloudPoint& p : before.points_W) p = transformed(p, X_AB);
    write_change(diff / "change_2.ply", before, testing::kBall, 1);
  }
  static void write_change(const fs::path& path, const ObservedMap& map, std::uint32_t id,
                           std::uint8_t was) {
    PlyWriter writer(
        path, {{.name = "vertex",
                .properties = {"float x", "float y", "float z", "float nx", "float ny", "float nz",
                               "uchar red", "uchar green", "uchar blue", "uchar was"}}});
    for (std::size_t i = 0; i < map.points_W.size(); ++i) {
      if (map.segment_ids[i] != id) continue;
      const CloudPoint& p = map.points_W[i];
      writer.append(0, p.x, p.y, p.z, p.nx, p.ny, p.nz, p.red, p.green, p.blue, was);
    }
    writer.commit();
  }

  kintsugi::testing::TemporaryFolder folder_;
};

TEST_F(Objects, AreTaughtListedShownAndForgotten) {
  EXPECT_THAT(expect_success("teach --map FOLDER/hall.ply --ids 2 --name box"), HasSubstr("box: "));
  expect_success("teach --map FOLDER/hall.ply --ids 3 --name ball");
  EXPECT_THAT(expect_success("list"), ::testing::AllOf(HasSubstr("ball "), HasSubstr("box ")));
  const json all = json::parse(expect_success("list --json"));
  ASSERT_EQ(all.at("objects").size(), 2U);
  EXPECT_EQ(all["objects"][1]["name"], "box");
  EXPECT_EQ(all["objects"][1]["lessons"][0]["segments"], json({2}));

  EXPECT_THAT(expect_success("show box --png FOLDER/box.png"), HasSubstr("z is up"));
  const cv::Mat picture = cv::imread((folder_ / "box.png").string());
  EXPECT_EQ(picture.cols, 1200);
  EXPECT_EQ(json::parse(expect_success("show box --json")).at("points"),
            library().find("box")->model.points_O.size());

  EXPECT_THAT(expect_success("forget box"), HasSubstr("box: forgotten"));
  EXPECT_EQ(library().objects().size(), 1U);
}

TEST_F(Objects, TaughtAgainAreRefined) {
  expect_success("teach --map FOLDER/hall.ply --ids 2 --name box");
  const std::size_t before = library().find("box")->model.points_O.size();
  EXPECT_THAT(expect_success("teach --map FOLDER/room.ply --ids 2 --name box"),
              HasSubstr("taught 2 times"));
  EXPECT_GT(library().find("box")->model.points_O.size(), before + 100);
  expect_error("teach --map FOLDER/room.ply --ids 3 --name box", "--replace forgets");
  EXPECT_EQ(library().find("box")->model.times_taught, 2);
  expect_success("teach --map FOLDER/room.ply --ids 3 --name box --replace");
  EXPECT_EQ(library().find("box")->model.times_taught, 1);
}

TEST_F(Objects, OfTwoNamesBecomeOne) {
  expect_success("teach --map FOLDER/hall.ply --ids 2 --name box");
  expect_success("teach --map FOLDER/room.ply --ids 2 --name carton");
  expect_success("teach --map FOLDER/room.ply --ids 3 --name ball");
  EXPECT_THAT(expect_success("merge box carton"), HasSubstr("carton: is box now"));
  EXPECT_EQ(library().objects().size(), 2U);
  EXPECT_EQ(library().find("box")->lessons.size(), 2U);
  expect_error("merge box ball", "'ball' does not fit what is known of 'box'");
  expect_error("merge box box", "into itself");
  expect_error("merge box carton", "there is no object 'carton'; it has ball, box");
  EXPECT_EQ(library().objects().size(), 2U);
}

TEST_F(Objects, AreTaughtFromADifference) {
  write_difference();
  const std::string output = expect_success("teach --from-diff FOLDER/diff");
  EXPECT_THAT(output, ::testing::AllOf(HasSubstr("new_1: "), HasSubstr("gone_2: ")));
  ASSERT_NE(library().find("gone_2"), nullptr);
  EXPECT_EQ(library().find("gone_2")->lessons[0].segment_ids, std::vector<std::uint32_t>{3});
  expect_success("teach --from-diff FOLDER/diff --change 1");
  EXPECT_NE(library().find("new_1_2"), nullptr);
  expect_success("teach --from-diff FOLDER/diff --change 2 --name ball");
  EXPECT_NE(library().find("ball"), nullptr);
  expect_error("teach --from-diff FOLDER/diff --name ball", "choose one with --change");
  expect_error("teach --from-diff FOLDER/diff --change 3", "1 (new), 2 (gone), 3 (unseen)");
  expect_error("teach --from-diff FOLDER/none", "changes.json: no such file");
  write_text(folder_ / "diff" / "changes.json", "{}");
  expect_error("teach --from-diff FOLDER/diff", "changes.json: ");
}

TEST_F(Objects, OfADifferenceCanBeReplaced) {
  write_difference();
  expect_success("teach --from-diff FOLDER/diff --change 1");
  expect_success("teach --from-diff FOLDER/diff --change 1 --replace");
  EXPECT_EQ(library().objects().size(), 1U);
  EXPECT_EQ(library().find("new_1")->model.times_taught, 1);
}

TEST_F(Objects, OfAMapThatWasOnTheBusAreTaughtFromWhereItWasSaved) {
  write_difference();
  const fs::path path = folder_ / "diff" / "changes.json";
  std::ifstream file(path);
  json root = json::parse(file);
  root["after"] = "map";
  write_text(path, root.dump());
  expect_error("teach --from-diff FOLDER/diff", "map: there is no such map; if it was on the bus");
  EXPECT_TRUE(library().objects().empty());
  expect_success("teach --from-diff FOLDER/diff --map FOLDER/room.ply");
  EXPECT_EQ(library().objects().size(), 2U);
}

TEST_F(Objects, AreNotTaughtFromAnotherMapThanWasCompared) {
  write_difference();
  const testing::ToyRoom room = testing::furnished_room();
  testing::save(room, testing::walk_through(room), folder_ / "saved");
  const fs::path path = folder_ / "diff" / "changes.json";
  std::ifstream file(path);
  json root = json::parse(file);
  root["after_session"] = 77;
  write_text(path, root.dump());
  expect_error("teach --from-diff FOLDER/diff --map FOLDER/saved",
               "saved: is of session 5, and the map that was compared is of session 77");
}

TEST_F(Objects, AreAllForgottenOrNone) {
  expect_success("teach --map FOLDER/hall.ply --ids 2 --name box");
  write_text(folder_ / "objects" / "notes", "of the user");
  expect_error("forget box 'my box'", "my box");
  expect_error("forget box notes", "is no folder of an object");
  EXPECT_NE(library().find("box"), nullptr);
  EXPECT_TRUE(fs::exists(folder_ / "objects" / "notes"));
}

TEST_F(Objects, WhatIsGoneIsTaughtWhereItStoodInTheMapBefore) {
  // The map after begins 2 m aside and turned by a quarter about z; changes are told in its W.
  Pose X_AB = Pose(Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()));
  X_AB.translation() = Eigen::Vector3d(2, 0, 0);
  write_difference(X_AB);
  expect_success("teach --from-diff FOLDER/diff --change 2 --name gone");
  expect_success("teach --map FOLDER/hall.ply --ids 3 --name ball");
  const Pose X_WO = pose_of(*library().find("gone")->lessons[0].X_WO);
  const Pose expected = pose_of(*library().find("ball")->lessons[0].X_WO);
  EXPECT_LT((X_WO.matrix() - expected.matrix()).norm(), 1e-3);
  const fs::path path = folder_ / "diff" / "changes.json";
  std::ifstream file(path);
  json root = json::parse(file);
  root["X_AB"] = {1, 2};
  write_text(path, root.dump());
  expect_error("teach --from-diff FOLDER/diff --change 2", "'X_AB' has 2 numbers, expected 12");
}

TEST_F(Objects, AreNotLookedForWhereTheResultCannotBeWritten) {
  expect_success("teach --map FOLDER/hall.ply --ids 2 --name box");
  expect_error("detect --check --json FOLDER/none/found.json", "found.json: there is no folder");
}

TEST_F(Objects, AreNotLookedForWithoutNormals) {
  expect_success("teach --map FOLDER/hall.ply --ids 2 --name box");
  write_text(folder_ / "bare.ply",
             "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
             "property float z\nproperty uint segment_id\nend_header\n0 0 0 1\n0 0.01 0 1\n");
  expect_error("detect FOLDER/bare.ply", "none of its 2 points has a normal");
}

TEST_F(Objects, WhatCannotBeTaughtSaysWhy) {
  expect_error("teach --map FOLDER/hall.ply --ids 9 --name box",
               "there is no segment 9 among its 3; the nearest ids are 3");
  expect_error("teach --map FOLDER/hall.ply --name box", "--map needs --ids");
  expect_error("teach --map FOLDER/hall.ply --ids 2", "--map needs --name");
  expect_error("teach --name box", "give either --map");
  expect_error("teach --map FOLDER/none.ply --ids 2 --name box", "none.ply");
  expect_error("teach --map FOLDER/hall.ply --ids 2 --name ../box", "letters, digits");
  EXPECT_FALSE(fs::exists(folder_ / "objects"));
  write_text(folder_ / "objects", "a file");
  expect_error("teach --map FOLDER/hall.ply --ids 2 --name box", "objects'");
  EXPECT_GE(run("teach --maps x").exit_code, 100);
  EXPECT_GE(run("").exit_code, 100);
}

TEST_F(Objects, AFlatPatchIsTaughtWithAWarning) {
  EXPECT_THAT(expect_success("teach --map FOLDER/hall.ply --ids 1 --name table"),
              HasSubstr("table is one flat patch of one colour"));
  EXPECT_THAT(expect_success("teach --map FOLDER/hall.ply --ids 2 --name box"),
              ::testing::Not(HasSubstr("flat patch")));
}

TEST_F(Objects, AFullDiskLeavesTheLibraryAsItWas) {
  expect_success("teach --map FOLDER/hall.ply --ids 2 --name box");
  {
    const kintsugi::testing::FileSizeLimit limit(4096);
    expect_error("teach --map FOLDER/room.ply --ids 2 --name box", "File too large");
    expect_error("teach --map FOLDER/hall.ply --ids 3 --name ball", "File too large");
  }
  EXPECT_EQ(library().objects().size(), 1U);
  EXPECT_EQ(library().find("box")->model.times_taught, 1);
}

TEST_F(Objects, ThatAreDamagedAreNamedAndTheOthersUsed) {
  expect_success("teach --map FOLDER/hall.ply --ids 2 --name box");
  expect_success("teach --map FOLDER/hall.ply --ids 3 --name ball");
  write_text(folder_ / "objects" / "ball" / "object.json", "{");
  EXPECT_THAT(expect_success("list"),
              ::testing::AllOf(HasSubstr("'ball' is not used: "), HasSubstr("box ")));
  expect_error("show ball", "ball/object.json: is no JSON");
  expect_error("teach --map FOLDER/room.ply --ids 3 --name ball", "--replace forgets");
  expect_error("forget box cup", "there is no object 'cup'");
  EXPECT_NE(library().find("box"), nullptr);  // all or none
  expect_success("forget ball");
  EXPECT_THAT(expect_success("list"), Not(HasSubstr("ball")));
}

TEST_F(Objects, AreDetectedInAnotherMap) {
  expect_success("teach --map FOLDER/hall.ply --ids 2 --name box");
  expect_success("teach --map FOLDER/hall.ply --ids 3 --name ball");
  write_map(box_on_table({"z", "-y", "x"}, {-0.2F, 0.15F, 0.0F}, 0.5F), folder_ / "later.ply");
  const std::string text = expect_success("detect FOLDER/later.ply --json FOLDER/found.json");
  EXPECT_THAT(text, ::testing::AllOf(HasSubstr("ball "), HasSubstr("box ")));
  std::ifstream file(folder_ / "found.json");
  const json found = json::parse(file);
  ASSERT_EQ(found.at("detections").size(), 2U);
  for (const json& detection : found["detections"]) {
    const std::uint32_t id = detection["name"] == "box" ? testing::kBox : testing::kBall;
    EXPECT_EQ(detection["segments"], json({id}));
    EXPECT_EQ(detection["event"], "confirmed");
    EXPECT_GE(detection["score"].get<double>(), 0.6);
    EXPECT_EQ(detection["X_WO"].size(), 12U);
  }
}

TEST_F(Objects, AreNotLookedForInMapsOrLibrariesThatAreNone) {
  expect_error("detect FOLDER/hall.ply", "there is no such library");
  expect_success("teach --map FOLDER/hall.ply --ids 2 --name box");
  expect_error("detect FOLDER/absent.map", "absent.map");
  expect_success("detect --check");
  write_text(folder_ / "objects" / "box" / "object.json", "{");
  EXPECT_THAT(expect_success("detect --check"), HasSubstr("box"));
  EXPECT_THAT(expect_success("detect FOLDER/hall.ply"), Not(HasSubstr("box  ")));
}

}  // namespace
}  // namespace kintsugi::segmenter
