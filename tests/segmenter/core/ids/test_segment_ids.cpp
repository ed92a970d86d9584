#include <algorithm>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/core/engine/engine.hpp"
#include "segmenter/core/ids/segment_ids.hpp"
#include "segmenter/core/ids/slice_labels.hpp"
#include "segmenter/core/make_engine.hpp"
#include "tests/segmenter/core/random_clouds.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::IsEmpty;
using Components = std::vector<ComponentId>;
using Ids = std::vector<std::uint32_t>;

SegmentEvent created(std::uint32_t id) { return {SegmentEventType::kCreated, id, 0}; }
SegmentEvent grown(std::uint32_t id) { return {SegmentEventType::kGrown, id, 0}; }
SegmentEvent merged(std::uint32_t into, std::uint32_t id) {
  return {SegmentEventType::kMerged, into, id};
}
SegmentEvent retired(std::uint32_t id) { return {SegmentEventType::kRetired, id, 0}; }
SegmentEvent split(std::uint32_t from, std::uint32_t id) {
  return {SegmentEventType::kSplit, from, id};
}

CloudPoint any_point() { return testing::make_point(0, 0, 0, 0, 0, 1); }

/// What an engine that named the components so before and names them so now has to tell.
Components differing(const Components& before, const Components& after, const CloudChange& change) {
  Components points;
  for (PointIndex i = 0; i < after.size(); ++i) {
    if (after[i] == kNoComponent) continue;
    const bool is_added = std::binary_search(change.added.begin(), change.added.end(), i);
    if (is_added || before[i] != after[i]) points.push_back(i);
  }
  return points;
}

/// Keeps the cloud, and the components of the last update as an engine would. Points come in slices
/// of their own.
class SegmentIdsTest : public ::testing::Test {
 protected:
  IdUpdate update(const Components& components) {
    for (std::int32_t i = 0; cloud_.size() < components.size(); ++i) {
      if (cloud_.find_slice(i) == nullptr) cloud_.add_slice(i, std::vector{any_point()});
    }
    const CloudChange change = cloud_.take_change();
    const Components changed = differing(components_, components, change);
    components_ = components;
    return ids_.update(cloud_, change, components_, changed);
  }
  PointCloud cloud_;
  Components components_;
  SegmentIds ids_;
};

TEST_F(SegmentIdsTest, NewSegmentsAreNumberedFromOneByTheirFirstPoints) {
  const IdUpdate result = update({4, 3, 4, 1, 3});
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

TEST_F(SegmentIdsTest, EqualPartsOfASplitTieToTheOneWithTheFirstPoint) {
  update({0, 0, 0, 0});
  update({3, 0, 0, 3});  // the part that keeps the name is not the one that keeps the id
  EXPECT_THAT(ids_.ids(), ElementsAre(1, 2, 2, 1));
}

TEST_F(SegmentIdsTest, FirstPointsAreFirstBySliceNotByPlaceInTheCloud) {
  update({0, 0, 0, 0});
  cloud_.replace_slice(0, std::vector{any_point()});  // its point stands at 4 now
  update({kNoComponent, 1, 1, 2, 2});
  EXPECT_THAT(ids_.ids(), ElementsAre(0, 2, 2, 1, 1));
}

TEST_F(SegmentIdsTest, PointThatMovesIsTheSamePoint) {
  update({0, 0, 2});
  cloud_.replace_slice(0, std::vector{any_point()});
  const IdUpdate result = update({kNoComponent, 1, 2, 1});
  EXPECT_THAT(ids_.ids(), ElementsAre(0, 1, 2, 1));
  EXPECT_THAT(result.events, IsEmpty());
  EXPECT_THAT(result.changes, ElementsAre(IdChange{0, 1, 0}, IdChange{3, 0, 1}));
}

TEST_F(SegmentIdsTest, PointsThatMoveTakeTheirIdAlong) {
  update({0, 0, 0, 3});
  cloud_.replace_slice(1, std::vector{any_point()});
  cloud_.replace_slice(2, std::vector{any_point()});
  const IdUpdate result = update({0, kNoComponent, kNoComponent, 3, 4, 4});
  EXPECT_THAT(ids_.ids(), ElementsAre(3, 0, 0, 2, 1, 1));
  EXPECT_THAT(result.events, ElementsAre(split(1, 3)));
}

TEST_F(SegmentIdsTest, SegmentWhoseLastPointGoesIsRetired) {
  update({0, 0, 2});
  cloud_.replace_slice(0, {});
  EXPECT_THAT(update({kNoComponent, 1, 2}).events, IsEmpty());
  cloud_.replace_slice(1, {});
  const IdUpdate result = update({kNoComponent, kNoComponent, 2});
  EXPECT_THAT(ids_.ids(), ElementsAre(0, 0, 2));
  EXPECT_THAT(result.events, ElementsAre(retired(1)));
  EXPECT_THAT(result.changes, ElementsAre(IdChange{1, 1, 0}));
  EXPECT_EQ(ids_.num_segments(), 1);
}

TEST_F(SegmentIdsTest, PointRejectedInARevisionIsGone) {
  update({0, 0});
  CloudPoint bad = any_point();
  bad.x = NAN;
  cloud_.replace_slice(0, std::vector{bad});
  const IdUpdate result = update({kNoComponent, 0});  // nothing is changed but what is gone
  EXPECT_THAT(result.events, IsEmpty());
  EXPECT_THAT(result.changes, ElementsAre(IdChange{0, 1, 0}));
  EXPECT_EQ(ids_.num_points_of(1), 1);
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

/// Points by what they are called, and a label of each.
using Labels = std::map<PointId, std::uint32_t>;

Labels labels_of(const PointCloud& cloud, std::span<const std::uint32_t> by_point) {
  Labels labels;
  for (const PointIndex p : cloud.everything().added) labels[cloud.id_of(p)] = by_point[p];
  return labels;
}

/// The rules, applied to whole partitions as sets.
class SlowIds {
 public:
  /// Takes over the partition of the points there are now.
  std::vector<SegmentEvent> update(const Labels& components) {
    std::map<std::uint32_t, std::set<PointId>> by_component;
    for (const auto& [point, component] : components) by_component[component].insert(point);
    std::map<PointId, Segment> segments;  // by first point
    for (const auto& [component, points] : by_component) {
      Segment& segment = segments[*points.begin()];
      segment.points = points;
      for (const PointId& point : points) {
        if (labels_.contains(point)) ++segment.shares[labels_.at(point)];
      }
      for (const auto& [id, count] : segment.shares) {
        if (segment.preferred == kNoSegment || count > segment.shares.at(segment.preferred)) {
          segment.preferred = id;
        }
      }
    }
    std::map<std::uint32_t, Segment*> heirs;
    for (auto& [first, segment] : segments) {
      const std::uint32_t id = segment.preferred;
      if (id == kNoSegment) continue;
      const auto [heir, is_first] = heirs.try_emplace(id, &segment);
      if (segment.shares.at(id) > heir->second->shares.at(id)) heir->second = &segment;
    }
    for (const auto& [id, segment] : heirs) segment->id = id;
    for (auto& [first, segment] : segments) {
      if (segment.id == kNoSegment) segment.id = next_id_++;
    }
    return tell(segments);
  }

  Labels labels_;

 private:
  struct Segment {
    std::set<PointId> points;
    std::map<std::uint32_t, int> shares;  // with old ids
    std::uint32_t preferred = kNoSegment;
    std::uint32_t id = kNoSegment;
  };

  std::vector<SegmentEvent> tell(const std::map<PointId, Segment>& segments) {
    std::map<std::uint32_t, std::set<PointId>> old_points;
    for (const auto& [point, id] : labels_) old_points[id].insert(point);
    labels_.clear();
    std::vector<SegmentEvent> events;
    std::set<std::uint32_t> alive;
    for (const auto& [first, segment] : segments) {
      alive.insert(segment.id);
      for (const PointId& point : segment.points) labels_[point] = segment.id;
      if (segment.preferred == kNoSegment) {
        events.push_back(created(segment.id));
      } else if (segment.preferred != segment.id) {
        events.push_back(split(segment.preferred, segment.id));
      } else if (!std::includes(old_points[segment.id].begin(), old_points[segment.id].end(),
                                segment.points.begin(), segment.points.end())) {
        events.push_back(grown(segment.id));
      }
    }
    for (const auto& [old_id, points] : old_points) {
      if (alive.contains(old_id)) continue;
      int most = 0;
      std::uint32_t taker = 0;
      for (const auto& [first, segment] : segments) {
        const auto share = segment.shares.find(old_id);
        if (share == segment.shares.end()) continue;
        if (share->second > most || (share->second == most && segment.id < taker)) {
          most = share->second;
          taker = segment.id;
        }
      }
      events.push_back(most > 0 ? merged(taker, old_id) : retired(old_id));
    }
    std::sort(events.begin(), events.end(), [](const auto& a, const auto& b) {
      return std::tie(a.type, a.segment_id, a.other_id) <
             std::tie(b.type, b.segment_id, b.other_id);
    });
    return events;
  }

  std::uint32_t next_id_ = 1;
};

/// A cloud and its partition as a random walk: slices come, come again and go; segments merge,
/// split and exchange points. Components mostly keep a name, but any names may change hands.
class RandomPartition {
 public:
  explicit RandomPartition(unsigned seed) : generator_(seed) {}

  void step() {
    change_cloud();
    change = cloud.take_change();
    change_groups();
    const Components before = components;
    name_components();
    changed = differing(before, components, change);
  }

  /// Names more points as changed than did change.
  void enlarge_changed() {
    std::set<PointIndex> more(changed.begin(), changed.end());
    for (const PointIndex p : cloud.everything().added) {
      if (below(4) == 0) more.insert(p);
    }
    changed.assign(more.begin(), more.end());
  }

  PointCloud cloud;
  CloudChange change;
  Components components;
  Components changed;

 private:
  void change_cloud() {
    for (int k = below(4); k > 0; --k) {
      const std::int32_t slice = below(12);
      std::vector<CloudPoint> points(static_cast<std::size_t>(below(9)), any_point());
      for (CloudPoint& point : points) {
        if (below(5) == 0) point.x = NAN;
      }
      if (cloud.find_slice(slice) == nullptr) {
        cloud.add_slice(slice, points);
      } else if (below(3) == 0) {
        cloud.replace_slice(slice, {});
      } else {
        cloud.replace_slice(slice, points);
      }
    }
  }

  void change_groups() {
    const auto before = std::exchange(group_, {});
    const int from = below(15), to = below(15), torn = below(15);
    for (const PointIndex p : cloud.everything().added) {
      const PointId id = cloud.id_of(p);
      int group = before.contains(id) ? before.at(id) : below(15);
      if (group == from) group = to;
      if (group == torn && below(2) == 0) group = (group + 7) % 15;
      if (below(20) == 0) group = below(15);
      group_[id] = group;
    }
  }

  void name_components() {
    const Components before = std::exchange(components, Components(cloud.size(), kNoComponent));
    std::map<int, ComponentId> name;
    std::set<ComponentId> used;
    for (const PointIndex p : cloud.everything().added) {
      const int group = group_.at(cloud.id_of(p));
      if (name.contains(group)) continue;
      if (p < before.size() && before[p] != kNoComponent && below(10) > 0 &&
          used.insert(before[p]).second) {
        name[group] = before[p];
      }
    }
    for (const PointIndex p : cloud.everything().added) {
      const int group = group_.at(cloud.id_of(p));
      while (!name.contains(group)) {
        const auto any = static_cast<ComponentId>(below(static_cast<int>(cloud.size())));
        if (used.insert(any).second) name[group] = any;
      }
      components[p] = name.at(group);
    }
  }

  int below(int limit) { return static_cast<int>(generator_() % static_cast<unsigned>(limit)); }

  std::mt19937 generator_;
  std::map<PointId, int> group_;
};

/// What came, went and got another id, from all labels before and after.
std::vector<IdChange> expected_changes(const PointCloud& cloud, const CloudChange& change,
                                       const Labels& before, const Labels& after) {
  std::vector<IdChange> changes;
  const auto contains = [](const std::vector<PointIndex>& points, PointIndex p) {
    return std::binary_search(points.begin(), points.end(), p);
  };
  for (PointIndex p = 0; p < cloud.size(); ++p) {
    if (contains(change.removed, p)) {
      changes.push_back({p, before.at(cloud.id_of(p)), kNoSegment});
    } else if (contains(change.added, p)) {
      changes.push_back({p, kNoSegment, after.at(cloud.id_of(p))});
    } else if (cloud.is_live(p) && before.at(cloud.id_of(p)) != after.at(cloud.id_of(p))) {
      changes.push_back({p, before.at(cloud.id_of(p)), after.at(cloud.id_of(p))});
    }
  }
  return changes;
}

TEST(SegmentIds, EqualTheSlowReferenceOnRandomPartitions) {
  std::map<SegmentEventType, int> num_events;
  for (unsigned seed = 0; seed < 150; ++seed) {
    RandomPartition partition(seed);
    SegmentIds ids;
    SlowIds slow;
    for (int step = 0; step < 25; ++step) {
      partition.step();
      if (step % 3 == 0) partition.enlarge_changed();
      const Labels before = slow.labels_;
      const IdUpdate result =
          ids.update(partition.cloud, partition.change, partition.components, partition.changed);
      EXPECT_THAT(result.events,
                  ElementsAreArray(slow.update(labels_of(partition.cloud, partition.components))));
      EXPECT_EQ(labels_of(partition.cloud, ids.ids()), slow.labels_);
      EXPECT_THAT(result.changes, ElementsAreArray(expected_changes(
                                      partition.cloud, partition.change, before, slow.labels_)));
      for (const SegmentEvent& event : result.events) ++num_events[event.type];
    }
  }
  // Every kind has been seen often.
  for (const auto& [type, count] : num_events) EXPECT_GT(count, 1000) << static_cast<int>(type);
  EXPECT_EQ(num_events.size(), 5U);
}

TEST(SegmentIds, ListTheirPoints) {
  RandomPartition partition(5);
  SegmentIds ids;
  for (int step = 0; step < 60; ++step) {
    partition.step();
    ids.update(partition.cloud, partition.change, partition.components, partition.changed);
    std::int64_t num_segments = 0;
    std::int64_t num_points = 0;
    for (std::uint32_t id = 1; id < ids.next_id(); ++id) {
      std::set<PointIndex> points;
      for (const PointIndex i : ids.points_of(id)) {
        EXPECT_TRUE(points.insert(i).second);
        EXPECT_EQ(ids.ids()[i], id);
      }
      EXPECT_EQ(std::ssize(points), ids.num_points_of(id));
      EXPECT_EQ(points.empty(), ids.points_of(id).empty());
      num_segments += !points.empty();
      num_points += std::ssize(points);
    }
    EXPECT_EQ(num_segments, ids.num_segments());
    EXPECT_EQ(num_points, partition.cloud.num_live());
  }
  EXPECT_TRUE(ids.points_of(kNoSegment).empty());
  EXPECT_TRUE(ids.points_of(ids.next_id()).empty());
}

TEST(SegmentIds, DoNotDependOnTheNamesThatAnEngineGives) {
  std::mt19937 random(8);
  const auto points = testing::random_cloud(testing::CloudShape::kWaves, 2000, 6);
  PointCloud cloud;
  const auto engine = make_engine("batch", cloud, {});
  SegmentIds ids;
  SegmentIds ids_by_other_names;
  Components other_names;
  Components permutation;
  for (int step = 0; step < 25; ++step) {
    const std::int32_t slice = step < 10 ? step : static_cast<std::int32_t>(random() % 10);
    const auto of_slice = std::span(points).subspan(static_cast<std::size_t>(slice) * 200, 200);
    std::vector<CloudPoint> part(of_slice.begin(), of_slice.end());
    for (CloudPoint& point : part) point.z += 0.01F * static_cast<float>(random() % 2);
    step < 10 ? cloud.add_slice(slice, part) : cloud.replace_slice(slice, part);
    const CloudChange change = cloud.take_change();
    engine->update(change);
    const IdUpdate update = ids.update(cloud, change, engine->components(), engine->changed());

    // Now and then every component gets another name.
    while (permutation.size() < cloud.size()) {
      permutation.push_back(static_cast<ComponentId>(permutation.size()));
    }
    if (step % 3 == 2) std::shuffle(permutation.begin(), permutation.end(), random);
    const Components before = std::exchange(other_names, {});
    for (const ComponentId name : engine->components()) {
      other_names.push_back(name == kNoComponent ? kNoComponent : permutation[name]);
    }
    const IdUpdate other = ids_by_other_names.update(cloud, change, other_names,
                                                     differing(before, other_names, change));
    EXPECT_THAT(other.events, ElementsAreArray(update.events));
    EXPECT_THAT(other.changes, ElementsAreArray(update.changes));
    EXPECT_THAT(ids_by_other_names.ids(), ElementsAreArray(ids.ids()));
  }
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
    cloud.add_slice(slice_id, slice);
    const CloudChange change = cloud.take_change();
    engine->update(change);
    const IdUpdate result = ids.update(cloud, change, engine->components(), engine->changed());
    EXPECT_THAT(result.events,
                ElementsAreArray(slow.update(labels_of(cloud, engine->components()))));

    replayed[slice_id] = slice_labels(cloud.slices().back(), ids.ids());
    EXPECT_EQ(replayed[slice_id][7], kNoSegment);
    for (const LabelRun& run : label_runs(cloud, result.changes)) {
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

TEST(LabelRuns, BreakAtSlicesIdsAndGapsAndNameTheRevision) {
  CloudPoint bad = any_point();
  bad.ny = INFINITY;
  const CloudPoint good = any_point();
  PointCloud cloud;
  cloud.add_slice(4, std::vector{good, good, bad, good}, 7);  // points 0 1 . 2
  cloud.add_slice(9, std::vector{bad, good, good});           // points . 3 4
  cloud.add_slice(2, std::vector{good});
  const std::vector<IdChange> changes = {{0, 1, 5}, {1, 1, 5}, {2, 2, 5},
                                         {3, 1, 5}, {4, 1, 6}, {5, 1, 6}};
  EXPECT_THAT(label_runs(cloud, changes),
              ElementsAre(LabelRun{2, 0, 1, 6, 0}, LabelRun{4, 0, 2, 5, 7}, LabelRun{4, 3, 1, 5, 7},
                          LabelRun{9, 1, 1, 5, 0}, LabelRun{9, 2, 1, 6, 0}));
}

TEST(LabelRuns, LeaveOutPointsThatCameOrWent) {
  PointCloud cloud;
  cloud.add_slice(0, std::vector{any_point(), any_point(), any_point()});
  const std::vector<IdChange> changes = {{0, 1, kNoSegment}, {1, kNoSegment, 2}, {2, 1, 2}};
  EXPECT_THAT(label_runs(cloud, changes), ElementsAre(LabelRun{0, 2, 1, 2}));
}

}  // namespace
}  // namespace kintsugi::segmenter
