#include <memory>

#include <gmock/gmock.h>

#include "segmenter/core/audited_engine.hpp"
#include "tests/fuzz/faulty_engine.hpp"
#include "tests/fuzz/run_scenario.hpp"
#include "tests/segmenter/random_clouds.hpp"

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
  cloud.remove_slice(2);
  engine.update(cloud.take_change());
}

TEST(AuditedEngine, LetsExactPass) {
  PointCloud cloud;
  const auto engine = make_engine("exact", cloud, {.audit = true});
  EXPECT_NO_THROW(segment_session(cloud, *engine));
  EXPECT_EQ(engine->components().size(), cloud.size());
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

TEST(AuditedEngine, IsForExactOnly) {
  const PointCloud cloud;
  EXPECT_THAT([&] { make_engine("voting", cloud, {.audit = true}); },
              ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr("voting"), HasSubstr("exact"))));
}

}  // namespace
}  // namespace kintsugi::segmenter
