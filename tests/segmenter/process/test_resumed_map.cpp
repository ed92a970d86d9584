// Under which parameters a saved map may be continued.

#include <stdexcept>
#include <string>

#include <gmock/gmock.h>

#include "segmenter/io/saved_map.hpp"
#include "segmenter/process/resumed_map.hpp"
#include "tests/segmenter/changed_parameters.hpp"
#include "tests/segmenter/process/slice_session.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class ResumedMap : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto slices = testing::wavy_session(2, 50);
    SegmentMap map({}, 1, slices[0]);
    map.add(slices);
    write_map_state(map.state(), file_);
  }

  kintsugi::testing::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "map.kseg";
};

TEST_F(ResumedMap, HasTheParametersItWasSavedWith) {
  for (const auto& [parameter, engine] : testing::changed_parameters()) {
    SegmentMapConfig config;
    config.engine = engine;
    const auto resume = [&] { resume_map(file_, config, "", 2); };
    if (parameter.comes_with_slices) {
      EXPECT_NO_THROW(resume()) << parameter.name;
    } else {
      EXPECT_THAT(resume, ThrowsMessage<std::runtime_error>(
                              HasSubstr("was saved with " + option_name(parameter))));
    }
  }
}

TEST_F(ResumedMap, HasTheModeItWasSavedWith) {
  SegmentMapConfig config;
  config.mode = "batch";
  EXPECT_THAT([&] { resume_map(file_, config, "", 2); },
              ThrowsMessage<std::runtime_error>(HasSubstr("was saved with --mode exact")));
}

TEST_F(ResumedMap, MayDifferInWhatDecidesOnTimeAlone) {
  SegmentMapConfig config;
  config.engine.neighbour_search = NeighbourSearch::kFlann;
  config.engine.rebuild_share = 0.0;
  EXPECT_EQ(resume_map(file_, config, "", 2)->config().engine.neighbour_search,
            NeighbourSearch::kFlann);
}

// Else all slices would be those of another map, and the file would stay as it is without a word.
TEST_F(ResumedMap, HasTheNameThatIsWanted) {
  const std::string name = read_map_state(file_).map_name;
  EXPECT_EQ(resume_map(file_, {}, name, 2)->map_name(), name);
  EXPECT_THAT([&] { resume_map(file_, {}, "hall", 2); },
              ThrowsMessage<std::runtime_error>(HasSubstr("and --map-name is 'hall'")));
}

}  // namespace
}  // namespace kintsugi::segmenter
