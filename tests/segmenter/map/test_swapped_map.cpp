// A map whose memory goes to disk: it is the same map.

#include <random>

#include <gtest/gtest.h>

#include "lcmtypes/base/swap_space.hpp"
#include "segmenter/core/parameters/presets.hpp"
#include "segmenter/map/segment_map.hpp"
#include "tests/segmenter/process/slice_session.hpp"
#include "tests/support/message_equality.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter {
namespace {

using testing::wavy_session;

class SwappedMap : public ::testing::TestWithParam<std::string> {
 protected:
  SegmentMapConfig config() const {
    SegmentMapConfig config;
    config.mode = GetParam();
    config.engine = preset("objects");
    return config;
  }
  /// Puts all that may go to disk on disk.
  void trim_all() {
    for (int k = 0; k < 30; ++k) space_.trim();
  }
  /// Adds to both maps, which have to tell the same.
  void add(SegmentMap& map, SegmentMap& swapped, std::span<const CloudSlice> slices) {
    const auto expected = map.add(slices);
    EXPECT_TRUE(swapped.add(slices) == expected);
    trim_all();
  }

  kintsugi::testing::TemporaryFolder folder_{kintsugi::testing::kOnDisk};
  SwapSpace space_{{folder_.path(), 1}};  // the process always has more
};

TEST_P(SwappedMap, TellsTheSameAsOneInMemory) {
  const auto slices = wavy_session(12, 400);
  SegmentMap map(config(), 1, slices[0]);
  SegmentMap swapped(config(), 1, slices[0]);
  swapped.swap_to(space_);
  for (const CloudSlice& slice : slices) add(map, swapped, {&slice, 1});
  std::mt19937 random(3);  // NOLINT(*-msc51-cpp): the same in every run
  for (int revision = 1; revision < 8; ++revision) {
    CloudSlice slice = slices[random() % slices.size()];
    slice.revision = revision;
    for (CloudPoint& point : slice.points_W) point.z += 0.002F;
    slice.points_W.resize(slice.points_W.size() - 30);
    add(map, swapped, {&slice, 1});
  }
  EXPECT_EQ(testing::labels_of(swapped), testing::labels_of(map));
  EXPECT_EQ(swapped.statistics().all(), map.statistics().all());
  EXPECT_GT(space_.file_bytes(), 0U);
}

TEST_P(SwappedMap, GoesOnFromASavedOne) {
  const auto slices = wavy_session(6, 400);
  SegmentMap map(config(), 1, slices[0]);
  for (int k = 0; k < 4; ++k) map.add({&slices[static_cast<std::size_t>(k)], 1});
  SegmentMap swapped(map.state());
  swapped.swap_to(space_);
  trim_all();
  add(map, swapped, {&slices[4], 1});
  add(map, swapped, {&slices[5], 1});
  EXPECT_EQ(testing::labels_of(swapped), testing::labels_of(map));
}

INSTANTIATE_TEST_SUITE_P(Modes, SwappedMap, ::testing::Values("exact", "batch", "voting"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace kintsugi::segmenter
