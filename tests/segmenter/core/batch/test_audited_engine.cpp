#include <memory>

#include <gmock/gmock.h>

#include "segmenter/core/batch/audited_engine.hpp"
#include "segmenter/core/make_engine.hpp"
#include "tests/fuzz/faulty_engine.hpp"
#include "tests/fuzz/run_scenario.hpp"
#include "tests/segmenter/core/random_clouds.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// A map of four slices, corrected and shortened at the end.
void segment_session(PointCloud& cloud, SegmentationEngine& engine) {
  const auto points = testing::random_cloud(testing::CloudShape::kWaves, 800, 3);
  for (int slice = 0; slice < 4; ++slice) {
    cloud.add_slice(slice, std::span(points).subspan(static_cast<std::size_t>(slice) * 200, 200));
    engine.update(cloud.take_change());
  }
  cloud.replace_slice(1, std::span(points).first(150));
  engine.update(cloud.take_change());
  cloud.replace_slice(2, {});
  engine.update(cloud.take_change());
}

TEST(AuditedEngine, LetsExactPass) {
  for (const double min_points : {0.0, 20.0}) {
    PointCloud cloud;
    const auto engine = make_engine("exact", cloud, {.min_points = min_points, .audit = true});
    EXPECT_NO_THROW(segment_session(cloud, *engine));
    EXPECT_EQ(engine->components().size(), cloud.size());
    EXPECT_EQ(
        canonical_labels(engine->components()) == canonical_labels(engine->unmerged_components()),
        min_points == 0.0);
  }
}

TEST(AuditedEngine, StopsWithTheFirstDifference) {
  for (const fuzz::Fault fault : {fuzz::Fault::kWrongLabel, fuzz::Fault::kWrongTheta}) {
    PointCloud cloud;
    const EngineConfig config;
    AuditedEngine engine(fuzz::faulty(fuzz::engine_factory("exact"), fault, 2)(cloud, config),
                         cloud, config);
    EXPECT_THAT([&] { segment_session(cloud, engine); },
                ThrowsMessage<AuditError>(AllOf(HasSubstr("after update 3"), HasSubstr("point "),
                                                HasSubstr("of slice "), HasSubstr("theta "),
                                                HasSubstr("with batch it is"))));
  }
}

// The partition below the fragment layer is right.
TEST(AuditedEngine, StopsWhenAFragmentIsJoinedWrongly) {
  PointCloud cloud;
  const EngineConfig config{.min_points = 20};
  AuditedEngine engine(
      fuzz::faulty(fuzz::engine_factory("exact"), fuzz::Fault::kWrongLabel, 2)(cloud, config),
      cloud, config);
  EXPECT_THAT([&] { segment_session(cloud, engine); },
              ThrowsMessage<AuditError>(HasSubstr("after update 3")));
}

TEST(AuditedEngine, IsForExactOnly) {
  const PointCloud cloud;
  EXPECT_THAT([&] { make_engine("voting", cloud, {.audit = true}); },
              ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr("voting"), HasSubstr("exact"))));
}

}  // namespace
}  // namespace kintsugi::segmenter
