// A stream of patches with losses, duplicates and disorder, through a session: in the end the map
// is what batch makes of the newest revisions.

#include <algorithm>
#include <map>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "segmenter/core/make_engine.hpp"
#include "segmenter/session/session_map.hpp"
#include "tests/segmenter/process/slice_session.hpp"

namespace kintsugi::segmenter {
namespace {

using std::chrono::seconds;
using testing::LabelMirror;
using testing::Labels;

constexpr float kTile_m = 0.1F;

/// A wavy sheet that is scanned: batches of patches, then the final slice.
class ScannedSheet {
 public:
  explicit ScannedSheet(unsigned seed)
      : random_(seed), points_W_(testing::random_cloud(testing::CloudShape::kWaves, 1200, seed)) {
    for (std::int64_t utime = 1; utime <= 12; ++utime) add_batch(utime);
    CloudSlice last = slice_of(13);
    last.id = static_cast<std::int32_t>(newest_.size());
    for (const auto& [tile, patch] : newest_) last.revision_sum += patch.revision;
    stream_.push_back(last);
  }

  [[nodiscard]] const std::vector<CloudSlice>& stream() const { return stream_; }
  [[nodiscard]] std::vector<CloudSlice> newest() const {
    std::vector<CloudSlice> slices = {stream_.back()};
    for (const auto& [tile, patch] : newest_) slices.push_back(patch);
    return slices;
  }

 private:
  static CloudSlice slice_of(std::int64_t utime) {
    CloudSlice slice;
    slice.utime = utime;
    slice.session = 5;
    slice.map_name = "map";
    slice.resolution_m = 0.01F;
    return slice;
  }

  /// The patches in a window that moves along x, some of their points missing, all a bit elsewhere.
  void add_batch(std::int64_t utime) {
    std::uniform_real_distribution<float> noise(-0.002F, 0.002F);
    const float begin_m = 0.02F * static_cast<float>(utime) - 0.1F;
    std::map<int, std::vector<CloudPoint>> tiles;
    for (CloudPoint p : points_W_) {
      const int tile = static_cast<int>(p.x / kTile_m) * 100 + static_cast<int>(p.y / kTile_m);
      if (p.x < begin_m || p.x > begin_m + 0.25F) continue;
      if (random_() % 10 == 0) continue;
      p.x += noise(random_);
      p.y += noise(random_);
      tiles[tile].push_back(p);
    }
    for (auto& [tile, points_W] : tiles) {
      std::ranges::shuffle(points_W, random_);
      const bool is_new = !newest_.contains(tile);
      CloudSlice& patch = newest_[tile];
      const std::int32_t id = is_new ? static_cast<std::int32_t>(newest_.size()) - 1 : patch.id;
      const auto step = 1 + static_cast<std::int32_t>(random_() % 2);  // some are never sent
      const std::int32_t revision = is_new ? 0 : patch.revision + step;
      patch = slice_of(utime);
      patch.id = id;
      patch.revision = revision;
      patch.kind = SliceKind::kPatch;
      patch.in_volume = random_() % 4 != 0;
      patch.points_W = std::move(points_W);
      stream_.push_back(patch);
    }
    stream_.back().ends_batch = random_() % 5 != 0;
  }

  std::mt19937 random_;
  std::vector<CloudPoint> points_W_;
  std::map<int, CloudSlice> newest_;  // by tile
  std::vector<CloudSlice> stream_;
};

class PatchStream : public ::testing::TestWithParam<std::string> {
 protected:
  static std::unique_ptr<SegmentMap> new_map(const std::string& mode, const CloudSlice& slice) {
    SegmentMapConfig config;
    config.mode = mode;
    config.engine.min_points = 20;
    return std::make_unique<SegmentMap>(config, 9, slice);
  }
  static SessionMap session_of(std::unique_ptr<SegmentMap> map, bool is_live) {
    SessionMap::Config config;
    config.order.is_live = is_live;
    return {config, std::move(map)};
  }

  void run(SessionMap& session, Outlook outlook = Outlook::kSilent) {
    while (true) {
      const StepResult result = session.step(now_, outlook);
      for (const SegmentUpdate& update : result.updates) mirror_.apply(update);
      EXPECT_TRUE(result.warnings.empty());
      if (!result.has_progressed) return;
    }
  }
  void expect_newest(const SessionMap& session, const ScannedSheet& sheet) {
    EXPECT_TRUE(session.counts().complete);
    EXPECT_TRUE(session.counts().ended);
    EXPECT_EQ(session.counts().missing, 0);
    EXPECT_EQ(session.counts().lag, 0);
    EXPECT_EQ(mirror_.labels(), testing::labels_of(session.segment_map()));
    EXPECT_EQ(mirror_.statistics(), session.segment_map().statistics().all());
    const auto batch = new_map("batch", sheet.stream()[0]);
    batch->add(sheet.newest());
    EXPECT_TRUE(testing::same_partition(testing::labels_of(session.segment_map()),
                                        testing::labels_of(*batch)));
  }

  SessionMap::Clock::time_point now_{seconds(1000)};
  LabelMirror mirror_;
};

INSTANTIATE_TEST_SUITE_P(Modes, PatchStream, ::testing::Values("exact", "batch"),
                         [](const auto& mode) { return mode.param; });

TEST_P(PatchStream, EndsWithTheNewestRevisionsWhateverHappens) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    const ScannedSheet sheet(seed);
    std::mt19937 random(seed);
    std::vector<CloudSlice> stream = sheet.stream();
    for (std::size_t i = stream.size(); i > 0; --i) {
      if (random() % 4 == 0) stream.push_back(stream[random() % stream.size()]);
    }
    for (std::size_t i = 0; i < stream.size(); ++i) {
      std::swap(stream[i], stream[std::min(i + random() % 8, stream.size() - 1)]);
    }
    mirror_ = {};
    SessionMap session = session_of(new_map(GetParam(), stream[0]), seed % 2 == 0);
    for (const CloudSlice& slice : stream) {
      session.offer(slice, now_);
      now_ += std::chrono::milliseconds(random() % 100);
      if (random() % 4 == 0) run(session);
    }
    run(session);
    now_ += seconds(1);
    run(session);
    expect_newest(session, sheet);
  }
}

TEST_P(PatchStream, IsContinuedFromASavedState) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const ScannedSheet sheet(seed);
    std::mt19937 random(seed);
    SessionMap first = session_of(new_map(GetParam(), sheet.stream()[0]), true);
    for (std::size_t i = random() % sheet.stream().size(); i > 0; --i) {
      if (random() % 5 > 0) first.offer(sheet.stream()[i], now_);
      run(first);
    }
    auto map = std::make_unique<SegmentMap>(first.segment_map().state());
    mirror_ = {};
    for (const SegmentUpdate& update : map->describe()) mirror_.apply(update);
    SessionMap second = session_of(std::move(map), true);
    for (const CloudSlice& slice : sheet.stream()) {
      second.offer(slice, now_);
      run(second);
    }
    expect_newest(second, sheet);
  }
}

TEST(PatchStreamIds, DependOnTheOrderOfArrivalAndNotOnTimingUnlessLive) {
  const ScannedSheet sheet(1);
  std::mt19937 random(1);
  std::vector<Labels> labels;
  for (const unsigned steps_in_8 : {0U, 1U, 8U}) {
    SegmentMapConfig config;
    SessionMap session({}, std::make_unique<SegmentMap>(config, 9, sheet.stream()[0]));
    auto now = SessionMap::Clock::time_point(seconds(1000));
    for (const CloudSlice& slice : sheet.stream()) {
      session.offer(slice, now += seconds(2));
      while (random() % 8 < steps_in_8 && session.step(now, Outlook::kSilent).has_progressed) {
      }
    }
    while (session.step(now, Outlook::kEnded).has_progressed) {
    }
    labels.push_back(testing::labels_of(session.segment_map()));
  }
  EXPECT_EQ(labels[0], labels[1]);
  EXPECT_EQ(labels[0], labels[2]);
}

TEST(PatchStreamChunks, OfReplacedRevisionsAreNotWantedAgain) {
  const auto patch = [](std::int32_t revision, bool ends_batch) {
    CloudSlice slice = testing::wavy_session(1, 20)[0];
    slice.kind = SliceKind::kPatch;
    slice.revision = revision;
    slice.utime = 1 + revision;
    slice.ends_batch = ends_batch;
    slice.sequence = revision;
    slice.num_chunks = 1;
    return slice;
  };
  SessionMap session({}, std::make_unique<SegmentMap>(SegmentMapConfig{}, 9, patch(0, false)));
  const SessionMap::Clock::time_point now(seconds(1000));
  session.offer(patch(0, false), now);
  session.offer(patch(1, false), now);
  session.offer(patch(2, true), now);
  EXPECT_EQ(session.step(now, Outlook::kSilent).updates.size(), 1U);
  EXPECT_EQ(session.segment_map().chunks().ranges(), (std::vector<SequenceRange>{{0, 2}}));
}

}  // namespace
}  // namespace kintsugi::segmenter
