// The map of one session: slices and corrections in, updates out.

#include <algorithm>
#include <map>
#include <random>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>

#include "segmenter/core/make_engine.hpp"
#include "segmenter/map/segment_map.hpp"
#include "tests/segmenter/process/slice_session.hpp"
#include "tests/support/message_equality.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::LabelMirror;
using ::testing::ThrowsMessage;
using testing::wavy_session;

SegmentMap make_map(std::string_view mode, const CloudSlice& first) {
  SegmentMapConfig config;
  config.mode = mode;
  return {config, 99, first};
}

/// The slice again, its points `shift_m` away in z.
CloudSlice moved(CloudSlice slice, float shift_m) {
  ++slice.revision;
  for (CloudPoint& point : slice.points_W) point.z += shift_m;
  return slice;
}

class SegmentMapTest : public ::testing::TestWithParam<std::string_view> {
 protected:
  /// Adds to the map and to what a listener knows; checks that the two agree.
  std::vector<SegmentUpdate> add(SegmentMap& map, std::span<const CloudSlice> slices) {
    std::vector<SegmentUpdate> updates = map.add(slices);
    for (const SegmentUpdate& update : updates) {
      mirror_.apply(update);
    }
    EXPECT_EQ(mirror_.labels(), testing::labels_of(map));
    EXPECT_EQ(mirror_.statistics(), map.statistics().all());
    EXPECT_EQ(mirror_.last_changes(), map.statistics().last_changes());
    EXPECT_EQ(mirror_.num_segments(), updates.back().num_segments);
    EXPECT_EQ(updates.back().num_points, map.cloud().num_live());
    return updates;
  }
  LabelMirror mirror_;
};

TEST_P(SegmentMapTest, CorrectionReplacesASlice) {
  auto slices = wavy_session(5, 300);
  SegmentMap map = make_map(GetParam(), slices[0]);
  for (const CloudSlice& slice : slices) add(map, {&slice, 1});

  CloudSlice correction = moved(slices[2], 0.005F);
  correction.revision = 4;
  correction.points_W[7].x = NAN;
  correction.points_W.resize(290);
  const auto updates = add(map, {&correction, 1});
  ASSERT_EQ(updates.size(), 1U);
  EXPECT_EQ(updates[0].slice_id, 2);
  EXPECT_EQ(updates[0].slice_revision, 4);
  EXPECT_EQ(updates[0].labels.size(), 290U);
  EXPECT_EQ(updates[0].labels[7], kNoSegment);
  EXPECT_EQ(updates[0].num_slices, 5);
  EXPECT_EQ(updates[0].num_points, 1489);
  EXPECT_TRUE(updates[0].is_final);
  for (const LabelRun& run : updates[0].runs) {
    EXPECT_NE(run.slice_id, 2);
    EXPECT_EQ(run.slice_revision, 0);
  }
}

TEST_P(SegmentMapTest, PointRejectedBeforeIsAcceptedInACorrection) {
  auto slices = wavy_session(2, 200);
  const CloudPoint good = slices[0].points_W[5];
  slices[0].points_W[5].nx = NAN;
  SegmentMap map = make_map(GetParam(), slices[0]);
  add(map, slices);
  EXPECT_EQ(map.cloud().num_rejected(), 1);
  slices[0].points_W[5] = good;
  slices[0].points_W[6].nx = NAN;
  ++slices[0].revision;
  const auto updates = add(map, {slices.data(), 1});
  EXPECT_NE(updates[0].labels[5], kNoSegment);
  EXPECT_EQ(updates[0].labels[6], kNoSegment);
  EXPECT_EQ(map.cloud().num_rejected(), 1);
}

TEST_P(SegmentMapTest, CorrectionThatChangesNothingTellsNothing) {
  auto slices = wavy_session(3, 200);
  SegmentMap map = make_map(GetParam(), slices[0]);
  add(map, slices);
  const auto before = testing::labels_of(map);
  ++slices[1].revision;
  const auto updates = add(map, {&slices[1], 1});
  if (GetParam() == "voting") return;  // it segments the points as if they were new
  EXPECT_EQ(testing::labels_of(map), before);
  EXPECT_THAT(updates[0].events, IsEmpty());
  EXPECT_THAT(updates[0].runs, IsEmpty());
}

TEST_P(SegmentMapTest, RefusesWhatIsNotNewer) {
  auto slices = wavy_session(2, 50);
  slices[0].revision = 3;
  SegmentMap map = make_map(GetParam(), slices[0]);
  map.add({slices.data(), 1});
  EXPECT_THAT([&] { map.add(slices); }, ThrowsMessage<std::invalid_argument>(
                                            HasSubstr("slice 0 of revision 3 is already in the")));
  slices[0].revision = 2;
  EXPECT_THAT([&] { map.add(slices); }, ThrowsMessage<std::invalid_argument>(HasSubstr("3")));
  EXPECT_EQ(map.cloud().slices().size(), 1U);
}

/// A third of the map moves at once, and back.
TEST_P(SegmentMapTest, GroupOfCorrectionsIsOneRunAndTheWayBackRestoresThePartition) {
  auto slices = wavy_session(9, 200);
  SegmentMap map = make_map(GetParam(), slices[0]);
  for (const CloudSlice& slice : slices) add(map, {&slice, 1});
  const auto before = testing::labels_of(map);

  std::vector<CloudSlice> third;
  for (int i = 3; i < 6; ++i) third.push_back(moved(slices[i], 0.03F));
  const auto updates = add(map, third);
  EXPECT_EQ(updates.size(), 3U);
  EXPECT_NE(testing::labels_of(map), before);
  if (GetParam() != "voting") {
    SegmentMap anew = make_map(GetParam(), slices[0]);
    auto all = slices;
    std::copy(third.begin(), third.end(), all.begin() + 3);
    anew.add(all);
    EXPECT_TRUE(testing::same_partition(testing::labels_of(map), testing::labels_of(anew)));
  }

  for (int i = 0; i < 3; ++i) {
    third[i].points_W = slices[3 + i].points_W;
    ++third[i].revision;
  }
  add(map, third);
  if (GetParam() != "voting") {
    EXPECT_TRUE(testing::same_partition(testing::labels_of(map), before));
  }
  EXPECT_EQ(map.cloud().num_live(), 1800U);
  EXPECT_LE(map.cloud().size(), 2400U);  // the places of the first third were used again
}

TEST_P(SegmentMapTest, RandomCorrectionsReplayToTheMap) {
  std::mt19937 random(3);
  auto slices = wavy_session(8, 120);
  SegmentMap map = make_map(GetParam(), slices[0]);
  for (int step = 0; step < 40; ++step) {
    std::map<std::int32_t, CloudSlice> group;
    for (unsigned k = 1 + random() % 3; k > 0; --k) {
      const CloudSlice& slice = slices[random() % slices.size()];
      CloudSlice next = moved(slice, 0.01F * static_cast<float>(random() % 3));
      next.revision = step + 1;
      for (CloudPoint& point : next.points_W) {
        if (random() % 20 == 0) point.x = NAN;
      }
      group.insert_or_assign(slice.id, next);
    }
    std::vector<CloudSlice> given;
    given.reserve(group.size());
    for (const auto& [id, slice] : group) given.push_back(slice);
    std::shuffle(given.begin(), given.end(), random);
    add(map, given);
  }
}

/// The partition is the same, so is what becomes of the ids: whatever the engine calls components.
TEST(SegmentMap, ModesExactAndBatchTellTheSame) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const auto slices = wavy_session(10, 250, 5, seed);
    SegmentMap exact = make_map("exact", slices[0]);
    SegmentMap batch = make_map("batch", slices[0]);
    std::mt19937 random(seed);
    const auto expect_same = [&](std::span<const CloudSlice> group) {
      EXPECT_EQ(exact.add(group), batch.add(group));
    };
    for (const CloudSlice& slice : slices) expect_same({&slice, 1});
    std::size_t num_events = 0;
    for (int step = 1; step < 12; ++step) {
      std::vector<CloudSlice> group;
      const auto num_slices = 1 + random() % 4;
      for (auto i = random() % 6; group.size() < num_slices; ++i) {
        group.push_back(moved(slices[i], 0.004F * static_cast<float>(random() % 4)));
        group.back().revision = step;
        if (random() % 5 == 0) group.back().points_W.resize(100);
      }
      const auto updates = batch.add(group);
      num_events += updates.back().events.size();
      EXPECT_EQ(exact.add(group), updates) << "seed " << seed << " step " << step;
    }
    EXPECT_GT(num_events, 100U);
  }
}

INSTANTIATE_TEST_SUITE_P(Modes, SegmentMapTest,
                         ::testing::ValuesIn(engine_modes().begin(), engine_modes().end()));

}  // namespace
}  // namespace kintsugi::segmenter
