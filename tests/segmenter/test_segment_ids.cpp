#include <algorithm>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <span>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/core/engine.hpp"
#include "segmenter/core/segment_ids.hpp"
#include "tests/segmenter/random_clouds.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::IsEmpty;
using Components = std::vector<PointIndex>;
using Ids = std::vector<std::uint32_t>;

SegmentEvent created(std::uint32_t id) { return {SegmentEventType::kCreated, id, 0}; }
SegmentEvent grown(std::uint32_t id) { return {SegmentEventType::kGrown, id, 0}; }
SegmentEvent merged(std::uint32_t into, std::uint32_t id) {
  return {SegmentEventType::kMerged, into, id};
}
SegmentEvent split(std::uint32_t from, std::uint32_t id) {
  return {SegmentEventType::kSplit, from, id};
}

std::vector<PointIndex> differing(const Components& before, const Components& after) {
  std::vector<PointIndex> points;
  for (PointIndex i = 0; i < after.size(); ++i) {
    if (i >= before.size() || before[i] != after[i]) points.push_back(i);
  }
  return points;
}

/// Keeps the components of the last update, as an engine would.
class SegmentIdsTest : public ::testing::Test {
 protected:
  IdUpdate update(const Components& components) {
    const auto changed = differing(components_, components);
    components_ = components;
    return ids_.update(components_, changed);
  }
  Components components_;
  SegmentIds ids_;
};

TEST_F(SegmentIdsTest, NewSegmentsAreNumberedFromOneByRepresentative) {
  const IdUpdate result = update({0, 1, 0, 3, 1});
  EXPECT_THAT(ids_.ids(), ElementsAre(1, 2, 1, 3, 2));
  EXPECT_THAT(result.events, ElementsAre(created(1), created(2), created(3)));
  EXPECT_THAT(result.changes, ElementsAre(IdChange{0, 0, 1}, IdChange{1, 0, 2}, IdChange{2, 0, 1},
                                          IdChange{3, 0, 3}, IdChange{4, 0, 2}));
  EXPECT_EQ(ids_.num_segments(), 3);
}

TEST_F(SegmentIdsTest, NothingChangedTellsNothing) {
  update({0, 0, 2});
  const IdUpdate result = update({0, 0, 2});
  EXPECT_THAT(result.changes, IsEmpty());
  EXPECT_THAT(result.events, IsEmpty());
}

TEST_F(SegmentIdsTest, SegmentThatGrowsKeepsItsId) {
  update({0, 0});
  const IdUpdate result = update({0, 0, 0});
  EXPECT_THAT(ids_.ids(), ElementsAre(1, 1, 1));
  EXPECT_THAT(result.events, ElementsAre(grown(1)));
  EXPECT_THAT(result.changes, ElementsAre(IdChange{2, 0, 1}));
}

TEST_F(SegmentIdsTest, SegmentOfMostPointsGivesItsIdToAMerger) {
  update({0, 1, 1});
  const IdUpdate result = update({0, 0, 0});
  EXPECT_THAT(ids_.ids(), ElementsAre(2, 2, 2));
  EXPECT_THAT(result.events, ElementsAre(grown(2), merged(2, 1)));
  // The point that kept its representative changes id; the two that were renamed do not.
  EXPECT_THAT(result.changes, ElementsAre(IdChange{0, 1, 2}));
  EXPECT_EQ(ids_.num_segments(), 1);
}

TEST_F(SegmentIdsTest, TiesGoToTheOlderId) {
  update({0, 0, 2, 2});
  const IdUpdate result = update({0, 0, 0, 0, 0});
  EXPECT_THAT(ids_.ids(), ElementsAre(1, 1, 1, 1, 1));
  EXPECT_THAT(result.events, ElementsAre(grown(1), merged(1, 2)));
}

TEST_F(SegmentIdsTest, LargestPartOfASplitKeepsTheId) {
  update({0, 0, 0, 0, 0});
  const IdUpdate result = update({0, 1, 1, 1, 0});
  EXPECT_THAT(ids_.ids(), ElementsAre(2, 1, 1, 1, 2));
  EXPECT_THAT(result.events, ElementsAre(split(1, 2)));
}

TEST_F(SegmentIdsTest, EqualPartsOfASplitTieToTheSmallerRepresentative) {
  update({0, 0, 0, 0});
  update({0, 1, 1, 0});
  EXPECT_THAT(ids_.ids(), ElementsAre(1, 2, 2, 1));
}

TEST_F(SegmentIdsTest, SegmentThatLosesItsClaimGetsANewIdEvenWithASecondChoice) {
  update({0, 0, 0, 0, 0, 5});
  // {1, 2, 3} takes id 1; {0, 4, 5} had most of id 1 as well, and gets neither 1 nor 2.
  const IdUpdate result = update({0, 1, 1, 1, 0, 0});
  EXPECT_THAT(ids_.ids(), ElementsAre(3, 1, 1, 1, 3, 3));
  EXPECT_THAT(result.events, ElementsAre(merged(3, 2), split(1, 3)));
}

TEST_F(SegmentIdsTest, PointsThatMoveBetweenSegmentsThatStayOnlyGrowTheirTaker) {
  update({0, 0, 0, 3, 3, 3});
  const IdUpdate result = update({0, 0, 3, 3, 3, 3});
  EXPECT_THAT(ids_.ids(), ElementsAre(1, 1, 2, 2, 2, 2));
  EXPECT_THAT(result.events, ElementsAre(grown(2)));
  EXPECT_THAT(result.changes, ElementsAre(IdChange{2, 1, 2}));
}

TEST_F(SegmentIdsTest, IdsAreNotUsedTwice) {
  update({0, 1, 1});
  update({0, 0, 0});
  update({0, 1, 1});
  EXPECT_THAT(ids_.ids(), ElementsAre(3, 2, 2));
  EXPECT_EQ(ids_.next_id(), 4U);
}

/// The rules, applied to whole partitions as sets.
class SlowIds {
 public:
  IdUpdate update(const Components& components) {
    std::map<PointIndex, std::set<PointIndex>> segments;
    for (PointIndex i = 0; i < components.size(); ++i) segments[components[i]].insert(i);

    std::map<PointIndex, std::map<std::uint32_t, int>> shares;  // with old ids, by representative
    for (const auto& [representative, points] : segments) {
      for (const PointIndex i : points) {
        if (i < ids_.size()) ++shares[representative][ids_[i]];
      }
    }
    std::map<std::uint32_t, PointIndex> heirs;
    std::map<PointIndex, std::uint32_t> preferred;
    for (const auto& [representative, by_id] : shares) {
      const auto best =
          std::max_element(by_id.begin(), by_id.end(),
                           [](const auto& a, const auto& b) { return a.second < b.second; });
      preferred[representative] = best->first;
      const auto [heir, is_first] = heirs.try_emplace(best->first, representative);
      if (!is_first && best->second > shares[heir->second][best->first]) {
        heir->second = representative;
      }
    }
    std::map<PointIndex, std::uint32_t> new_ids;
    for (const auto& [id, representative] : heirs) new_ids[representative] = id;
    for (const auto& [representative, points] : segments) {
      if (!new_ids.contains(representative)) new_ids[representative] = next_id_++;
    }
    return tell(components, segments, shares, preferred, new_ids);
  }

  Ids ids_;

 private:
  IdUpdate tell(const Components& components,
                const std::map<PointIndex, std::set<PointIndex>>& segments,
                const std::map<PointIndex, std::map<std::uint32_t, int>>& shares,
                const std::map<PointIndex, std::uint32_t>& preferred,
                const std::map<PointIndex, std::uint32_t>& new_ids) {
    IdUpdate result;
    Ids ids;
    for (PointIndex i = 0; i < components.size(); ++i) {
      ids.push_back(new_ids.at(components[i]));
      const std::uint32_t old_id = i < ids_.size() ? ids_[i] : kNoSegment;
      if (old_id != ids[i]) result.changes.push_back({i, old_id, ids[i]});
    }
    std::map<std::uint32_t, std::set<PointIndex>> old_points;
    for (PointIndex i = 0; i < ids_.size(); ++i) old_points[ids_[i]].insert(i);
    for (const auto& [representative, points] : segments) {
      const std::uint32_t id = new_ids.at(representative);
      if (!preferred.contains(representative)) {
        result.events.push_back(created(id));
      } else if (preferred.at(representative) != id) {
        result.events.push_back(split(preferred.at(representative), id));
      } else if (!std::includes(old_points[id].begin(), old_points[id].end(), points.begin(),
                                points.end())) {
        result.events.push_back(grown(id));
      }
    }
    const std::set<std::uint32_t> alive(ids.begin(), ids.end());
    for (const auto& [old_id, points] : old_points) {
      if (alive.contains(old_id)) continue;
      int most = 0;
      std::uint32_t taker = 0;
      for (const auto& [representative, by_id] : shares) {
        const auto share = by_id.find(old_id);
        if (share == by_id.end()) continue;
        const std::uint32_t id = new_ids.at(representative);
        if (share->second > most || (share->second == most && id < taker)) {
          most = share->second;
          taker = id;
        }
      }
      result.events.push_back(merged(taker, old_id));
    }
    std::sort(result.events.begin(), result.events.end(), [](const auto& a, const auto& b) {
      return std::tie(a.type, a.segment_id, a.other_id) <
             std::tie(b.type, b.segment_id, b.other_id);
    });
    ids_ = ids;
    return result;
  }

  std::uint32_t next_id_ = 1;
};

/// A partition as a random walk: segments merge, split and exchange points; new points come.
class RandomPartition {
 public:
  explicit RandomPartition(unsigned seed) : generator_(seed) {}

  Components next() {
    const std::size_t num_old = groups_.size();
    for (int k = below(12); k > 0; --k) groups_.push_back(below(15));
    if (groups_.empty()) return {};
    for (int k = below(4); k > 0; --k) merge(below(15), below(15));
    for (int k = below(4); k > 0; --k) scatter(below(15), below(15));
    for (int k = below(6); k > 0; --k) {
      groups_[static_cast<std::size_t>(below(static_cast<int>(groups_.size())))] = below(15);
    }
    // Groups that kept their representative's membership keep it, as a stable engine would; some
    // are renamed all the same.
    std::map<int, PointIndex> representatives;
    for (std::size_t i = 0; i < num_old; ++i) {
      const PointIndex old = components_[i];
      if (below(10) > 0 && groups_[old] == groups_[i]) representatives.try_emplace(groups_[i], old);
    }
    for (PointIndex i = 0; i < groups_.size(); ++i) representatives.try_emplace(groups_[i], i);
    components_.clear();
    for (const int group : groups_) components_.push_back(representatives[group]);
    return components_;
  }

 private:
  int below(int limit) {
    return static_cast<int>(generator_() % static_cast<unsigned>(std::max(limit, 1)));
  }
  void merge(int from, int to) { std::replace(groups_.begin(), groups_.end(), from, to); }
  void scatter(int from, int to) {
    for (int& group : groups_) {
      if (group == from && below(2) == 0) group = to;
    }
  }

  std::mt19937 generator_;
  std::vector<int> groups_;
  Components components_;
};

void expect_equal(const IdUpdate& update, const IdUpdate& expected) {
  EXPECT_THAT(update.changes, ElementsAreArray(expected.changes));
  EXPECT_THAT(update.events, ElementsAreArray(expected.events));
}

TEST(SegmentIds, EqualTheSlowReferenceOnRandomPartitions) {
  int num_mergers = 0;
  int num_splits = 0;
  for (unsigned seed = 0; seed < 150; ++seed) {
    RandomPartition partition(seed);
    SegmentIds ids;
    SlowIds slow;
    Components before;
    for (int step = 0; step < 15; ++step) {
      const Components components = partition.next();
      const IdUpdate result = ids.update(components, differing(before, components));
      expect_equal(result, slow.update(components));
      EXPECT_THAT(ids.ids(), ElementsAreArray(slow.ids_));
      before = components;
      for (const SegmentEvent& event : result.events) {
        num_mergers += event.type == SegmentEventType::kMerged;
        num_splits += event.type == SegmentEventType::kSplit;
      }
    }
  }
  EXPECT_GT(num_mergers, 1000);
  EXPECT_GT(num_splits, 1000);
}

TEST(SegmentIds, MorePointsGivenAsChangedThanDidChangeNothingMore) {
  RandomPartition partition(77);
  SegmentIds ids;
  SlowIds slow;
  for (int step = 0; step < 30; ++step) {
    const Components components = partition.next();
    expect_equal(ids.update(components, differing({}, components)), slow.update(components));
  }
}

TEST(SegmentIds, ListTheirPoints) {
  RandomPartition partition(5);
  SegmentIds ids;
  Components before;
  for (int step = 0; step < 40; ++step) {
    const Components components = partition.next();
    ids.update(components, differing(before, components));
    before = components;
    std::int64_t num_segments = 0;
    std::size_t num_points = 0;
    for (std::uint32_t id = 1; id < ids.next_id(); ++id) {
      const auto points = ids.points_of(id);
      num_segments += !points.empty();
      num_points += points.size();
      EXPECT_EQ(std::set(points.begin(), points.end()).size(), points.size());
      for (const PointIndex i : points) EXPECT_EQ(ids.ids()[i], id);
    }
    EXPECT_EQ(num_segments, ids.num_segments());
    EXPECT_EQ(num_points, components.size());
  }
  EXPECT_THAT(ids.points_of(kNoSegment), IsEmpty());
  EXPECT_THAT(ids.points_of(ids.next_id()), IsEmpty());
}

class SegmentIdsOfEngine : public ::testing::TestWithParam<std::string_view> {};

TEST_P(SegmentIdsOfEngine, RunsAndEventsReplayedGiveTheLabels) {
  const auto points = testing::random_cloud(testing::CloudShape::kWaves, 3000, 6);
  PointCloud cloud;
  const auto engine = make_engine(GetParam(), cloud, {});
  SegmentIds ids;
  SlowIds slow;
  std::map<std::int32_t, Ids> replayed;  // what a listener knows, by slice
  std::set<std::uint32_t> alive;
  for (std::int32_t slice_id = 0; slice_id < 15; ++slice_id) {
    const auto part = std::span(points).subspan(static_cast<std::size_t>(slice_id) * 200, 200);
    std::vector<CloudPoint> slice(part.begin(), part.end());
    slice[7].x = NAN;
    const PointIndex first = cloud.add_slice(slice_id, slice).first;
    engine->update(cloud.take_change());
    const IdUpdate result = ids.update(engine->components(), engine->changed());
    expect_equal(result, slow.update({engine->components().begin(), engine->components().end()}));

    replayed[slice_id] = slice_labels(cloud.slices().back(), ids.ids());
    EXPECT_EQ(replayed[slice_id][7], kNoSegment);
    for (const LabelRun& run : label_runs(cloud, result.changes, first)) {
      ASSERT_LT(run.slice_id, slice_id);
      std::fill_n(replayed[run.slice_id].begin() + run.first, run.count, run.segment_id);
    }
    for (const SliceRecord& record : cloud.slices()) {
      EXPECT_EQ(replayed[record.slice_id], slice_labels(record, ids.ids()));
    }
    for (const SegmentEvent& event : result.events) {
      switch (event.type) {
        case SegmentEventType::kCreated:
          EXPECT_TRUE(alive.insert(event.segment_id).second);
          break;
        case SegmentEventType::kSplit:
          EXPECT_TRUE(alive.insert(event.other_id).second);
          break;
        case SegmentEventType::kMerged:
          EXPECT_EQ(alive.erase(event.other_id), 1U);
          break;
        case SegmentEventType::kGrown:
          EXPECT_TRUE(alive.contains(event.segment_id));
          break;
        case SegmentEventType::kRetired:
          ADD_FAILURE() << "no point was taken away";
          break;
      }
    }
    EXPECT_EQ(alive, std::set(ids.ids().begin(), ids.ids().end()));
  }
}

INSTANTIATE_TEST_SUITE_P(Modes, SegmentIdsOfEngine,
                         ::testing::ValuesIn(engine_modes().begin(), engine_modes().end()));

TEST(LabelRuns, BreakAtSlicesIdsAndGaps) {
  CloudPoint bad = testing::make_point(0, 0, 0, 0, 0, 1);
  bad.ny = INFINITY;
  const CloudPoint good = testing::make_point(0, 0, 0, 0, 0, 1);
  PointCloud cloud;
  cloud.add_slice(4, std::vector{good, good, bad, good});  // points 0 1 . 2
  cloud.add_slice(9, std::vector{bad, good, good});        // points . 3 4
  const std::vector<IdChange> changes = {{0, 1, 5}, {1, 1, 5}, {2, 2, 5}, {3, 1, 5}, {4, 1, 6}};
  EXPECT_THAT(label_runs(cloud, changes, 5),
              ElementsAre(LabelRun{4, 0, 2, 5}, LabelRun{4, 3, 1, 5}, LabelRun{9, 1, 1, 5},
                          LabelRun{9, 2, 1, 6}));
  EXPECT_THAT(label_runs(cloud, changes, 3),
              ElementsAre(LabelRun{4, 0, 2, 5}, LabelRun{4, 3, 1, 5}));
}

}  // namespace
}  // namespace kintsugi::segmenter
