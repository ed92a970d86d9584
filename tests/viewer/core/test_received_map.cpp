#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "viewer/core/map/received_map.hpp"

namespace kintsugi::viewer {
namespace {

constexpr std::int64_t kMapSession = 10;
constexpr std::int64_t kSegmenterSession = 20;

CloudSlice slice_of(std::int32_t id, int num_points, std::int32_t revision = 0) {
  CloudSlice slice;
  slice.session = kMapSession;
  slice.id = id;
  slice.revision = revision;
  slice.kind = SliceKind::kPatch;
  slice.utime = 1'000 + std::int64_t{id};
  slice.resolution_m = 0.01F;
  for (int i = 0; i < num_points; ++i) {
    CloudPoint p;
    p.x = static_cast<float>(id);
    p.y = static_cast<float>(i);
    p.ny = -1.0F;
    slice.points_W.push_back(p);
  }
  return slice;
}

SegmentUpdate update_of(std::int32_t slice_id, std::vector<std::uint32_t> labels,
                        std::vector<LabelRun> runs = {}) {
  SegmentUpdate update;
  update.session = kSegmenterSession;
  update.map_session = kMapSession;
  update.slice_id = slice_id;
  update.num_slices = slice_id + 1;
  update.num_segments = 5;
  update.labels = std::move(labels);
  update.runs = std::move(runs);
  return update;
}

void apply(ReceivedMap& map, SegmentUpdate update, std::int64_t sequence) {
  update.sequence = sequence;
  map.apply_update(update);
}

std::vector<std::uint32_t> labels_of(const ReceivedMap& map, std::int32_t id) {
  return map.slice(id)->labels();
}

using Labels = std::vector<std::uint32_t>;

TEST(ReceivedMap, IsEmptyAtFirst) {
  const ReceivedMap map(kMapSession);
  EXPECT_EQ(nullptr, map.slice(0));
  EXPECT_TRUE(map.chunks(0).empty());
  EXPECT_FALSE(map.received_track(0).X_WC.has_value());
  EXPECT_EQ(0, map.lag_slices());
}

TEST(ReceivedMap, LabelsItsPointsFromUpdatesAndRuns) {
  ReceivedMap map(kMapSession);
  map.add_slice(slice_of(0, 4));
  map.add_slice(slice_of(1, 2));
  EXPECT_EQ(Labels({0, 0, 0, 0}), labels_of(map, 0));
  EXPECT_EQ(2, map.lag_slices());

  apply(map, update_of(0, {1, 1, 2, 2}), 0);
  apply(map, update_of(1, {2, 3}, {{0, 1, 2, 3}}), 1);
  EXPECT_EQ(Labels({1, 3, 3, 2}), labels_of(map, 0));
  EXPECT_EQ(Labels({2, 3}), labels_of(map, 1));
  EXPECT_EQ(0, map.lag_slices());
  EXPECT_EQ(5, map.counts().segments);
  EXPECT_EQ(6, map.counts().points);
}

/// A run of a segmenter: slices arrive, some of them again with a higher revision and another
/// number of points. Each gets random labels, and random runs of older points change their labels.
struct RandomRun {
  std::vector<CloudSlice> slices;
  std::vector<SegmentUpdate> updates;           ///< one for each of slices
  std::map<std::int32_t, Labels> truth;         ///< after all updates in their order
  std::map<std::int32_t, std::int32_t> newest;  ///< revision of each slice

  explicit RandomRun(unsigned seed) : random_(seed) {
    for (std::int32_t step = 0; step < 60; ++step) {
      const bool is_correction = !truth.empty() && below(2) == 0;
      const auto id =
          static_cast<std::int32_t>(is_correction ? below(std::ssize(truth)) : std::ssize(truth));
      const std::int32_t revision = is_correction ? newest[id] + 1 + below(2) : 0;
      slices.push_back(slice_of(id, below(50), revision));
      newest[id] = revision;
      truth[id] = Labels(slices.back().points_W.size());
      for (auto& label : truth[id]) label = random_label();
      updates.push_back(update_of(id, truth[id], change_older_labels(id)));
      updates.back().slice_revision = revision;
      updates.back().num_slices = static_cast<std::int32_t>(std::ssize(truth));
    }
  }

 private:
  std::int32_t below(std::int64_t end) {
    return std::uniform_int_distribution<std::int32_t>(0,
                                                       static_cast<std::int32_t>(end - 1))(random_);
  }
  std::uint32_t random_label() { return static_cast<std::uint32_t>(1 + below(9)); }

  std::vector<LabelRun> change_older_labels(std::int32_t newest_id) {
    std::vector<LabelRun> runs;
    for (int i = 0; i < 20; ++i) {
      const std::int32_t id = below(std::ssize(truth));
      Labels& labels = truth[id];
      if (id == newest_id || labels.empty()) continue;
      const std::int32_t first = below(std::ssize(labels));
      const std::int32_t count = 1 + below(std::ssize(labels) - first);
      const std::uint32_t label = random_label();
      runs.push_back({id, first, count, label, newest[id]});
      std::fill_n(labels.begin() + first, count, label);
    }
    return runs;
  }

  std::mt19937 random_;
};

TEST(ReceivedMap, EndsWithTheSameLabelsInWhateverOrderSlicesRevisionsAndUpdatesArrive) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    const RandomRun run(seed);
    const auto count = static_cast<int>(run.slices.size());
    std::vector<int> order;  // i: slice i; i + count: update i; each twice
    for (int round = 0; round < 2; ++round) {
      const auto old_size = static_cast<std::ptrdiff_t>(order.size());
      order.resize(order.size() + 2 * run.slices.size());
      std::iota(order.begin() + old_size, order.end(), 0);
    }
    std::mt19937 random(seed + 100);
    std::ranges::shuffle(order, random);

    ReceivedMap map(kMapSession);
    for (const int i : order) {
      if (i < count) {
        map.add_slice(run.slices[static_cast<std::size_t>(i)]);
      } else {
        apply(map, run.updates[static_cast<std::size_t>(i - count)], i - count);
      }
    }
    std::int64_t num_points = 0;
    for (const auto& [id, labels] : run.truth) {
      EXPECT_EQ(labels, labels_of(map, id)) << "slice " << id << ", seed " << seed;
      EXPECT_EQ(run.newest.at(id), map.slice(id)->revision());
      num_points += std::ssize(labels);
    }
    EXPECT_EQ(num_points, map.counts().points);  // none of earlier revisions
    EXPECT_EQ(std::ssize(run.truth), map.counts().labelled_slices);
    EXPECT_EQ(0, map.lag_slices());
    const MapCounts& counts = map.counts();
    EXPECT_EQ(2 * count, counts.updates + counts.repeated_updates + counts.ignored_updates);
    EXPECT_EQ(0, map.counts().ignored_runs);
  }
}

TEST(ReceivedMap, IgnoresAndCountsRunsOutsideTheirSlice) {
  ReceivedMap map(kMapSession);
  map.add_slice(slice_of(0, 3));
  apply(map,
        update_of(0, {1, 1, 1},
                  {{0, 2, 2, 7},
                   {0, -1, 2, 7},
                   {0, 0, 0, 7},
                   {0, 0, -5, 7},
                   {0, 3, 1, 7},
                   {0, 2147483647, 2147483647, 7}}),
        0);
  EXPECT_EQ(Labels({1, 1, 1}), labels_of(map, 0));
  EXPECT_EQ(6, map.counts().ignored_runs);
}

TEST(ReceivedMap, SurvivesUpdatesThatNameAbsurdSlices) {
  constexpr std::int32_t kMax = std::numeric_limits<std::int32_t>::max();
  constexpr std::int32_t kMin = std::numeric_limits<std::int32_t>::min();
  ReceivedMap map(kMapSession);
  map.add_slice(slice_of(0, 3));
  std::int64_t sequence = 0;
  for (const std::int32_t id : {kMin, -1, 0, 1, kMax}) {
    for (const std::int32_t revision : {kMin, -1, 0, 1, kMax}) {
      SegmentUpdate update = update_of(
          0, {1, 1, 1},
          {{id, kMin, kMax, 7, revision}, {id, kMax, kMax, 7, revision}, {id, 1, 1, 7, revision}});
      update.slice_id = id;
      update.slice_revision = revision;
      update.num_slices = id;
      update.num_segments = std::numeric_limits<std::int64_t>::max();
      apply(map, update, sequence++);
    }
  }
  EXPECT_EQ(Labels({1, 7, 1}), labels_of(map, 0));
  for (const std::int32_t id : {kMin, -1, 1, kMax}) map.add_slice(slice_of(id, 1, kMax));
  EXPECT_EQ(1, map.counts().labelled_slices);  // the others: three labels for one point
  EXPECT_GE(map.lag_slices(), 4);
}

TEST(ReceivedMap, KeepsRunsForSlicesThatHaveNotCome) {
  ReceivedMap map(kMapSession);
  apply(map, update_of(7, {1}, {{3, 0, 2, 9}, {99, 0, 1, 9}}), 0);
  EXPECT_EQ(8, map.lag_slices());
  map.add_slice(slice_of(3, 3));
  EXPECT_EQ(Labels({9, 9, 0}), labels_of(map, 3));
}

TEST(ReceivedMap, IgnoresAndCountsUpdatesOfAnotherMapOrOfAnotherLength) {
  ReceivedMap map(kMapSession);
  map.add_slice(slice_of(0, 3));
  SegmentUpdate other = update_of(0, {1, 1, 1});
  other.map_session = kMapSession + 1;
  apply(map, other, 0);
  apply(map, update_of(0, {1, 1}), 0);
  EXPECT_EQ(Labels({0, 0, 0}), labels_of(map, 0));
  EXPECT_EQ(2, map.counts().ignored_updates);
  EXPECT_EQ(0, map.counts().updates);
}

TEST(ReceivedMap, ReplacesASliceByItsHigherRevision) {
  ReceivedMap map(kMapSession);
  map.add_slice(slice_of(0, 3));
  apply(map, update_of(0, {1, 1, 1}), 0);
  SegmentUpdate revised = update_of(0, {4, 4});
  revised.slice_revision = 2;
  apply(map, revised, 1);  // before its slice
  EXPECT_EQ(Labels({1, 1, 1}), labels_of(map, 0));

  map.add_slice(slice_of(0, 2, 2));
  map.add_slice(slice_of(0, 3, 1));  // late
  EXPECT_EQ(Labels({4, 4}), labels_of(map, 0));
  EXPECT_EQ(2, map.counts().points);
  EXPECT_EQ(1, map.counts().slices);
  EXPECT_EQ(1, map.counts().labelled_slices);
  EXPECT_EQ(1, map.counts().ignored_slices);
}

TEST(ReceivedMap, KeepsRunsForARevisionThatUpdatesHaveOvertaken) {
  ReceivedMap map(kMapSession);
  map.add_slice(slice_of(0, 3));
  apply(map, update_of(0, {1, 1, 1}), 0);
  SegmentUpdate revised = update_of(0, {4, 4, 4});
  revised.slice_revision = 1;
  apply(map, revised, 1);
  apply(map, update_of(1, {}, {{0, 1, 2, 6, 1}, {0, 0, 1, 9, 0}}), 2);
  EXPECT_EQ(Labels({9, 1, 1}), labels_of(map, 0));  // still those of the first revision
  EXPECT_EQ(2, map.lag_slices());                   // slice 1, and the revision of slice 0
  map.add_slice(slice_of(0, 3, 1));
  EXPECT_EQ(Labels({4, 6, 6}), labels_of(map, 0));
  EXPECT_EQ(1, map.lag_slices());
  apply(map, update_of(2, {}, {{0, 0, 3, 8, 0}}), 3);  // of the replaced revision
  EXPECT_EQ(Labels({4, 6, 6}), labels_of(map, 0));
}

TEST(ReceivedMap, IgnoresUpdatesOutsideTheNumbersOfAStream) {
  ReceivedMap map(kMapSession);
  map.add_slice(slice_of(0, 1));
  apply(map, update_of(0, {1}), -1);
  apply(map, update_of(0, {1}), std::int64_t{1} << 40U);
  EXPECT_EQ(Labels({0}), labels_of(map, 0));
  EXPECT_EQ(2, map.counts().ignored_updates);
}

TEST(ReceivedMap, StartsTheLabelsAnewWithANewSegmenter) {
  ReceivedMap map(kMapSession);
  map.add_slice(slice_of(0, 2));
  map.add_slice(slice_of(1, 2));
  apply(map, update_of(0, {1, 1}), 8);
  apply(map, update_of(1, {1, 1}), 9);
  SegmentUpdate restarted = update_of(0, {5, 5});
  restarted.session = kSegmenterSession + 1;
  apply(map, restarted, 0);
  EXPECT_EQ(Labels({5, 5}), labels_of(map, 0));
  EXPECT_EQ(Labels({1, 1}), labels_of(map, 1));  // visible until the new labels arrive
  EXPECT_EQ(1, map.lag_slices());
  EXPECT_EQ(2, map.counts().labellings);  // nothing was labelled for the first time

  apply(map, update_of(1, {3, 3}), 10);  // late, from the replaced segmenter
  EXPECT_EQ(Labels({1, 1}), labels_of(map, 1));
  EXPECT_EQ(1, map.counts().ignored_updates);

  SegmentUpdate run = update_of(0, {5, 5}, {{1, 0, 1, 6}});
  run.session = restarted.session;
  apply(map, run, 1);
  map.settle();
  EXPECT_EQ(Labels({5, 5}), labels_of(map, 0));
  EXPECT_EQ(Labels({6, 0}), labels_of(map, 1));
}

TEST(ReceivedMap, LearnsNothingFromADescriptionOfWhatItShows) {
  const RandomRun run(3);
  ReceivedMap map(kMapSession);
  for (const CloudSlice& slice : run.slices) map.add_slice(slice);
  std::int64_t sequence = 0;
  for (const SegmentUpdate& update : run.updates) apply(map, update, sequence++);
  const MapCounts before = map.counts();

  for (int round = 0; round < 2; ++round) {
    std::int32_t num_slices = 0;
    for (const auto& [id, labels] : run.truth) {
      SegmentUpdate description = update_of(id, labels);
      description.slice_revision = run.newest.at(id);
      description.num_slices = ++num_slices;
      description.sequence = sequence++;
      EXPECT_FALSE(map.apply_update(description)) << id;
      EXPECT_EQ(0, map.lag_slices());
    }
  }
  EXPECT_EQ(before.updates, map.counts().updates);
  EXPECT_EQ(before.labellings, map.counts().labellings);
  EXPECT_EQ(2 * std::ssize(run.truth), map.counts().repeated_updates);
}

TEST(ReceivedMap, IsTheSameFromADescriptionAsFromAllThatWentBefore) {
  const RandomRun run(4);
  ReceivedMap there(kMapSession);
  ReceivedMap late(kMapSession);
  std::int64_t sequence = 0;
  for (const SegmentUpdate& update : run.updates) apply(there, update, sequence++);
  std::int32_t num_slices = 0;
  for (const auto& [id, labels] : run.truth) {
    SegmentUpdate description = update_of(id, labels);
    description.slice_revision = run.newest.at(id);
    description.num_slices = ++num_slices;
    apply(late, description, sequence);
    apply(there, description, sequence++);
  }
  for (auto slice = run.slices.rbegin(); slice != run.slices.rend(); ++slice) {
    late.add_slice(*slice);
    there.add_slice(*slice);
  }
  for (const auto& [id, labels] : run.truth) {
    EXPECT_EQ(labels, labels_of(there, id));
    EXPECT_EQ(labels, labels_of(late, id));
  }
  EXPECT_EQ(0, late.lag_slices());
  EXPECT_EQ(there.counts().labelled_slices, late.counts().labelled_slices);
}

SegmentUpdate update_of_revision(std::int32_t id, std::int32_t revision, Labels labels) {
  SegmentUpdate update = update_of(id, std::move(labels));
  update.slice_revision = revision;
  return update;
}

TEST(ReceivedMap, ShowsARevisionWithItsSegmentsUntilTheNextHasThem) {
  ReceivedMap map(kMapSession);
  map.add_slice(slice_of(0, 3));
  apply(map, update_of(0, {1, 1, 2}), 0);
  map.add_slice(slice_of(0, 4, 1));
  EXPECT_EQ(Labels({1, 1, 2}), labels_of(map, 0));
  EXPECT_EQ(3, map.counts().points);
  EXPECT_EQ(1, map.lag_slices());

  apply(map, update_of(1, {}, {{0, 0, 1, 5, 0}, {0, 3, 1, 6, 1}}), 1);  // of both revisions
  EXPECT_EQ(Labels({5, 1, 2}), labels_of(map, 0));
  map.add_slice(slice_of(1, 0));
  apply(map, update_of_revision(0, 1, {2, 2, 2, 2}), 0);  // late: the run of revision 1 is newer
  EXPECT_EQ(Labels({2, 2, 2, 6}), labels_of(map, 0));
  EXPECT_EQ(4, map.counts().points);
  EXPECT_EQ(4U, map.chunks(0).front().points_W.size());
  EXPECT_EQ(0, map.lag_slices());
}

TEST(ReceivedMap, ShowsRevisionsInWhateverStepsTheirSegmentsCome) {
  ReceivedMap map(kMapSession);
  map.add_slice(slice_of(0, 1));
  apply(map, update_of(0, {1}), 0);
  for (std::int32_t revision = 1; revision <= 20; ++revision) {
    map.add_slice(slice_of(0, revision + 1, revision));
  }
  EXPECT_EQ(Labels({1}), labels_of(map, 0));
  apply(map, update_of_revision(0, 18, Labels(19, 4)), 1);  // the segmenter is behind
  EXPECT_EQ(Labels(19, 4), labels_of(map, 0));
  EXPECT_EQ(1, map.lag_slices());
  apply(map, update_of_revision(0, 17, Labels(18, 3)), 2);  // of a revision before
  EXPECT_EQ(Labels(19, 4), labels_of(map, 0));
  apply(map, update_of_revision(0, 20, Labels(21, 5)), 3);
  EXPECT_EQ(Labels(21, 5), labels_of(map, 0));
  EXPECT_EQ(0, map.lag_slices());
  EXPECT_EQ(21, map.counts().points);
  EXPECT_EQ(1, map.counts().labelled_slices);
}

TEST(ReceivedMap, ShowsTheNewestRevisionWithoutASegmenterAndWhenItIsSettled) {
  ReceivedMap map(kMapSession);
  map.add_slice(slice_of(0, 3));
  map.add_slice(slice_of(0, 4, 1));
  EXPECT_EQ(Labels(4), labels_of(map, 0));  // nothing was labelled: nothing to keep
  apply(map, update_of_revision(0, 1, {1, 1, 1, 1}), 0);
  map.add_slice(slice_of(0, 5, 2));
  EXPECT_EQ(4, map.counts().points);
  map.settle();
  EXPECT_EQ(Labels(5), labels_of(map, 0));
  EXPECT_EQ(5, map.counts().points);
}

TEST(ReceivedMap, CountsWhatMayStillChange) {
  ReceivedMap map(kMapSession);
  CloudSlice patch = slice_of(0, 3);
  patch.in_volume = true;
  map.add_slice(patch);
  map.add_slice(slice_of(1, 2));
  EXPECT_EQ(3, map.points(0).in_volume);
  apply(map, update_of(0, {1, 1, 1}), 0);
  map.add_slice(slice_of(0, 3, 1));
  EXPECT_EQ(3, map.points(0).in_volume);  // what is shown
  apply(map, update_of_revision(0, 1, {1, 1, 1}), 1);
  EXPECT_EQ(0, map.points(0).in_volume);
  EXPECT_EQ(5, map.counts().points);
}

TEST(ReceivedMap, LacksSlicesAndRevisionsThatTheFinalSliceTellsOf) {
  ReceivedMap map(kMapSession);
  CloudSlice final_slice = slice_of(2, 0);
  final_slice.kind = SliceKind::kFinal;
  final_slice.revision_sum = 3;
  map.add_slice(slice_of(0, 1, 1));
  map.add_slice(final_slice);
  apply(map, update_of_revision(0, 1, {1}), 0);
  apply(map, update_of(2, {}), 1);
  EXPECT_GE(map.lag_slices(), 1);  // slice 1
  map.add_slice(slice_of(1, 1));
  apply(map, update_of(1, {1}), 2);
  EXPECT_EQ(1, map.lag_slices());  // two revisions, of whatever slice
  map.add_slice(slice_of(1, 1, 2));
  EXPECT_EQ(1, map.lag_slices());
  apply(map, update_of_revision(1, 2, {1}), 3);
  EXPECT_EQ(0, map.lag_slices());
}

TEST(ReceivedMap, CutsSlicesIntoChunksThatHoldEveryPointOnceInItsBox) {
  ReceivedMap map(kMapSession);
  map.add_slice(slice_of(0, static_cast<int>(2 * PointChunk::kMaxPoints + 1)));
  map.add_slice(slice_of(5, 3));
  const std::vector<PointChunk> chunks = map.chunks(0);
  ASSERT_EQ(4U, chunks.size());
  std::size_t total = 0;
  for (const PointChunk& chunk : chunks) {
    EXPECT_LE(chunk.points_W.size(), PointChunk::kMaxPoints);
    EXPECT_EQ(chunk.points_W.size(), chunk.labels.size());
    total += chunk.points_W.size();
    for (const CloudPoint& p : chunk.points_W) {
      EXPECT_TRUE(chunk.box_W.contains(Eigen::Vector3f(p.x, p.y, p.z)));
    }
  }
  EXPECT_EQ(2 * PointChunk::kMaxPoints + 4, total);
  EXPECT_EQ(5.0F, chunks.back().box_W.max().x());
}

CameraPose pose_at(std::int64_t utime, double z_m) {
  CameraPose pose;
  pose.state = TrackingState::kTracking;
  pose.utime = utime;
  pose.X_WC.translation().z() = z_m;
  return pose;
}

TEST(ReceivedMap, FollowsTheCameraWhileItIsTracked) {
  ReceivedMap map(kMapSession);
  for (int i = 0; i <= 100; ++i) EXPECT_TRUE(map.add_pose(pose_at(1'000 + i, 0.01 * i)));
  CameraPose lost = pose_at(2'000, 5.0);
  lost.state = TrackingState::kLost;
  EXPECT_FALSE(map.add_pose(lost));
  EXPECT_FALSE(map.add_pose(pose_at(1'050, 5.0)));  // late
  const CameraTrack track = map.received_track(0);
  EXPECT_DOUBLE_EQ(1.0, track.X_WC->translation().z());
  EXPECT_EQ(100, map.utime() - map.first_utime());
  // 1 m in steps of at least 2 cm; rounding may make a step 3 cm.
  EXPECT_GE(track.path_W.size(), 34U);
  EXPECT_LE(track.path_W.size(), 51U);
}

TEST(ReceivedMap, TakesThePosesOfTheSlicesWhereNoneWasHeard) {
  constexpr std::int64_t kSecond_us = 1'000'000;
  ReceivedMap map(kMapSession);
  for (const std::int32_t id : {3, 0, 2, 1}) {  // at 0, 1, 2 and 3 s
    CloudSlice slice = slice_of(id, 1);
    slice.utime = id * kSecond_us;
    slice.X_WC.translation() = Eigen::Vector3d(100.0, 0.0, id);  // apart from the received path
    map.add_slice(slice);
  }
  for (int i = 8; i <= 22; ++i) {  // received from 0.8 s to 2.2 s
    map.add_pose(pose_at(i * kSecond_us / 10, 0.1 * i));
  }
  const CameraTrack track = map.received_track(0);
  ASSERT_EQ(17U, track.path_W.size());
  EXPECT_EQ(Eigen::Vector3f(100.0F, 0.0F, 0.0F), track.path_W.front());
  for (std::size_t i = 1; i + 1 < track.path_W.size(); ++i) EXPECT_EQ(0.0F, track.path_W[i].x());
  EXPECT_EQ(Eigen::Vector3f(100.0F, 0.0F, 3.0F), track.path_W.back());
  EXPECT_EQ(3.0, track.X_WC->translation().z());  // newer than the received poses
  EXPECT_EQ(0, map.first_utime());

  const CameraTrack known = map.slice_track(0);
  ASSERT_EQ(4U, known.path_W.size());
  for (int i = 0; i < 4; ++i) EXPECT_EQ(static_cast<float>(i), known.path_W[i].z());
}

TEST(PendingUpdates, KeepsNoMoreThanItsBoundWhateverSlicesAreNamed) {
  constexpr std::size_t kMaxBytes = 10'000;
  PendingUpdates pending(kMaxBytes);
  std::mt19937 random(1);
  std::uniform_int_distribution<std::int32_t> any(0, INT32_MAX);
  int kept = 0;
  for (int i = 0; i < 1'000; ++i) kept += pending.add({{any(random), 0, 1, 7, any(random)}, 0});
  EXPECT_GT(kept, 0);
  EXPECT_LT(kept, 1'000);
  EXPECT_LE(pending.bytes(), kMaxBytes);
  EXPECT_EQ(UpdateEffect::kNotUsable, pending.add({1, 0}, {Labels(1'000), 0}));
  pending.clear();
  EXPECT_EQ(0U, pending.bytes());
  EXPECT_EQ(UpdateEffect::kChanged, pending.add({1, 0}, {Labels(1'000), 5}));
  EXPECT_EQ(UpdateEffect::kNothingNew, pending.add({1, 0}, {Labels(1'000), 6}));
  EXPECT_EQ(UpdateEffect::kNothingNew, pending.add({1, 0}, {Labels(1'000, 3), 4}));
  EXPECT_EQ(UpdateEffect::kChanged, pending.add({1, 0}, {Labels(2'000, 3), 7}));
  pending.take_up_to({1, 0}, [](SliceKey, const PendingUpdates::Entry& entry) {
    EXPECT_EQ(Labels(2'000, 3), entry.labels->labels);
  });
  EXPECT_EQ(0U, pending.bytes());
}

CloudSlice correction_of(std::int32_t id, std::int32_t number, std::int32_t patch, double x) {
  CloudSlice slice = slice_of(id, 0);
  slice.kind = SliceKind::kCorrection;
  slice.correction = number;
  Pose X_WP = Pose::Identity();
  X_WP.translation().x() = x;
  slice.motions = {{patch, X_WP}};
  return slice;
}

TEST(ReceivedMap, HasTheLoopsOfThePartsNewestCorrection) {
  const auto with_loops = [](std::int32_t number, std::int32_t part, std::vector<LoopLink> loops) {
    CloudSlice slice = correction_of(10 * part + number, number, 0, 0.5);
    slice.part = part;
    slice.loops = std::move(loops);
    return slice;
  };
  const LoopLink a{.later = 7, .earlier = 1};
  const LoopLink b{.later = 8, .earlier = 2};
  ReceivedMap map(kMapSession);
  map.add_slice(with_loops(2, 0, {a, b}));
  map.add_slice(with_loops(1, 0, {a}));  // late
  map.add_slice(with_loops(1, 1, {b}));
  EXPECT_EQ(map.slice_track(0).loops, (std::vector{a, b}));
  EXPECT_EQ(map.received_track(1).loops, (std::vector{b}));
  EXPECT_TRUE(map.slice_track(2).loops.empty());
}

TEST(ReceivedMap, PutsPatchesWhereTheLastCorrectionDoesInWhateverOrder) {
  std::vector<CloudSlice> stream = {slice_of(0, 3),
                                    slice_of(0, 5, 1),
                                    slice_of(1, 2),
                                    correction_of(2, 1, 0, 0.5),
                                    correction_of(3, 2, 0, 1.5),
                                    correction_of(4, 3, 1, 2.5)};
  stream[1].correction = 1;
  std::mt19937 random(2);
  for (int round = 0; round < 50; ++round) {
    std::ranges::shuffle(stream, random);
    ReceivedMap map(kMapSession);
    for (const CloudSlice& slice : stream) map.add_slice(slice);
    ASSERT_EQ(map.slice(0)->points_W().size(), 5U);
    EXPECT_EQ(map.slice(0)->points_W()[0].x, 1.5F);
    EXPECT_EQ(map.slice(1)->points_W()[0].x, 1.0F + 2.5F);
    EXPECT_EQ(map.counts().points, 7);
    for (const PointChunk& chunk : map.chunks(0)) {
      EXPECT_EQ(chunk.box_W.min().x(), chunk.points_W[0].x) << "it is drawn where it is";
    }
  }
}

/// `num_points` points of a patch in a part, whose points lie at x = id + 1000 part.
CloudSlice patch_in_part(std::int32_t id, std::int32_t part, int num_points) {
  CloudSlice slice = slice_of(id, num_points);
  slice.part = part;
  slice.X_WP.t_WP[0] = 1000.0F * static_cast<float>(part);
  slice.X_WC.translation().x() = 1000.0 * part;
  return slice;
}

/// Brings a patch of part 1 into part 0.
CloudSlice correction_that_joins(std::int32_t id, std::int32_t patch) {
  CloudSlice slice = correction_of(id, 1, patch, 5.0);
  slice.part = 0;
  return slice;
}

CameraPose pose_in_part(std::int32_t part, std::int64_t utime) {
  CameraPose pose = pose_at(utime, 0.0);
  pose.part = part;
  pose.X_WC.translation().x() = 1000.0 * part;
  return pose;
}

std::int64_t num_points(const std::vector<PointChunk>& chunks) {
  std::int64_t count = 0;
  for (const PointChunk& chunk : chunks) count += std::ssize(chunk.points_W);
  return count;
}

TEST(ReceivedMap, KeepsThePartsOfTheMapApart) {
  ReceivedMap map(kMapSession);
  EXPECT_TRUE(map.parts().empty());
  map.add_slice(patch_in_part(0, 0, 3));
  CloudSlice in_volume = patch_in_part(1, 1, 5);
  in_volume.in_volume = true;
  for (CloudPoint& point : in_volume.points_W) {
    point.ny = -0.96F;
    point.nx = 0.28F;
  }
  map.add_slice(in_volume);
  EXPECT_EQ(map.parts(), (std::set<std::int32_t>{0, 1}));
  EXPECT_EQ(map.counts().points, 8);
  EXPECT_EQ(map.points(0).shown, 3);
  EXPECT_EQ(map.points(0).in_volume, 0);
  EXPECT_EQ(map.points(1).shown, 5);
  EXPECT_EQ(map.points(1).in_volume, 5);
  EXPECT_EQ(map.points(2).shown, 0);
  ASSERT_EQ(map.chunks(1).size(), 1U);
  EXPECT_EQ(map.chunks(1).front().points_W[0].x, 1001.0F);
  EXPECT_EQ(num_points(map.chunks(0)), 3);
  EXPECT_TRUE(map.chunks(2).empty());
  EXPECT_NEAR(map.up(0).up_W().x(), 0.0, 1e-6);
  EXPECT_NEAR(map.up(1).up_W().x(), 0.28, 1e-3);
  EXPECT_EQ(map.up(2).up_W(), -Eigen::Vector3d::UnitY());
}

TEST(ReceivedMap, PosesBelongToThePartInWhichTheyWereReceived) {
  ReceivedMap map(kMapSession);
  map.add_slice(patch_in_part(0, 0, 3));
  map.add_slice(patch_in_part(1, 1, 3));
  EXPECT_TRUE(map.add_pose(pose_in_part(0, 500)));
  EXPECT_TRUE(map.add_pose(pose_in_part(1, 2'000)));
  for (const std::int32_t part : {0, 1}) {
    for (const CameraTrack& track : {map.received_track(part), map.slice_track(part)}) {
      ASSERT_FALSE(track.path_W.empty());
      for (const Eigen::Vector3f& p_W : track.path_W) {
        EXPECT_EQ(p_W.x(), 1000.0F * static_cast<float>(part));
      }
      EXPECT_EQ(track.X_WC->translation().x(), 1000.0 * part);
    }
    EXPECT_EQ(map.received_track(part).path_W.size(), 2U);
  }
  EXPECT_TRUE(map.received_track(2).path_W.empty());
  map.add_slice(correction_that_joins(2, 1));
  EXPECT_EQ(map.slice_track(0).path_W.size(), 2U)
      << "with that of the correction, but not of slice 1";
  for (const Eigen::Vector3f& p_W : map.received_track(0).path_W) EXPECT_EQ(p_W.x(), 0.0F);
}

TEST(ReceivedMap, ShowsThePartInWhichTheCameraIs) {
  ReceivedMap map(kMapSession);
  EXPECT_EQ(map.camera_part(), 0);
  map.add_slice(patch_in_part(0, 0, 3));
  map.add_slice(patch_in_part(1, 1, 3));
  EXPECT_EQ(map.camera_part(), 1) << "that of the newest slice, as there is no pose";
  map.add_pose(pose_in_part(0, 500));
  EXPECT_EQ(map.camera_part(), 0);
  EXPECT_EQ(map.newest_part(), 1) << "whatever poses came";
  map.add_pose(pose_in_part(1, 600));
  EXPECT_EQ(map.camera_part(), 1);
  map.add_pose(pose_in_part(2, 700));
  EXPECT_EQ(map.camera_part(), 1) << "there is nothing in part 2 yet";
  map.add_slice(patch_in_part(2, 2, 0));
  EXPECT_EQ(map.camera_part(), 1) << "nor in a slice without points";
  map.add_slice(patch_in_part(3, 2, 1));
  EXPECT_EQ(map.camera_part(), 2);
  map.add_pose(pose_in_part(0, 800));
  EXPECT_EQ(map.camera_part(), 0);
  EXPECT_EQ(map.newest_part(), 2);
}

TEST(ReceivedMap, APartThatIsJoinedIsShownInTheOtherInWhateverOrder) {
  CloudSlice revision = patch_in_part(2, 1, 7);
  revision.revision = 1;
  CloudSlice after = patch_in_part(3, 0, 11);  // of a patch of part 1, sent after the loop
  after.correction = 1;
  CloudSlice joins = correction_that_joins(4, 1);
  joins.motions.push_back({2, joins.motions[0].X_WP});
  std::vector<CloudSlice> stream = {patch_in_part(0, 0, 3), patch_in_part(1, 1, 5),
                                    patch_in_part(2, 1, 2), revision,
                                    patch_in_part(3, 1, 9), joins};
  after.revision = 1;
  stream.push_back(after);
  std::mt19937 random(3);
  for (int round = 0; round < 50; ++round) {
    std::ranges::shuffle(stream, random);
    ReceivedMap map(kMapSession);
    for (std::size_t i = 0; i < stream.size(); ++i) {
      if (i == 2) map.add_pose(pose_in_part(1, 500));
      map.add_slice(stream[i]);
    }
    EXPECT_EQ(map.parts(), std::set<std::int32_t>{0});
    EXPECT_EQ(map.points(0).shown, 3 + 5 + 7 + 11);
    EXPECT_EQ(num_points(map.chunks(0)), 3 + 5 + 7 + 11);
    EXPECT_EQ(map.camera_part(), 0) << "part 1 is no more, whatever the newest pose says";
    EXPECT_EQ(map.newest_part(), 0);
    EXPECT_EQ(map.slice(1)->points_W()[0].x, 1.0F + 5.0F);
    EXPECT_EQ(map.received_track(0).path_W.size(), 3U) << "without poses of part 1";
  }
}

TEST(ReceivedMap, MovedPatchesKeepTheirLabels) {
  ReceivedMap map(kMapSession);
  map.add_slice(slice_of(0, 3));
  apply(map, update_of(0, {1, 2, 2}), 0);
  map.add_slice(correction_of(1, 1, 0, 0.5));
  EXPECT_EQ(Labels({1, 2, 2}), labels_of(map, 0));
  EXPECT_EQ(map.slice(0)->points_W()[0].x, 0.5F);
}

}  // namespace
}  // namespace kintsugi::viewer
