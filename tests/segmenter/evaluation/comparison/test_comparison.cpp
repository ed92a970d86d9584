// The quality of segmentations with different parameters, over one session.

#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segmenter/core/parameters/presets.hpp"
#include "segmenter/evaluation/comparison/comparison.hpp"
#include "segmenter/evaluation/comparison/comparison_plots.hpp"
#include "segmenter/evaluation/comparison/comparison_tables.hpp"
#include "tests/segmenter/evaluation/comparison/room_with_truth.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::AllOf;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::kSide;
using testing::make_room;
using testing::Room;
using ::testing::SizeIs;
using ::testing::ThrowsMessage;

TEST(Comparison, ScoresAMapWhoseSheetsComeOutWhole) {
  const Room room = make_room();
  ComparisonConfig config;
  config.presets = {"paper"};
  const auto comparison = compare_parameters(room.session, room.truth, config);
  EXPECT_EQ(comparison.num_points, 1200);
  ASSERT_THAT(comparison.presets, SizeIs(1));
  const SegmentationQuality& quality = comparison.presets[0].quality;
  EXPECT_EQ(quality.num_segments, 3);
  EXPECT_EQ(quality.object_iou, 1.0);
  EXPECT_EQ(quality.num_objects, 1);
  EXPECT_EQ(quality.num_instances, 3);
  EXPECT_EQ(quality.boundary.recall, 1.0);
  EXPECT_EQ(quality.boundary.precision, 1.0);
  // The row of the floor beside the wall, and the wall's first two.
  EXPECT_EQ(quality.boundary.num_true, 2 * kSide);
}

TEST(Comparison, ScoresGivenLabelsByPointWhateverIsRejected) {
  Room room = make_room();
  CloudSlice& second = room.session.steps[1].slices[0];
  second.points_W[1].nx = 0.0F;  // a normal of no length: rejected
  const std::size_t num_second = second.points_W.size();
  room.session.segment_ids = {std::vector<std::uint32_t>(400, 1),
                              std::vector<std::uint32_t>(num_second, 2)};
  room.session.segment_ids[1][0] = 9;
  room.session.segment_ids[1][1] = 9;
  ComparisonConfig config;
  config.presets = {"labels"};
  const auto comparison = compare_parameters(room.session, room.truth, config);
  EXPECT_EQ(comparison.num_rejected, 1);
  const SegmentationQuality& quality = comparison.presets[0].quality;
  EXPECT_EQ(quality.num_segments, 3);
  ASSERT_THAT(quality.instances, SizeIs(3));
  EXPECT_EQ(quality.instances[0].best_iou, 1.0);
  EXPECT_EQ(quality.instances[1].num_points, 399);
  EXPECT_DOUBLE_EQ(quality.instances[1].best_iou, 398.0 / 799.0);  // of label 2: wall and box
  EXPECT_DOUBLE_EQ(quality.object_iou, 400.0 / 798.0);
}

TEST(Comparison, SweepsOneParameterAtATime) {
  const EngineConfig base = preset("objects");
  std::set<std::string> names;
  for (const ParameterSet& variant : sweep_around(base)) {
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

TEST(Comparison, TablesAndFiguresHoldEveryResult) {
  const Room room = make_room();
  ComparisonConfig config;
  config.sweep = true;
  std::vector<std::string> told;
  const auto comparison = compare_parameters(
      room.session, room.truth, config, [&](const ComparedResult& result, std::size_t num_results) {
        told.push_back(result.variant.name);
        EXPECT_EQ(num_results, 2 + sweep_around({}).size());
      });
  EXPECT_EQ(told.size(), 2 + sweep_around({}).size());
  const Table table = quality_table(comparison);
  EXPECT_THAT(table.rows, AllOf(SizeIs(told.size()), Each(SizeIs(table.header.size()))));
  EXPECT_THAT(instance_table(comparison).rows,
              ElementsAre(AllOf(SizeIs(6), ::testing::Contains("floor")), SizeIs(6), SizeIs(6)));
  const Table readable = readable_quality(comparison.sweep);
  EXPECT_THAT(readable.rows,
              AllOf(SizeIs(sweep_around({}).size()), Each(SizeIs(readable.header.size()))));
  EXPECT_EQ(readable_instances(comparison).rows[2][0], "box");  // structure first
  const auto figures = quality_figures(comparison);
  ASSERT_THAT(figures, SizeIs(4));
  EXPECT_THAT(figures[0].plot.series, SizeIs(2));
  for (std::size_t i = 1; i < figures.size(); ++i) {
    EXPECT_THAT(figures[i].plot.series, SizeIs(swept_parameters().size()));
    EXPECT_THAT(to_gnuplot(figures[i].plot), HasSubstr("set logscale x"));
  }
}

TEST(Comparison, NamesWhatIsWrong) {
  Room room = make_room();
  const auto compare_with = [&](const std::vector<std::string>& presets) {
    return [&room, presets] {
      ComparisonConfig config;
      config.presets = presets;
      compare_parameters(room.session, room.truth, config);
    };
  };
  const auto fails_with = [](const std::string& what) {
    return ThrowsMessage<std::invalid_argument>(HasSubstr(what));
  };
  EXPECT_THAT(compare_with({}), fails_with("presets is empty"));
  EXPECT_THAT(compare_with({"cups"}), fails_with("preset is 'cups'"));
  EXPECT_THAT(compare_with({"paper", "paper"}), fails_with("'paper' twice"));
  EXPECT_THAT(compare_with({"labels"}), fails_with("room.lcm has no segment_id"));
  ComparisonConfig config;
  config.match_distance_vox = 0.0;
  EXPECT_THAT([&] { config.validate(); }, fails_with("match_distance_vox is 0"));
  config = {};
  config.boundary_tolerance_vox = 2.0;
  EXPECT_THAT([&] { config.validate(); }, fails_with("tolerance_m is 2"));
  for (CloudPoint& point : room.truth.points_W) point.z += 10.0F;
  EXPECT_THAT(compare_with({"paper"}),
              ThrowsMessage<std::runtime_error>(HasSubstr("within reach of the truth")));
}

}  // namespace
}  // namespace kintsugi::segmenter
