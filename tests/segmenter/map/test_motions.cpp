// Corrections of the map: patches that move, in any order of arrival.

#include <algorithm>
#include <random>

#include <gmock/gmock.h>

#include "segmenter/core/parameters/presets.hpp"
#include "segmenter/io/saved_map.hpp"
#include "segmenter/map/map_snapshot.hpp"
#include "segmenter/map/segment_map.hpp"
#include "segmenter/map/slice_sequencer.hpp"
#include "tests/segmenter/process/slice_session.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter {
namespace {

using kintsugi::testing::TemporaryFolder;
using ::testing::IsEmpty;
using testing::LabelMirror;

constexpr int kPatchSide_vox = 12;

Pose pose(double angle_rad, double x_m, double y_m, double z_m) {
  Pose X = Pose::Identity();
  X.linear() = Eigen::AngleAxisd(angle_rad, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  X.translation() << x_m, y_m, z_m;
  return X;
}

/// A mapper that scans a wavy floor of 3 x 3 patches, revises them and corrects the map.
class CorrectingMapper {
 public:
  explicit CorrectingMapper(unsigned seed) : random_(seed) {
    for (int id = 0; id < 9; ++id) {
      patches_.push_back(slice(id, SliceKind::kPatch));
      revise(id, 0);
    }
  }

  void go_on(int num_steps) {
    for (int step = 0; step < num_steps; ++step) {
      if (random_() % 3 == 0) {
        correct();
      } else {
        const auto id = static_cast<std::int32_t>(random_() % patches_.size());
        revise(id, patches_[static_cast<std::size_t>(id)].revision + 1);
      }
    }
  }
  void finish() {
    CloudSlice last = slice(next_id_, SliceKind::kFinal);
    for (const CloudSlice& patch : patches_) last.revision_sum += patch.revision;
    sent_.push_back(last);
  }

  CloudSlice correct() {
    CloudSlice correction = slice(next_id_++, SliceKind::kCorrection);
    correction.correction = ++num_corrections_;
    std::uniform_real_distribution<double> small(-0.02, 0.02);
    for (CloudSlice& patch : patches_) {
      if (random_() % 3 == 0) continue;
      patch.X_WP = pose(small(random_), small(random_), small(random_), small(random_));
      correction.motions.push_back({patch.id, patch.X_WP});
    }
    for (CloudSlice& patch : patches_) patch.correction = num_corrections_;
    sent_.push_back(correction);
    return correction;
  }

  const std::vector<CloudSlice>& sent() const { return sent_; }

  /// What the map is in the end: every slice once, the patches with their points in W.
  std::vector<CloudSlice> result() const {
    std::vector<CloudSlice> slices = patches_;
    for (CloudSlice& patch : slices) {
      patch.points_W = moved(patch.points_W, patch.X_WP);
      patch.X_WP = {};
    }
    for (CloudSlice other : sent_) {
      if (other.kind == SliceKind::kPatch) continue;
      other.motions.clear();
      slices.push_back(other);
    }
    return slices;
  }

 private:
  CloudSlice slice(std::int32_t id, SliceKind kind) {
    CloudSlice slice;
    slice.utime = 1000 + std::ssize(sent_);
    slice.session = 5;
    slice.map_name = "map";
    slice.id = id;
    slice.kind = kind;
    slice.ends_batch = true;
    slice.resolution_m = 0.01F;
    return slice;
  }

  void revise(std::int32_t id, std::int32_t revision) {
    CloudSlice& patch = patches_[static_cast<std::size_t>(id)];
    patch.utime = 1000 + std::ssize(sent_);
    patch.revision = revision;
    patch.points_W.clear();
    std::uniform_real_distribution<double> noise(-0.004, 0.004);
    for (int i = 0; i < kPatchSide_vox; ++i) {
      for (int j = 0; j < kPatchSide_vox; ++j) {
        const double x = 0.01 * (kPatchSide_vox * (id % 3) + i) + noise(random_);
        const int row = id / 3;
        const double y = 0.01 * (kPatchSide_vox * row + j) + noise(random_);
        const double z = 0.03 * std::sin(20 * x) + noise(random_) / 4;
        const Eigen::Vector3d n = Eigen::Vector3d(-0.6 * std::cos(20 * x), 0, 1).normalized();
        patch.points_W.push_back(testing::make_point(x, y, z, n.x(), n.y(), n.z()));
      }
    }
    if (random_() % 2 == 0) patch.points_W[5].nx = NAN;  // rejected
    std::ranges::shuffle(patch.points_W, random_);
    sent_.push_back(patch);
  }

  std::mt19937 random_;
  std::vector<CloudSlice> patches_;
  std::vector<CloudSlice> sent_;
  std::int32_t next_id_ = 9;
  std::int32_t num_corrections_ = 0;
};

SegmentMapConfig config_of(const std::string& mode) {
  SegmentMapConfig config;
  config.mode = mode;
  config.engine = preset("objects");
  return config;
}

/// A segmenter that gets slices in some order, with a listener, and a copy of its map in a file.
struct Receiver {
  explicit Receiver(const CloudSlice& first)
      : map(std::make_unique<SegmentMap>(config_of("exact"), 9, first)) {}

  void receive(const CloudSlice& slice) {
    order.offer(slice, {});
    while (const auto group = order.pop({}, Outlook::kEnded)) {
      for (const SegmentUpdate& update : map->add(group->slices)) mirror.apply(update);
    }
  }
  void check() const {
    EXPECT_EQ(mirror.labels(), testing::labels_of(*map));
    EXPECT_EQ(mirror.statistics(), map->statistics().all());
    EXPECT_EQ(make_snapshot(map->state()).segments, map->statistics().all());
  }
  void restart(const std::filesystem::path& file) {
    write_map_state(map->state(), file);
    map = load_map(file);
  }

  SliceSequencer order{{}};
  std::unique_ptr<SegmentMap> map;
  LabelMirror mirror;
};

std::map<std::int32_t, std::vector<CloudPoint>> points_of(const SegmentMap& map) {
  std::map<std::int32_t, std::vector<CloudPoint>> points;
  for (const SliceRecord& slice : map.cloud().slices()) {
    const auto points_W = map.cloud().points_W().subspan(slice.first, slice.count);
    points[slice.slice_id].assign(points_W.begin(), points_W.end());
  }
  return points;
}

void expect_same(const SegmentMap& map, const SegmentMap& truth) {
  EXPECT_EQ(points_of(map), points_of(truth));
  EXPECT_TRUE(testing::same_partition(testing::labels_of(map), testing::labels_of(truth)));
  EXPECT_TRUE(map.is_complete());
}

TEST(Motions, TheMapEqualsBatchOnTheMovedPointsInEveryOrder) {
  const TemporaryFolder folder;
  for (unsigned seed = 0; seed < 12; ++seed) {
    CorrectingMapper mapper(seed);
    mapper.go_on(25);
    mapper.finish();
    const std::vector<CloudSlice> result = mapper.result();
    SegmentMap truth(config_of("batch"), 9, result[0]);
    truth.add(result);

    std::vector<CloudSlice> arriving = mapper.sent();
    std::mt19937 random(seed);
    if (seed > 0) {  // some twice, old revisions lost, in any order
      for (int i = 0; i < 6; ++i) arriving.push_back(arriving[random() % arriving.size()]);
      std::erase_if(arriving, [&](const CloudSlice& slice) {
        return slice.kind == SliceKind::kPatch && random() % 4 == 0 &&
               std::ranges::none_of(result, [&](const CloudSlice& newest) {
                 return newest.id == slice.id && newest.revision == slice.revision;
               });
      });
      std::ranges::shuffle(arriving, random);
    }
    Receiver receiver(result[0]);
    for (std::size_t i = 0; i < arriving.size(); ++i) {
      receiver.receive(arriving[i]);
      if (i % 8 == 3) receiver.check();
      if (i == arriving.size() / 2) receiver.restart(folder / "map");
    }
    receiver.check();
    expect_same(*receiver.map, truth);
    receiver.restart(folder / "map");
    expect_same(*receiver.map, truth);
  }
}

TEST(Motions, ARigidMotionOfTheWholeMapKeepsEverySegmentAndGivesNoEvent) {
  CorrectingMapper mapper(1);
  Receiver receiver(mapper.sent()[0]);
  for (const CloudSlice& slice : mapper.sent()) receiver.receive(slice);
  const auto before = testing::labels_of(*receiver.map);
  CloudSlice correction = mapper.sent()[0];
  correction.kind = SliceKind::kCorrection;
  correction.id = 9;
  correction.correction = 1;
  correction.points_W.clear();
  for (std::int32_t id = 0; id < 9; ++id) correction.motions.push_back({id, pose(0, 1.0, 0, 0)});
  const SegmentUpdate update = receiver.map->add({&correction, 1}).at(0);
  EXPECT_THAT(update.events, IsEmpty());
  EXPECT_THAT(update.labels, IsEmpty());
  EXPECT_EQ(update.statistics, receiver.map->statistics().all());
  auto after = testing::labels_of(*receiver.map);
  after.erase(9);
  EXPECT_EQ(after, before);
}

TEST(Motions, PatchesThatAreNotListedStayWhereTheyAre) {
  CorrectingMapper mapper(2);
  Receiver receiver(mapper.sent()[0]);
  for (const CloudSlice& slice : mapper.sent()) receiver.receive(slice);
  const auto before = points_of(*receiver.map);
  const std::vector<SliceRecord> records(receiver.map->cloud().slices().begin(),
                                         receiver.map->cloud().slices().end());
  const CloudSlice correction = mapper.correct();
  ASSERT_THAT(correction.motions.size(), ::testing::AllOf(::testing::Gt(0U), ::testing::Lt(9U)));
  receiver.receive(correction);
  auto after = points_of(*receiver.map);
  for (const SliceRecord& record : records) {
    const SliceRecord& now = *receiver.map->cloud().find_slice(record.slice_id);
    const bool is_listed =
        std::ranges::count(correction.motions, record.slice_id, &PatchMotion::id) > 0;
    EXPECT_EQ(after[record.slice_id] != before.at(record.slice_id), is_listed);
    EXPECT_EQ(now.place != record.place, is_listed);
  }
}

/// What listeners hear of an update.
void expect_same_news(const SegmentUpdate& update, const SegmentUpdate& other) {
  EXPECT_EQ(update.labels, other.labels);
  EXPECT_EQ(update.num_segments, other.num_segments);
  EXPECT_EQ(update.runs, other.runs);
  EXPECT_EQ(update.statistics, other.statistics);
  EXPECT_EQ(update.events, other.events);
}

// Where a correction moves much, points keep their indices and the engine starts anew; where it
// moves little, points come and go. Nobody can tell the difference, and both equal batch after
// every slice (the audit throws otherwise).
TEST(Motions, PointsThatMoveInPlaceAndPointsThatComeAndGoGiveTheSameUpdates) {
  for (const bool has_fragments : {true, false}) {
    for (unsigned seed = 0; seed < 6; ++seed) {
      CorrectingMapper mapper(seed);
      mapper.go_on(25);
      mapper.finish();
      SegmentMapConfig config = config_of("exact");
      config.engine.audit = true;
      if (!has_fragments) config.engine.min_points = 0.0;
      config.engine.rebuild_share = 0.0;
      SegmentMap in_place(config, 9, mapper.sent()[0]);
      config.engine.rebuild_share = 1e9;
      SegmentMap coming_and_going(config, 9, mapper.sent()[0]);
      for (const CloudSlice& slice : mapper.sent()) {
        expect_same_news(in_place.add({&slice, 1}).at(0), coming_and_going.add({&slice, 1}).at(0));
        EXPECT_EQ(in_place.statistics().all(), coming_and_going.statistics().all());
        EXPECT_EQ(in_place.statistics().last_changes(),
                  coming_and_going.statistics().last_changes());
      }
      EXPECT_EQ(points_of(in_place), points_of(coming_and_going));
    }
  }
}

TEST(Motions, APatchMayMoveInPlaceAndBeRevisedInOneUpdate) {
  CorrectingMapper mapper(4);
  SegmentMapConfig config = config_of("exact");
  config.engine.audit = true;
  SegmentMap map(config, 9, mapper.sent()[0]);
  const std::vector<CloudSlice> first = mapper.sent();
  map.add(first);
  mapper.correct();
  mapper.go_on(6);
  const std::vector<CloudSlice> later(mapper.sent().begin() + std::ssize(first),
                                      mapper.sent().end());
  std::vector<CloudSlice> together;  // the newest revision of each
  for (const CloudSlice& slice : later) {
    std::erase_if(together, [&](const CloudSlice& other) { return other.id == slice.id; });
    together.push_back(slice);
  }
  ASSERT_GT(std::ranges::count(together, SliceKind::kPatch, &CloudSlice::kind), 0);
  map.add(together);
  const std::vector<CloudSlice> result = mapper.result();
  SegmentMap truth(config_of("batch"), 9, result[0]);
  truth.add(result);
  EXPECT_EQ(points_of(map), points_of(truth));
  EXPECT_TRUE(testing::same_partition(testing::labels_of(map), testing::labels_of(truth)));
  EXPECT_EQ(make_snapshot(map.state()).segments, map.statistics().all());
}

TEST(Motions, InModeBatchPointsMoveInPlaceTooAndInModeVotingTheyComeAndGo) {
  for (const char* const mode : {"batch", "voting"}) {
    CorrectingMapper mapper(5);
    SegmentMap map(config_of(mode), 9, mapper.sent()[0]);
    map.add(mapper.sent());
    const std::vector<SliceRecord> before(map.cloud().slices().begin(), map.cloud().slices().end());
    const CloudSlice correction = mapper.correct();
    map.add({&correction, 1});
    for (const PatchMotion& motion : correction.motions) {
      const SliceRecord& now = *map.cloud().find_slice(motion.id);
      const auto was = std::ranges::find(before, motion.id, &SliceRecord::slice_id);
      EXPECT_EQ(now.first == was->first, std::string(mode) == "batch");
    }
    EXPECT_EQ(make_snapshot(map.state()).segments, map.statistics().all());
  }
}

TEST(Motions, ACorrectionIsAGroupOfItsOwnAndWaitsForNothing) {
  CorrectingMapper mapper(3);
  CloudSlice patch = mapper.sent()[7];
  patch.ends_batch = false;
  CloudSlice correction = mapper.correct();
  SliceSequencer order{{}};
  order.offer(patch, {});
  EXPECT_FALSE(order.pop({}, Outlook::kLive));
  EXPECT_EQ(order.offer(correction, {}), SliceSequencer::Verdict::kTaken);
  EXPECT_EQ(order.offer(correction, {}), SliceSequencer::Verdict::kDuplicate);
  EXPECT_EQ(order.pop({}, Outlook::kLive).value().slices.at(0).id, patch.id);
  EXPECT_EQ(order.pop({}, Outlook::kLive).value().slices.at(0).id, correction.id);
  EXPECT_EQ(order.num_waiting(), 0);
  EXPECT_EQ(order.num_missing(), 8);  // the other patches
}

}  // namespace
}  // namespace kintsugi::segmenter
