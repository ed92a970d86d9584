// Several mapper sessions at a time, without bus and files.

#include <algorithm>
#include <iterator>
#include <map>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segmenter/session/session_maps.hpp"
#include "tests/segmenter/process/slice_session.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::Labels;
using testing::wavy_session;

std::vector<CloudSlice> named_session(const std::string& name, std::int64_t session,
                                      int num_slices = 4, unsigned seed = 1) {
  auto slices = wavy_session(num_slices, 100, session, seed);
  for (CloudSlice& slice : slices) {
    slice.map_name = name;
  }
  return slices;
}

/// What a segmenter makes of one session when there is no other.
Labels labels_alone(const std::vector<CloudSlice>& slices) {
  SegmentMap map({}, 99, slices.front());
  for (const CloudSlice& slice : slices) {
    map.add({&slice, 1});
  }
  return testing::labels_of(map);
}

class SessionMapsTest : public ::testing::Test {
 protected:
  struct Saved {
    std::int64_t session;
    Labels labels;
    SaveKind kind;
  };

  SessionMaps make(const SessionMaps::Config& config = {}, SwapSpace* swap = nullptr) {
    return {config, 99,
            [this](std::int64_t session) {
              const bool is_coming = coming_.contains(session);
              return StreamState{is_coming ? Outlook::kLive : Outlook::kSilent, !is_coming};
            },
            swap};
  }

  bool step(SessionMaps& maps) {
    const StepResult result = maps.step(now_);
    for (const SegmentUpdate& update : result.updates) mirrors_[update.map_session].apply(update);
    for (const auto& [map, kind] : result.saves) {
      saves_.push_back({map->map_session(), testing::labels_of(*map), kind});
    }
    std::ranges::copy(result.warnings, std::back_inserter(warnings_));
    if (result.ended_session) forgotten_.insert(*result.ended_session);
    return result.has_progressed;
  }
  void run(SessionMaps& maps) {
    while (step(maps)) {
    }
  }
  void offer(SessionMaps& maps, const CloudSlice& slice) {
    std::ranges::copy(maps.offer(slice, now_), std::back_inserter(warnings_));
    run(maps);
  }
  void settle(SessionMaps& maps) {
    now_ += seconds(2);
    run(maps);
  }

  SessionMaps::Clock::time_point now_{seconds(1000)};
  std::set<std::int64_t> coming_;  // sessions of which something missing is being sent again
  std::set<std::int64_t> forgotten_;
  std::map<std::int64_t, testing::LabelMirror> mirrors_;
  std::vector<Saved> saves_;
  std::vector<std::string> warnings_;
};

TEST_F(SessionMapsTest, LateSlicesOfAnOlderSessionGoIntoItsOwnMap) {
  const auto older = named_session("map", 5, 4, 1);
  const auto newer = named_session("map", 6, 4, 2);
  SessionMaps maps = make();
  offer(maps, older[0]);
  offer(maps, older[2]);
  coming_.insert(5);  // 1 and 3 are missing when the new mapper begins
  offer(maps, newer[0]);
  EXPECT_EQ(maps.counts().maps, 2);
  EXPECT_THAT(warnings_,
              ElementsAre(AllOf(HasSubstr("session 6 now owns the map name 'map'"),
                                HasSubstr("session 5 receives only what is still missing"))));
  now_ += seconds(100);  // however long it takes
  offer(maps, newer[1]);
  offer(maps, older[3]);
  offer(maps, newer[2]);
  offer(maps, older[1]);
  EXPECT_THAT(forgotten_, IsEmpty());
  EXPECT_FALSE(maps.counts().complete);
  coming_.clear();
  settle(maps);
  EXPECT_THAT(forgotten_, ElementsAre(5));
  EXPECT_EQ(maps.counts().maps, 1);
  offer(maps, newer[3]);
  EXPECT_TRUE(maps.counts().complete);

  EXPECT_EQ(mirrors_[5].labels(), labels_alone(older));
  EXPECT_EQ(mirrors_[6].labels(), labels_alone(newer));
  ASSERT_GE(saves_.size(), 2U);
  const Saved& ended = saves_[saves_.size() - 2];
  EXPECT_EQ(ended.session, 5);
  EXPECT_EQ(ended.kind, SaveKind::kSessionEnded);
  EXPECT_EQ(ended.labels, labels_alone(older));
  EXPECT_EQ(saves_.back().session, 6);
  EXPECT_EQ(saves_.back().kind, SaveKind::kCurrent);
  EXPECT_EQ(maps.counts().missing, 0);
}

TEST_F(SessionMapsTest, ASessionThatBeganInALaterPartIsSupersededLikeAnyOther) {
  auto older = named_session("map", 5, 4, 1);
  for (CloudSlice& slice : older) slice.part = 1;
  SessionMaps maps = make();
  for (const CloudSlice& slice : older) offer(maps, slice);
  EXPECT_TRUE(maps.counts().ended);
  for (const CloudSlice& slice : named_session("map", 6, 4, 2)) offer(maps, slice);
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("session 6 now owns the map name 'map'")));
  settle(maps);
  EXPECT_EQ(saves_.back().session, 5);
  EXPECT_EQ(saves_.back().kind, SaveKind::kSessionEnded);
}

TEST_F(SessionMapsTest, AnOlderSessionThatIsHeardLaterHasAMapBesideTheNewer) {
  const auto older = named_session("map", 5, 4, 1);
  const auto newer = named_session("map", 6, 4, 2);
  SessionMaps maps = make();
  for (const CloudSlice& slice : newer) {
    offer(maps, slice);
  }
  for (const CloudSlice& slice : older) {
    offer(maps, slice);
    EXPECT_EQ(maps.counts().newest.map_session, 6);
  }
  settle(maps);
  EXPECT_EQ(saves_.back().session, 5);
  EXPECT_EQ(saves_.back().kind, SaveKind::kSessionEnded);  // not under the name of the newer
  EXPECT_EQ(saves_.back().labels, labels_alone(older));
  EXPECT_TRUE(maps.counts().complete);
}

TEST_F(SessionMapsTest, AnOlderSessionEndsWithoutWhatNobodySends) {
  const auto older = named_session("map", 5);
  SessionMaps maps = make();
  offer(maps, older[0]);
  offer(maps, older[2]);
  offer(maps, named_session("map", 6)[0]);
  settle(maps);
  EXPECT_THAT(forgotten_, IsEmpty());  // the gap is not given up yet
  now_ += seconds(10);
  run(maps);
  settle(maps);
  EXPECT_THAT(forgotten_, ElementsAre(5));
  EXPECT_EQ(maps.counts().missing, 1);
  EXPECT_EQ(saves_.back().labels.size(), 2U);
}

TEST_F(SessionMapsTest, SlicesOfAForgottenSessionAreDroppedAndEverMoreRarelyToldOf) {
  const auto older = named_session("map", 5);
  SessionMaps maps = make();
  offer(maps, older[0]);
  offer(maps, named_session("map", 6)[0]);
  settle(maps);
  warnings_.clear();
  for (int i = 0; i < 100; ++i) {
    offer(maps, older[1]);
  }
  EXPECT_EQ(maps.counts().dropped, 100);
  EXPECT_EQ(maps.counts().maps, 1);
  EXPECT_EQ(warnings_.size(), 7U);  // 1, 2, 4 ... 64
  EXPECT_THAT(warnings_.back(), HasSubstr("dropped 64 slices so far, the last: slice 1 of session "
                                          "5, because its session has ended"));
}

TEST_F(SessionMapsTest, TwoMappersOfOneNameMakeTwoMapsAndAreToldToTakeNames) {
  const auto a = named_session("map", 5, 6, 1);
  const auto b = named_session("map", 6, 6, 2);
  SessionMaps maps = make();
  for (std::size_t i = 0; i < a.size(); ++i) {
    now_ += seconds(1);
    offer(maps, a[i]);
    offer(maps, b[i]);
  }
  EXPECT_EQ(maps.counts().maps, 2);
  EXPECT_THAT(warnings_,
              ElementsAre(HasSubstr("Mappers that run at the same time need a --map-name each")));
  maps.close();
  run(maps);
  EXPECT_EQ(mirrors_[5].labels(), labels_alone(a));
  EXPECT_EQ(mirrors_[6].labels(), labels_alone(b));
}

TEST_F(SessionMapsTest, MapsOfDifferentNamesLiveSideBySide) {
  const auto office = named_session("office", 5, 6, 1);
  const auto kitchen = named_session("kitchen", 6, 6, 2);
  SessionMaps maps = make();
  for (std::size_t i = 0; i < office.size(); ++i) {
    offer(maps, office[i]);
    offer(maps, kitchen[i]);
    settle(maps);
  }
  EXPECT_EQ(maps.counts().maps, 2);
  EXPECT_TRUE(maps.counts().complete);
  EXPECT_THAT(warnings_, IsEmpty());
  EXPECT_EQ(mirrors_[5].labels(), labels_alone(office));
  EXPECT_EQ(mirrors_[6].labels(), labels_alone(kitchen));
}

TEST_F(SessionMapsTest, FollowsOnlyTheMapItIsToldTo) {
  SessionMaps::Config config;
  config.map_name = "office";
  SessionMaps maps = make(config);
  offer(maps, named_session("kitchen", 6)[0]);
  EXPECT_EQ(maps.counts().maps, 0);
  offer(maps, named_session("office", 5)[0]);
  ASSERT_EQ(maps.maps().size(), 1U);
  EXPECT_EQ(maps.maps()[0]->map_session(), 5);
}

TEST_F(SessionMapsTest, KeepsNoMoreMapsThanItMay) {
  SessionMaps::Config config;
  config.max_maps = 3;
  SessionMaps maps = make(config);
  for (int i = 0; i < 5; ++i) {
    offer(maps, named_session("map" + std::to_string(i), 5 + i)[0]);
  }
  EXPECT_EQ(maps.counts().maps, 3);
  EXPECT_EQ(maps.counts().dropped, 2);
  EXPECT_THAT(warnings_.front(), HasSubstr("at most 3 maps are kept"));
}

// Each reserves addresses for four billion points, also of what goes to disk.
TEST_F(SessionMapsTest, KeepsAsManyMapsAsItMay) {
  const kintsugi::testing::TemporaryFolder folder(kintsugi::testing::kOnDisk);
  SwapSpace space({folder.path(), std::size_t{1} << 50});
  SessionMaps maps = make({}, &space);
  constexpr int kMost = 64;
  for (int i = 0; i <= kMost; ++i) {
    for (const CloudSlice& slice : named_session("map" + std::to_string(i), 5 + i, 2)) {
      offer(maps, slice);
    }
  }
  EXPECT_EQ(maps.counts().maps, kMost);
  EXPECT_EQ(maps.counts().dropped, 2);
}

TEST_F(SessionMapsTest, AResumedMapOfAnotherSessionIsKeptUnderItsNumber) {
  const auto saved = named_session("map", 5);
  auto map = std::make_unique<SegmentMap>(SegmentMapConfig{}, 99, saved[0]);
  map->add({saved.data(), 2});
  const Labels labels = testing::labels_of(*map);
  SessionMaps maps = make();
  maps.resume(std::move(map));
  settle(maps);
  EXPECT_EQ(maps.counts().maps, 1);  // nobody has taken its place
  for (const CloudSlice& slice : named_session("map", 6)) {
    offer(maps, slice);
  }
  settle(maps);
  EXPECT_EQ(saves_.back().session, 5);
  EXPECT_EQ(saves_.back().kind, SaveKind::kSessionEnded);
  EXPECT_EQ(saves_.back().labels, labels);
  EXPECT_EQ(maps.counts().newest.map_session, 6);
  EXPECT_TRUE(maps.counts().complete);
}

TEST_F(SessionMapsTest, DescribesAllMaps) {
  const auto office = named_session("office", 5, 3, 1);
  const auto kitchen = named_session("kitchen", 6, 4, 2);
  SessionMaps maps = make();
  for (const auto& slices : {office, kitchen}) {
    for (const CloudSlice& slice : slices) {
      offer(maps, slice);
    }
  }
  mirrors_.clear();
  const auto state = maps.describe();
  EXPECT_EQ(state.size(), 7U);
  for (const SegmentUpdate& update : state) {
    mirrors_[update.map_session].apply(update);
  }
  EXPECT_EQ(mirrors_[5].labels(), labels_alone(office));
  EXPECT_EQ(mirrors_[6].labels(), labels_alone(kitchen));
}

TEST_F(SessionMapsTest, RefusesABadConfig) {
  SessionMaps::Config config;
  config.map.mode = "exhaustive";
  EXPECT_THROW(make(config), std::invalid_argument);
  config = {};
  config.map.engine.threshold = 0.0;
  EXPECT_THROW(make(config), std::invalid_argument);
  config = {};
  config.max_maps = 0;
  EXPECT_THROW(make(config), std::invalid_argument);
  config = {};
  config.settle = milliseconds(-1);
  EXPECT_THROW(make(config), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::segmenter
