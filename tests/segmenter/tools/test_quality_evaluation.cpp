// Sets of parameters scored over one session, and kintsugi-evaluate --ground-truth as a program.

#include <fstream>
#include <iomanip>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segmenter/core/parameters/presets.hpp"
#include "segmenter/evaluation/quality/quality_evaluation.hpp"
#include "segmenter/evaluation/quality/quality_plots.hpp"
#include "segmenter/evaluation/quality/quality_tables.hpp"
#include "tests/segmenter/core/random_clouds.hpp"
#include "tests/segmenter/tools/evaluate_program.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::AllOf;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;

constexpr float kResolution_m = 0.01F;
constexpr int kSide = 20;  // points along an edge of a sheet

/// Two sheets of 400 points, a floor and a wall beside it; far apart from them a box top.
struct Room {
  RecordedSession session;
  Truth truth;
};

void add_sheet(double x_m, bool is_upright, std::uint32_t instance, CloudSlice& slice,
               Truth& truth) {
  for (int i = 0; i < kSide * kSide; ++i) {
    const double u = kResolution_m * (i % kSide);
    const int row = i / kSide;
    const double v = kResolution_m * (row + 1);
    slice.points_W.push_back(is_upright ? testing::make_point(x_m, u, v, 1, 0, 0)
                                        : testing::make_point(x_m + v, u, 0, 0, 0, 1));
    truth.points_W.push_back(slice.points_W.back());
    truth.instance_ids.push_back(instance);
  }
}

Room make_room() {
  Room room;
  room.session.source = "room.lcm";
  for (int i = 0; i < 2; ++i) {
    room.session.steps.emplace_back().slices.emplace_back();
    room.session.steps.back().slices[0].id = i;
    room.session.steps.back().slices[0].resolution_m = kResolution_m;
  }
  room.session.num_slices = 2;
  add_sheet(0.0, false, 5, room.session.steps[0].slices[0], room.truth);
  add_sheet(0.0, true, 6, room.session.steps[1].slices[0], room.truth);
  add_sheet(1.0, false, 7, room.session.steps[1].slices[0], room.truth);
  room.truth.instances = {{5, false, "floor"}, {6, false, "wall"}, {7, true, "box"}};
  return room;
}

TEST(QualityEvaluation, ScoresAMapWhoseSheetsComeOutWhole) {
  const Room room = make_room();
  QualityEvaluationConfig config;
  config.presets = {"paper"};
  const auto evaluation = evaluate_quality(room.session, room.truth, config);
  EXPECT_EQ(evaluation.num_points, 1200);
  ASSERT_THAT(evaluation.presets, SizeIs(1));
  const SegmentationQuality& quality = evaluation.presets[0].quality;
  EXPECT_EQ(quality.num_segments, 3);
  EXPECT_EQ(quality.object_iou, 1.0);
  EXPECT_EQ(quality.num_objects, 1);
  EXPECT_EQ(quality.num_instances, 3);
  EXPECT_EQ(quality.boundary.recall, 1.0);
  EXPECT_EQ(quality.boundary.precision, 1.0);
  // The row of the floor beside the wall, and the wall's first two.
  EXPECT_EQ(quality.boundary.num_true, 2 * kSide);
}

TEST(QualityEvaluation, ScoresGivenLabelsByPointWhateverIsRejected) {
  Room room = make_room();
  CloudSlice& second = room.session.steps[1].slices[0];
  second.points_W[1].nx = 0.0F;  // a normal of no length: rejected
  const std::size_t num_second = second.points_W.size();
  room.session.segment_ids = {std::vector<std::uint32_t>(400, 1),
                              std::vector<std::uint32_t>(num_second, 2)};
  room.session.segment_ids[1][0] = 9;
  room.session.segment_ids[1][1] = 9;
  QualityEvaluationConfig config;
  config.presets = {"labels"};
  const auto evaluation = evaluate_quality(room.session, room.truth, config);
  EXPECT_EQ(evaluation.num_rejected, 1);
  const SegmentationQuality& quality = evaluation.presets[0].quality;
  EXPECT_EQ(quality.num_segments, 3);
  ASSERT_THAT(quality.instances, SizeIs(3));
  EXPECT_EQ(quality.instances[0].best_iou, 1.0);
  EXPECT_EQ(quality.instances[1].num_points, 399);
  EXPECT_DOUBLE_EQ(quality.instances[1].best_iou, 398.0 / 799.0);  // of label 2: wall and box
  EXPECT_DOUBLE_EQ(quality.object_iou, 400.0 / 798.0);
}

TEST(QualityEvaluation, SweepsOneParameterAtATime) {
  const EngineConfig base = preset("objects");
  std::set<std::string> names;
  for (const QualityVariant& variant : sweep_around(base)) {
    EXPECT_TRUE(names.insert(variant.name).second) << variant.name;
    EXPECT_NE(variant.factor, 1.0);
    for (const SweptParameter& parameter : swept_parameters()) {
      const double factor = parameter.name == variant.parameter ? variant.factor : 1.0;
      EXPECT_EQ(variant.engine.*parameter.value, factor * (base.*parameter.value)) << variant.name;
    }
    EXPECT_NO_THROW(variant.engine.validate()) << variant.name;
  }
  EXPECT_TRUE(names.contains("color_weight x 0"));
}

TEST(QualityEvaluation, TablesAndFiguresHoldEveryResult) {
  const Room room = make_room();
  QualityEvaluationConfig config;
  config.sweep = true;
  std::vector<std::string> told;
  const auto evaluation = evaluate_quality(
      room.session, room.truth, config, [&](const QualityResult& result, std::size_t num_results) {
        told.push_back(result.variant.name);
        EXPECT_EQ(num_results, 2 + sweep_around({}).size());
      });
  EXPECT_EQ(told.size(), 2 + sweep_around({}).size());
  const Table table = quality_table(evaluation);
  EXPECT_THAT(table.rows, AllOf(SizeIs(told.size()), Each(SizeIs(table.header.size()))));
  EXPECT_THAT(instance_table(evaluation).rows,
              ElementsAre(AllOf(SizeIs(6), ::testing::Contains("floor")), SizeIs(6), SizeIs(6)));
  const Table readable = readable_quality(evaluation.sweep);
  EXPECT_THAT(readable.rows,
              AllOf(SizeIs(sweep_around({}).size()), Each(SizeIs(readable.header.size()))));
  EXPECT_EQ(readable_instances(evaluation).rows[2][0], "box");  // structure first
  const auto figures = quality_figures(evaluation);
  ASSERT_THAT(figures, SizeIs(4));
  EXPECT_THAT(figures[0].plot.series, SizeIs(2));
  for (std::size_t i = 1; i < figures.size(); ++i) {
    EXPECT_THAT(figures[i].plot.series, SizeIs(swept_parameters().size()));
    EXPECT_THAT(to_gnuplot(figures[i].plot), HasSubstr("set logscale x"));
  }
}

TEST(QualityEvaluation, NamesWhatIsWrong) {
  Room room = make_room();
  const auto evaluate_with = [&](const std::vector<std::string>& presets) {
    return [&room, presets] {
      QualityEvaluationConfig config;
      config.presets = presets;
      evaluate_quality(room.session, room.truth, config);
    };
  };
  const auto fails_with = [](const std::string& what) {
    return ThrowsMessage<std::invalid_argument>(HasSubstr(what));
  };
  EXPECT_THAT(evaluate_with({}), fails_with("presets is empty"));
  EXPECT_THAT(evaluate_with({"cups"}), fails_with("preset is 'cups'"));
  EXPECT_THAT(evaluate_with({"paper", "paper"}), fails_with("'paper' twice"));
  EXPECT_THAT(evaluate_with({"labels"}), fails_with("room.lcm has no segment_id"));
  QualityEvaluationConfig config;
  config.match_distance_vox = 0.0;
  EXPECT_THAT([&] { config.validate(); }, fails_with("match_distance_vox is 0"));
  config = {};
  config.boundary_tolerance_vox = 2.0;
  EXPECT_THAT([&] { config.validate(); }, fails_with("tolerance_m is 2"));
  for (CloudPoint& point : room.truth.points_W) point.z += 10.0F;
  EXPECT_THAT(evaluate_with({"paper"}),
              ThrowsMessage<std::runtime_error>(HasSubstr("within reach of the truth")));
}

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
