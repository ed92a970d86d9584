// Reasons, pictures and poses of detections, with a library on disk.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "lcmtypes/base/ply_writer.hpp"
#include "segmenter/core/points/transformed_points.hpp"
#include "segmenter/evaluation/objects/detection_pictures.hpp"
#include "segmenter/evaluation/objects/detection_reasons.hpp"
#include "segmenter/evaluation/objects/objects_report.hpp"
#include "segmenter/evaluation/objects/taught_model.hpp"
#include "segmenter/io/ply/labelled_ply_writer.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr int kSide = 25;
constexpr int kMiddle = kSide / 2;

Pose at(double x, double y, double z) {
  Pose X = Pose::Identity();
  X.translation() = Eigen::Vector3d(x, y, z);
  return X;
}

/// A plate of 25 x 25 points, a centimetre apart, about the origin; it faces -z.
std::vector<CloudPoint> plate(std::uint8_t red) {
  std::vector<CloudPoint> points;
  for (int i = 0; i < kSide * kSide; ++i) {
    CloudPoint& p = points.emplace_back();
    const int row = i / kSide - kMiddle;
    p.x = 0.01F * static_cast<float>(i % kSide - kMiddle);
    p.y = 0.01F * static_cast<float>(row);
    p.nz = -1.0F;
    p.red = red;
    p.green = p.blue = 40;
  }
  return points;
}

/// A room with a red mug (instance 5) at (0, 0, 2) and a toaster (6) at (1, 0, 2), both plates.
/// The mug was taught a metre from the origin of the map before, where it stood turned by 30
/// degrees about z.
class DetectionReport : public ::testing::Test {
 protected:
  DetectionReport() {
    add(5, 1, at(0, 0, 2), 200);
    add(6, 2, at(1, 0, 2), 40);
    truth_.instances = {{5, true, "mug"}, {6, true, "toaster"}};
    map_.resolution_m = 0.01F;
    mug_.key = mug_.model = "mug red";
    mug_.kind = "same object";
    mug_.id_before = 3;
    mug_.id_after = 5;
    mug_.X_SG_before = at(1, 0, 0) * turn(30);
    mug_.X_SG_after = at(0, 0, 2);
    objects_.objects = {mug_};
    write_model("mug_red", R"([1,0,0,1, 0,1,0,0, 0,0,1,0])");
  }

  static Pose turn(double degrees) {
    return Pose(Eigen::AngleAxisd(degrees * std::numbers::pi / 180.0, Eigen::Vector3d::UnitZ()));
  }

  void add(std::uint32_t instance, std::uint32_t segment, const Pose& X_WO, std::uint8_t red) {
    for (const CloudPoint& p : transformed(X_WO, plate(red))) {
      truth_.points_W.push_back(p);
      truth_.instance_ids.push_back(instance);
      map_.points_W.push_back(p);
      map_.segment_ids.push_back(segment);
    }
  }

  void write_model(const std::string& name, const std::string& pose) const {
    fs::create_directories(folder_ / name);
    PlyWriter writer(folder_ / name / "model.ply",
                     {{.name = "vertex",
                       .properties = {"float x", "float y", "float z", "float nx", "float ny",
                                      "float nz", "uchar red", "uchar green", "uchar blue"},
                       .count = std::int64_t{kSide} * kSide}});
    for (const CloudPoint& p : plate(200)) {
      writer.append(0, p.x, p.y, p.z, p.nx, p.ny, p.nz, p.red, p.green, p.blue);
    }
    writer.commit();
    const std::string lesson = pose.empty() ? "{}" : R"({"X_WO":)" + pose + "}";
    std::ofstream(folder_ / name / "object.json") << R"({"lessons":[)" << lesson << "]}";
  }

  ToldDetection told(std::int64_t id, const Pose& X_WO) const {
    return {.id = id,
            .name = "mug_red",
            .X_WO = X_WO,
            .box_O = {Eigen::Vector3d(-0.12, -0.12, 0), Eigen::Vector3d(0.12, 0.12, 0)},
            .points = 600,
            .score = 0.75};
  }

  ObjectScores score(const std::vector<ToldDetection>& told) const {
    ObjectScores scores = score_detections(told, objects_, truth_, {"mug_red"}, folder_.path());
    explain(told, truth_, map_, folder_.path(), scores);
    return scores;
  }

  kintsugi::testing::TemporaryFolder folder_;
  Truth truth_;
  LabelledPoints map_;
  TrueObject mug_;
  TrueObjects objects_;
};

TEST_F(DetectionReport, ThePoseErrorIsAgainstThePoseInWhichItWasTaught) {
  // Taught with the axes of the map, while it was turned by 30 degrees: now it is not turned, so
  // that the true pose of the model is turned back.
  const ObjectScores right = score({told(1, at(0.01, 0, 2) * turn(-30))});
  ASSERT_TRUE(right.truth[0].error);
  EXPECT_NEAR(right.truth[0].error->rotation_deg, 0, 1e-6);
  EXPECT_NEAR(right.truth[0].error->translation_m, 0.01, 1e-9);
  const ObjectScores turned = score({told(1, at(0, 0, 2))});
  EXPECT_NEAR(turned.truth[0].error->rotation_deg, 30, 1e-6);
  EXPECT_THAT(to_csv(truth_table(turned)), HasSubstr(",30.00,"));
}

TEST_F(DetectionReport, TheErrorIsModuloTheSymmetryOfTheObject) {
  mug_.symmetry.axes = {{Eigen::Vector3d::UnitZ(), 4}};
  objects_.objects = {mug_};
  EXPECT_NEAR(score({told(1, at(0, 0, 2) * turn(50))}).truth[0].error->rotation_deg, 10, 1e-6);
}

TEST_F(DetectionReport, ALibraryThatDoesNotTellThePoseGivesNoRotation) {
  write_model("mug_red", "");
  const ObjectScores scores = score({told(1, at(0.01, 0, 2))});
  EXPECT_TRUE(std::isnan(scores.truth[0].error->rotation_deg));
  EXPECT_NEAR(scores.truth[0].error->translation_m, 0.01, 1e-9);
  EXPECT_THAT(to_csv(truth_table(scores)), AllOf(HasSubstr(",1.00,,"), Not(HasSubstr("nan"))));
}

TEST_F(DetectionReport, SaysWhatIsWhereAFalseDetectionIs) {
  const ObjectScores scores = score({told(7, at(1, 0, 2))});
  EXPECT_EQ(scores.claims[0].reason,
            "no such object there; 100 % of its surface lie on the map, most of it on toaster #6");
  const ObjectScores half = score({told(7, at(1.125, 0, 2))});
  EXPECT_THAT(half.claims[0].reason, HasSubstr("56 % of its surface"));
}

TEST_F(DetectionReport, SaysWhyAnObjectWasMissed) {
  // The model is a square that is turned on the one in the map: its corners are not there.
  EXPECT_EQ(score({}).truth[0].reason,
            "segmented out, not told; segment 1 is most like it, IoU 1.00; 90 % of the model are "
            "in the map");
  std::ranges::fill(map_.segment_ids, 2);  // one with the toaster
  EXPECT_THAT(score({}).truth[0].reason,
              AllOf(HasSubstr("segmented out"), HasSubstr("segment 2"), HasSubstr("IoU 0.50")));
  for (std::size_t i = 0; i < 400; ++i) map_.segment_ids[i] = 3;
  std::fill(map_.segment_ids.begin() + 200, map_.segment_ids.begin() + 625, 4);
  EXPECT_THAT(score({}).truth[0].reason, HasSubstr("segment 4 is most like it, IoU 0.68"));
  std::fill(map_.segment_ids.begin(), map_.segment_ids.begin() + 300, 2);
  std::fill(map_.segment_ids.begin() + 300, map_.segment_ids.begin() + 450, 3);
  EXPECT_THAT(score({}).truth[0].reason, HasSubstr("no segment is the object"));
}

TEST_F(DetectionReport, SaysWhatWasToldInItsPlace) {
  write_model("globe", "");
  ToldDetection globe = told(4, at(0.02, 0, 2));
  globe.name = "globe";
  EXPECT_THAT(score({globe}).truth[0].reason, HasSubstr("told there: globe (4)"));
}

TEST_F(DetectionReport, APictureOfEachFalseAndEachMissedOne) {
  const fs::path out = folder_ / "out";
  const std::vector<ToldDetection> told_there = {told(7, at(1, 0, 2))};
  const ObjectScores scores = score(told_there);
  const auto pictures =
      write_detection_pictures(told_there, scores, map_, truth_, folder_.path(), out);
  ASSERT_EQ(pictures.size(), 2U);
  EXPECT_EQ(pictures[0].file, "false_7.png");
  EXPECT_THAT(pictures[0].caption, AllOf(HasSubstr("mug_red (7), score 0.75"), HasSubstr("#6")));
  EXPECT_EQ(pictures[1].file, "missed_5.png");
  // The map, the model and the segments, side by side.
  const cv::Mat3b picture = cv::imread((out / "false_7.png").string());
  ASSERT_EQ(picture.cols, 3 * 480);
  const cv::Vec3b& map_color = picture(picture.rows / 2, 240);
  const cv::Vec3b& model_color = picture(picture.rows / 2, 720);
  EXPECT_LT(map_color[2], 60);     // the toaster
  EXPECT_GT(model_color[2], 120);  // the mug
  EXPECT_EQ(picture(30, 250), cv::Vec3b(255, 255, 255));
  std::ostringstream page;
  page << std::ifstream(out / "pictures.html").rdbuf();
  EXPECT_THAT(page.str(), AllOf(HasSubstr("toaster #6"), HasSubstr("IoU 1.00")));

  const std::vector<ToldDetection> right = {told(1, at(0, 0, 2))};
  write_detection_pictures(right, score(right), map_, truth_, folder_.path(), out);
  EXPECT_FALSE(fs::exists(out / "false_7.png"));  // of the earlier call
  EXPECT_FALSE(fs::exists(out / "missed_5.png"));
}

TEST_F(DetectionReport, AMapWithoutLabelsIsNamed) {
  const auto error = [](const fs::path& path) -> std::string {
    try {
      read_labelled_cloud(path);
      return "";
    } catch (const std::runtime_error& error) {
      return error.what();
    }
  };
  EXPECT_THAT(error(folder_ / "mug_red" / "model.ply"),
              AllOf(HasSubstr("model.ply"), HasSubstr("no points with segment_id")));
  EXPECT_THAT(error(folder_ / "none.ply"), HasSubstr("none.ply"));
  LabelledPlyWriter writer(folder_ / "map.ply", std::ssize(map_.points_W), {});
  for (std::size_t i = 0; i < map_.points_W.size(); ++i) {
    writer.append(map_.points_W[i], map_.segment_ids[i], 0);
  }
  writer.commit();
  const LabelledPoints read = read_labelled_cloud(folder_ / "map.ply");
  EXPECT_EQ(read.segment_ids, map_.segment_ids);
  EXPECT_NEAR(read.resolution_m, 0.01, 0.002);
}

}  // namespace
}  // namespace kintsugi::segmenter
