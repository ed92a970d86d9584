// What a client's SegmentTable makes of the updates of a real map: new slices, corrections, losses.

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "lcmtypes/client/segment_table.hpp"
#include "segmenter/map/segment_map.hpp"
#include "tests/segmenter/process/slice_session.hpp"

namespace kintsugi::segmenter {
namespace {

using testing::wavy_session;

std::vector<SegmentStatistics> statistics_in(const SegmentTable& table) {
  std::vector<SegmentStatistics> all;
  for (const auto& [id, segment] : table.segments()) all.push_back(segment.statistics);
  return all;
}

/// A map, and clients that know of it only what it says.
class ClientTableTest : public ::testing::TestWithParam<std::string_view> {
 protected:
  static constexpr int kSlices = 12;

  static SegmentMapConfig config() {
    SegmentMapConfig config;
    config.mode = GetParam();
    config.engine.threshold = 0.01;  // small segments: much happens to them
    return config;
  }

  void add(std::span<const CloudSlice> slices) { tell(map_.add(slices)); }

  /// To who listens; `forgetful_` misses every third update.
  void tell(std::vector<SegmentUpdate> updates) {
    for (SegmentUpdate& update : updates) {
      update.sequence = next_sequence_++;
      table_.apply(update);
      if (update.sequence % 3 != 0) forgetful_.apply(update);
      for (const SegmentEvent& event : update.events) {
        ++num_events_.at(static_cast<std::size_t>(event.type));
      }
    }
  }

  /// A random slice that is there, at a random distance from where it first was.
  CloudSlice some_correction() {
    CloudSlice& slice =
        slices_.at(std::uniform_int_distribution<std::size_t>(0, kSlices - 1)(random_));
    ++slice.revision;
    CloudSlice moved = slice;
    const float shift_m = std::uniform_real_distribution<float>(-0.03F, 0.03F)(random_);
    for (CloudPoint& point : moved.points_W) point.z += shift_m;
    moved.points_W.resize(std::uniform_int_distribution<std::size_t>(0, 200)(random_));
    return moved;
  }

  std::mt19937 random_{3};
  std::vector<CloudSlice> slices_ = wavy_session(kSlices, 200);
  SegmentMap map_{config(), 99, slices_.front()};
  SegmentTable table_;
  SegmentTable forgetful_;
  std::int64_t next_sequence_ = 0;
  std::array<int, 5> num_events_{};
};

TEST_P(ClientTableTest, IsThatOfTheMapAfterEachUpdate) {
  for (const CloudSlice& slice : slices_) {
    add({&slice, 1});
    ASSERT_EQ(statistics_in(table_), map_.statistics().all()) << "slice " << slice.id;
    ASSERT_TRUE(table_.has_all_segments());
  }
  for (int i = 0; i < 30; ++i) {
    const CloudSlice correction = some_correction();
    add({&correction, 1});
    ASSERT_EQ(statistics_in(table_), map_.statistics().all()) << "correction " << i;
    ASSERT_TRUE(table_.has_all_segments());
  }
  for (const int count : num_events_) EXPECT_GT(count, 0) << "an event of one type never came";
}

TEST_P(ClientTableTest, IsRightAfterAFullStateWhateverWasMissed) {
  add(slices_);
  for (int i = 0; i < 30; ++i) {
    const CloudSlice correction = some_correction();
    add({&correction, 1});
  }
  SegmentTable late;
  for (SegmentUpdate& update : map_.describe()) {
    update.sequence = next_sequence_++;
    late.apply(update);
    forgetful_.apply(update);
  }
  EXPECT_EQ(statistics_in(late), map_.statistics().all());
  EXPECT_EQ(statistics_in(forgetful_), map_.statistics().all());
  EXPECT_TRUE(late.is_final());
}

INSTANTIATE_TEST_SUITE_P(Modes, ClientTableTest, ::testing::Values("exact", "voting", "batch"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace kintsugi::segmenter
