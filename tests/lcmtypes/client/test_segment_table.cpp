#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "lcmtypes/client/segment_table.hpp"

namespace kintsugi {
namespace {

constexpr std::int64_t kSession = 50;
constexpr std::int64_t kMapSession = 7;

using Statistics = std::map<std::uint32_t, SegmentStatistics>;

/// A map whose segments are created, grow, shrink, merge, split and are retired at random, several
/// in one step; and the updates that a segmenter publishes of it.
class World {
 public:
  explicit World(unsigned seed) : random_(seed) {}

  SegmentUpdate step() {
    SegmentUpdate update = begin();
    std::vector<std::uint32_t> untouched;
    for (const auto& [id, statistics] : segments_) untouched.push_back(id);
    std::shuffle(untouched.begin(), untouched.end(), random_);
    const auto take = [&] {
      const std::uint32_t id = untouched.back();
      untouched.pop_back();
      return id;
    };
    std::vector<std::uint32_t> changed;
    for (int left = 1 + pick(6); left > 0; --left) {
      const int what = pick(7);
      if (what > 4 || untouched.size() < 2) {
        const std::uint32_t id = next_id_++;
        update.events.push_back({SegmentEventType::kCreated, id, 0});
        parents_[id] = kNoSegment;
        changed.push_back(id);
      } else if (what == 0) {
        const std::uint32_t id = take();
        update.events.push_back({SegmentEventType::kGrown, id, 0});
        changed.push_back(id);
      } else if (what == 1) {
        changed.push_back(take());  // lost some points, for which there is no event
      } else if (what == 2) {
        const std::uint32_t heir = take();
        const std::uint32_t gone = take();
        update.events.push_back({SegmentEventType::kMerged, heir, gone});
        end(gone, heir);
        changed.push_back(heir);
      } else if (what == 3) {
        const std::uint32_t parent = take();
        const std::uint32_t id = next_id_++;
        update.events.push_back({SegmentEventType::kSplit, parent, id});
        parents_[id] = parent;
        changed.push_back(parent);
        changed.push_back(id);
      } else {
        const std::uint32_t id = take();
        update.events.push_back({SegmentEventType::kRetired, id, 0});
        end(id, kNoSegment);
      }
    }
    for (const std::uint32_t id : changed) {
      segments_[id] = some_statistics(id);
      update.statistics.push_back(segments_[id]);
    }
    update.num_segments = static_cast<std::int64_t>(segments_.size());
    return update;
  }

  /// A full state in several updates.
  std::vector<SegmentUpdate> describe() {
    std::vector<SegmentUpdate> state;
    for (int i = 0; i < 3; ++i) {
      state.push_back(begin());
      state.back().utime = 0;
      state.back().num_segments = static_cast<std::int64_t>(segments_.size());
    }
    for (const auto& [id, statistics] : segments_) state.back().statistics.push_back(statistics);
    return state;
  }

  const Statistics& segments() const { return segments_; }
  std::uint32_t next_id() const { return next_id_; }
  const std::map<std::uint32_t, std::uint32_t>& parents() const { return parents_; }
  const std::map<std::uint32_t, std::uint32_t>& heirs() const { return heirs_; }

  std::optional<std::uint32_t> living_heir(std::uint32_t id) const {
    if (segments_.contains(id)) return id;
    const auto heir = heirs_.find(id);
    return heir == heirs_.end() ? std::nullopt : living_heir(heir->second);
  }

  int pick(int count) { return std::uniform_int_distribution(0, count - 1)(random_); }

 private:
  SegmentUpdate begin() {
    SegmentUpdate update;
    update.session = kSession;
    update.map_session = kMapSession;
    update.sequence = next_sequence_;
    update.slice_id = num_updates_;
    update.utime = 1'000 + num_updates_++;
    next_sequence_ += 1 + pick(3);  // as many chunks
    return update;
  }

  void end(std::uint32_t id, std::uint32_t heir) {
    segments_.erase(id);
    heirs_[id] = heir;
  }

  /// No two are equal.
  SegmentStatistics some_statistics(std::uint32_t id) {
    SegmentStatistics statistics;
    statistics.segment_id = id;
    statistics.num_points = ++num_told_;
    return statistics;
  }

  std::mt19937 random_;
  Statistics segments_;
  std::map<std::uint32_t, std::uint32_t> parents_;  // of all segments so far
  std::map<std::uint32_t, std::uint32_t> heirs_;    // of all that no longer exist
  std::uint32_t next_id_ = 1;
  std::uint32_t num_told_ = 0;
  std::int32_t num_updates_ = 0;
  std::int64_t next_sequence_ = 0;
};

Statistics statistics_in(const SegmentTable& table) {
  Statistics statistics;
  for (const auto& [id, segment] : table.segments()) statistics[id] = segment.statistics;
  return statistics;
}

std::vector<SegmentUpdate> steps(World& world, int count) {
  std::vector<SegmentUpdate> updates;
  updates.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) updates.push_back(world.step());
  return updates;
}

SegmentUpdate an_update(std::int64_t sequence, std::int64_t num_segments,
                        std::vector<SegmentEvent> events,
                        const std::vector<std::uint32_t>& changed) {
  SegmentUpdate update;
  update.session = kSession;
  update.map_session = kMapSession;
  update.sequence = sequence;
  update.num_segments = num_segments;
  update.events = std::move(events);
  for (const std::uint32_t id : changed) {
    update.statistics.emplace_back().segment_id = id;
    update.statistics.back().num_points = static_cast<std::uint32_t>(100 * sequence + id);
  }
  return update;
}

TEST(SegmentTable, FollowsAMapThroughRandomUpdates) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    World world(seed);
    SegmentTable table;
    for (int i = 0; i < 200; ++i) {
      ASSERT_TRUE(table.apply(world.step()));
      ASSERT_EQ(statistics_in(table), world.segments()) << "seed " << seed << ", update " << i;
      ASSERT_TRUE(table.has_all_segments());
    }
  }
}

TEST(SegmentTable, KnowsParentsEndsAndHeirs) {
  World world(21);
  SegmentTable table;
  for (const SegmentUpdate& update : steps(world, 300)) table.apply(update);
  ASSERT_GT(world.heirs().size(), 50U);
  for (std::uint32_t id = 1; id < world.next_id(); ++id) {
    ASSERT_NE(table.origin(id), nullptr) << id;
    EXPECT_EQ(table.origin(id)->parent_id, world.parents().at(id));
    const auto gone = world.heirs().find(id);
    ASSERT_EQ(table.end(id) != nullptr, gone != world.heirs().end()) << id;
    if (gone != world.heirs().end()) {
      EXPECT_EQ(table.end(id)->heir_id, gone->second);
    }
    EXPECT_EQ(table.heir(id), world.living_heir(id)) << id;
  }
  EXPECT_EQ(table.origin(world.next_id()), nullptr);
  EXPECT_FALSE(table.heir(world.next_id()));
}

TEST(SegmentTable, IsIndependentOfTheOrderAndRepetitionOfUpdates) {
  for (unsigned seed = 30; seed < 50; ++seed) {
    World world(seed);
    std::vector<SegmentUpdate> updates = steps(world, 60);
    for (SegmentUpdate& update : world.describe()) updates.push_back(std::move(update));
    for (SegmentUpdate& update : steps(world, 60)) updates.push_back(std::move(update));
    updates.insert(updates.end(), updates.begin(), updates.begin() + 40);
    std::shuffle(updates.begin(), updates.end(), std::mt19937(seed));
    SegmentTable table;
    for (const SegmentUpdate& update : updates) table.apply(update);
    ASSERT_EQ(statistics_in(table), world.segments()) << "seed " << seed;
    EXPECT_TRUE(table.has_all_segments());
    for (std::uint32_t id = 1; id < world.next_id(); ++id) {
      EXPECT_EQ(table.heir(id), world.living_heir(id)) << id;
    }
  }
}

TEST(SegmentTable, ALateClientHasAllSegmentsFromTheFullStateOn) {
  for (unsigned seed = 60; seed < 80; ++seed) {
    World world(seed);
    steps(world, 100);  // not received
    SegmentTable table;
    // Updates before the full state have statistics of few segments.
    for (const SegmentUpdate& update : steps(world, 2)) table.apply(update);
    EXPECT_FALSE(table.has_all_segments());
    const std::vector<SegmentUpdate> state = world.describe();
    for (const SegmentUpdate& update : state) table.apply(update);
    EXPECT_EQ(statistics_in(table), world.segments());
    EXPECT_EQ(table.listed_sequence(), state.back().sequence);
    for (int i = 0; i < 50; ++i) {
      table.apply(world.step());
      ASSERT_EQ(statistics_in(table), world.segments()) << "seed " << seed << ", update " << i;
    }
  }
}

TEST(SegmentTable, IsCorrectAgainWithTheNextFullStateAfterLosses) {
  int num_wrong = 0;
  for (unsigned seed = 90; seed < 110; ++seed) {
    World world(seed);
    SegmentTable table;
    std::vector<SegmentUpdate> lost;
    for (SegmentUpdate& update : steps(world, 100)) {
      if (world.pick(5) == 0) {
        lost.push_back(std::move(update));
      } else {
        table.apply(update);
      }
    }
    num_wrong += statistics_in(table) != world.segments() ? 1 : 0;
    for (const SegmentUpdate& update : world.describe()) table.apply(update);
    ASSERT_EQ(statistics_in(table), world.segments()) << "seed " << seed;
    // A late update from before the full state creates no segments.
    for (const SegmentUpdate& update : lost) table.apply(update);
    ASSERT_EQ(statistics_in(table), world.segments()) << "seed " << seed;
  }
  EXPECT_EQ(num_wrong, 20) << "the losses took nothing away, so nothing was tested";
}

TEST(SegmentTable, LacksSegmentsUntilAllUpdatesOfOneRunAreApplied) {
  // Two slices that were segmented together: the last update has the events and statistics.
  SegmentTable table;
  table.apply(an_update(0, 2, {}, {}));
  EXPECT_FALSE(table.has_all_segments());
  table.apply(an_update(
      1, 2, {{SegmentEventType::kCreated, 1, 0}, {SegmentEventType::kCreated, 2, 0}}, {1, 2}));
  EXPECT_TRUE(table.has_all_segments());
}

TEST(SegmentTable, ANewerSessionClearsItAndAnOlderOneIsIgnored) {
  SegmentTable table;
  table.apply(an_update(9, 1, {{SegmentEventType::kMerged, 1, 4}}, {1}));
  SegmentUpdate of_restarted = an_update(0, 2, {}, {1, 2});
  of_restarted.session = kSession + 1;
  of_restarted.is_final = true;
  EXPECT_TRUE(table.apply(of_restarted));
  EXPECT_EQ(table.segments().size(), 2U);
  EXPECT_EQ(table.end(4), nullptr);
  EXPECT_TRUE(table.is_final());

  EXPECT_FALSE(table.apply(an_update(10, 1, {}, {1})));
  EXPECT_EQ(table.newest()->session, kSession + 1);

  SegmentUpdate of_next_map = an_update(0, 0, {}, {});
  of_next_map.map_session = kMapSession + 1;
  EXPECT_TRUE(table.apply(of_next_map));
  EXPECT_TRUE(table.segments().empty());
  EXPECT_FALSE(table.is_final());
  EXPECT_FALSE(table.apply(of_restarted));
}

TEST(SegmentTable, DoesNotFollowHeirsInACircle) {
  SegmentTable table;
  table.apply(
      an_update(0, 0, {{SegmentEventType::kMerged, 1, 2}, {SegmentEventType::kMerged, 2, 1}}, {}));
  EXPECT_FALSE(table.heir(1));
  EXPECT_FALSE(table.heir(3));
}

TEST(SegmentTable, KnowsWhenASegmentChangedUnlessFromAFullState) {
  SegmentTable table;
  SegmentUpdate state = an_update(5, 2, {}, {1, 2});
  SegmentUpdate update = an_update(6, 2, {{SegmentEventType::kGrown, 2, 0}}, {2});
  update.utime = 1234;
  table.apply(state);
  table.apply(update);
  EXPECT_EQ(table.find(1)->utime, 0);
  EXPECT_EQ(table.find(2)->utime, 1234);
  EXPECT_EQ(table.find(2)->statistics.num_points, 602U);
  EXPECT_EQ(table.find(3), nullptr);
  EXPECT_EQ(table.newest()->sequence, 6);
}

}  // namespace
}  // namespace kintsugi
