// A map in a file: going on with it is going on with the map; a file that is no map is refused.

#include <algorithm>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <random>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>

#include "segmenter/core/make_engine.hpp"
#include "segmenter/io/saved_map.hpp"
#include "tests/segmenter/changed_parameters.hpp"
#include "tests/segmenter/process/slice_session.hpp"
#include "tests/support/allocation_limit.hpp"
#include "tests/support/message_equality.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter {
namespace {

using kintsugi::testing::allocated_by;
using kintsugi::testing::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

/// Groups of slices as they are segmented: first each once, then corrections among new ones.
std::vector<std::vector<CloudSlice>> session_with_corrections() {
  std::mt19937 random(4);
  const auto slices = testing::wavy_session(9, 130);
  std::vector<std::vector<CloudSlice>> groups;
  for (std::size_t i = 0; i < slices.size(); ++i) {
    groups.push_back({slices[i]});
    groups.back()[0].points_W[i].x = NAN;
    if (i < 3) continue;
    std::vector<CloudSlice>& corrections = groups.emplace_back();
    for (const std::size_t j : {i - 1, i - 3}) {
      CloudSlice& slice = corrections.emplace_back(slices[j]);
      slice.revision = static_cast<std::int32_t>(i);
      slice.points_W.resize(100 + random() % 30);
      for (CloudPoint& point : slice.points_W) {
        point.z += 0.004F * static_cast<float>(random() % 3);
        if (random() % 30 == 0) point.ny = 2.0F;
      }
    }
  }
  return groups;
}

SegmentMapConfig config_of(std::string_view mode) {
  SegmentMapConfig config;
  config.mode = mode;
  config.engine.threshold = 0.002;
  return config;
}

void expect_same(const SegmentMap& a, const SegmentMap& b) {
  EXPECT_EQ(testing::labels_of(a), testing::labels_of(b));
  EXPECT_EQ(a.statistics().all(), b.statistics().all());
  EXPECT_EQ(a.statistics().last_changes(), b.statistics().last_changes());
  EXPECT_EQ(a.segment_ids().next_id(), b.segment_ids().next_id());
  EXPECT_EQ(a.is_complete(), b.is_complete());
  for (const SegmentStatistics& segment : a.statistics().all()) {
    EXPECT_EQ(a.theta(segment.segment_id), b.theta(segment.segment_id));
  }
}

class SavedMap : public ::testing::TestWithParam<std::string_view> {};

TEST_P(SavedMap, GoesOnAsIfItHadNeverBeenSaved) {
  const TemporaryFolder folder;
  const auto groups = session_with_corrections();
  SegmentMap map(config_of(GetParam()), 99, groups[0][0]);
  std::vector<std::unique_ptr<SegmentMap>> resumed;  // at each step so far
  for (const auto& group : groups) {
    write_map_state(map.state(), folder / "map");
    resumed.push_back(load_map(folder / "map"));
    expect_same(*resumed.back(), map);
    const auto updates = map.add(group);
    for (const auto& other : resumed) {
      EXPECT_EQ(other->add(group), updates);
    }
  }
  write_map_state(map.state(), folder / "map");
  const std::string bytes = contents(folder / "map");
  for (const auto& other : resumed) {
    expect_same(*other, map);
    write_map_state(other->state(), folder / "other");
    EXPECT_EQ(contents(folder / "other"), bytes);
  }
  EXPECT_TRUE(map.is_complete());
}

TEST_P(SavedMap, KeepsWhatItIs) {
  const TemporaryFolder folder;
  auto slices = testing::wavy_session(3, 50);
  slices[1].points_W.clear();
  slices[2].revision = 8;
  slices[2].revision_sum = 9;  // one revision is missing
  slices[0].kind = slices[1].kind = SliceKind::kPatch;
  slices[1].in_volume = true;
  slices[0].part = 3;
  SegmentMapConfig config = config_of(GetParam());
  config.engine.neighbour_search = NeighbourSearch::kFlann;
  SegmentMap map(config, 99, slices[0]);
  map.add(slices);
  write_map_state(map.state(), folder / "map");
  const auto loaded = load_map(folder / "map");
  EXPECT_EQ(loaded->session(), 99);
  EXPECT_EQ(loaded->map_session(), 5);
  EXPECT_EQ(loaded->map_name(), "map");
  EXPECT_EQ(loaded->config().mode, GetParam());
  EXPECT_EQ(loaded->config().engine.threshold, 0.002);
  EXPECT_EQ(loaded->config().engine.resolution_m, static_cast<double>(0.01F));
  EXPECT_EQ(loaded->config().engine.neighbour_search, NeighbourSearch::kFlann);
  EXPECT_TRUE(loaded->has_final_slice());
  ASSERT_EQ(loaded->cloud().slices().size(), 3U);
  EXPECT_EQ(loaded->cloud().slices()[2].revision, 8);
  EXPECT_EQ(loaded->cloud().slices()[0].patch, PatchState::kLeft);
  EXPECT_EQ(loaded->cloud().slices()[0].place.part, 3);
  EXPECT_EQ(loaded->cloud().slices()[1].place.part, 0);
  EXPECT_EQ(loaded->cloud().slices()[1].patch, PatchState::kInVolume);
  EXPECT_EQ(loaded->cloud().slices()[2].patch, PatchState::kNoPatch);
  EXPECT_FALSE(loaded->is_complete());
  slices[0].revision = 1;
  loaded->add({slices.data(), 1});
  EXPECT_TRUE(loaded->is_complete());
  EXPECT_THROW(loaded->add(slices), std::invalid_argument);  // they are in it
}

TEST(SavedMapState, KeepsEveryParameterThatDecidesThePartition) {
  const TemporaryFolder folder;
  for (const auto& [changed, engine] : testing::changed_parameters()) {
    SegmentMapState state;
    state.config.engine = engine;
    write_map_state(state, folder / "map");
    const EngineConfig read = read_map_state(folder / "map").config.engine;
    for (const EngineParameter& parameter : kMapParameters) {
      EXPECT_EQ(read.*parameter.value, engine.*parameter.value)
          << parameter.name << " where " << changed.name << " was changed";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Modes, SavedMap,
                         ::testing::ValuesIn(engine_modes().begin(), engine_modes().end()));

/// A state of two slices with one rejected point, and a file of it.
class SavedMapFile : public ::testing::Test {
 protected:
  SavedMapFile() {
    auto slices = testing::wavy_session(2, 5);
    slices[0].points_W[3].x = NAN;
    SegmentMap map(config_of("voting"), 99, slices[0]);
    map.add(slices);
    state_ = map.state();
    write_map_state(state_, path_);
    bytes_ = contents(path_);
  }

  void expect_refused(const std::string& bytes) {
    write(path_, bytes);
    EXPECT_THAT([&] { load_map(path_); },
                ThrowsMessage<std::runtime_error>(HasSubstr("'" + path_.string() + "'")));
  }
  /// Written as it is, with a right checksum.
  void expect_refused(const std::function<void(SegmentMapState&)>& spoil,
                      const std::string& reason) {
    SegmentMapState state = state_;
    spoil(state);
    write_map_state(state, path_);
    EXPECT_THAT([&] { load_map(path_); },
                ThrowsMessage<std::runtime_error>(
                    AllOf(HasSubstr("'" + path_.string() + "'"), HasSubstr(reason))));
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "map";
  SegmentMapState state_;
  std::string bytes_;
};

TEST_F(SavedMapFile, IsTheSameBytesForTheSameState) {
  write_map_state(read_map_state(path_), folder_ / "again");
  EXPECT_EQ(contents(folder_ / "again"), bytes_);
  EXPECT_NO_THROW(load_map(path_));
}

TEST_F(SavedMapFile, IsRefusedWithAnyByteDamaged) {
  for (std::size_t i = 0; i < bytes_.size(); ++i) {
    std::string damaged = bytes_;
    damaged[i] = static_cast<char>(damaged[i] ^ (1 << (i % 8)));
    expect_refused(damaged);
  }
}

TEST_F(SavedMapFile, IsRefusedWhenCutOffAnywhereOrTooLong) {
  for (std::size_t size = 0; size < bytes_.size(); ++size) expect_refused(bytes_.substr(0, size));
  expect_refused(bytes_ + '\0');
  expect_refused(bytes_ + bytes_);
}

TEST_F(SavedMapFile, ReasonsSayWhatWasExpected) {
  const auto reason = [&](const std::string& bytes) {
    write(path_, bytes);
    try {
      load_map(path_);
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(reason("ply\nformat ascii 1.0\nand so on"),
              AllOf(HasSubstr("no saved segment map"), HasSubstr("KSEGMAP")));
  std::string newer = bytes_;
  newer[8] = 8;
  EXPECT_THAT(reason(newer), AllOf(HasSubstr("version 8"), HasSubstr("expected 7")));
  std::string older = bytes_;
  older[8] = 6;
  EXPECT_THAT(reason(older), AllOf(HasSubstr("version 6"), HasSubstr("expected 7")));
  EXPECT_THAT(reason(bytes_.substr(0, bytes_.size() - 3)), HasSubstr("cut off"));
  std::string damaged = bytes_;
  damaged[200] ^= 1;
  EXPECT_THAT(reason(damaged), HasSubstr("checksum"));
  std::filesystem::remove(path_);
  EXPECT_THAT([&] { load_map(path_); }, ThrowsMessage<std::runtime_error>(HasSubstr("No such")));
  EXPECT_THAT([&] { load_map(folder_.path()); },
              ThrowsMessage<std::runtime_error>(HasSubstr("cannot read")));
}

TEST_F(SavedMapFile, ClaimsAreHeldAgainstItsSizeBeforeMemoryIsTaken) {
  // Each count of the header, which ends at byte 144, claims two billion.
  for (std::size_t at = 104; at < 140; at += 4) {
    std::string hostile = bytes_;
    const std::uint32_t count = 2'000'000'000;
    std::memcpy(hostile.data() + at, &count, sizeof(count));
    write(path_, hostile);
    EXPECT_LT(allocated_by([&] { EXPECT_THROW(load_map(path_), std::runtime_error); }), 100'000U);
    write(path_, hostile.substr(0, 144));
    EXPECT_LT(allocated_by([&] { EXPECT_THROW(load_map(path_), std::runtime_error); }), 100'000U);
  }
}

TEST_F(SavedMapFile, IsRefusedWhenItIsNoStateOfAMap) {
  expect_refused([](auto& s) { s.final_revision_sum = -1; }, "final_revision_sum is -1");
  expect_refused([](auto& s) { s.slices[1].patch = static_cast<PatchState>(3); },
                 "slice 1 has the patch state 3");
  expect_refused([](auto& s) { s.config.mode = "spectral"; }, "mode is 'spectral'");
  expect_refused([](auto& s) { s.config.engine.threshold = -1; }, "threshold is -1");
  expect_refused([](auto& s) { s.config.engine.resolution_m = NAN; }, "resolution_m");
  expect_refused([](auto& s) { s.slices[1].slice_id = 0; }, "slice_id 0 is in the cloud already");
  expect_refused([](auto& s) { s.slices[1].slice_id = -1; }, "slice_id is -1");
  expect_refused([](auto& s) { s.slices[0].rejected[0] = 5; }, "slice 0 has 5 points");
  expect_refused([](auto& s) { s.slices[0].rejected[0] = -1; }, "slice 0 has 5 points");
  expect_refused([](auto& s) { s.slices[0].num_points = 7; }, "");
  expect_refused([](auto& s) { s.slices[0].num_points = -7; }, "of -7 points");
  expect_refused([](auto& s) { s.points_W[2].y = NAN; },
                 "slice 0 has an accepted point that is inadmissible");
  expect_refused([](auto& s) { s.final_slice_id = 4; }, "the final slice 4");
  expect_refused([](auto& s) { s.last_changes.pop_back(); }, "last changes");
  expect_refused([](auto& s) { s.last_changes[0].slice_id = 2; }, "changed with slice 2");
  expect_refused([](auto& s) { s.thetas.pop_back(); }, "thetas");
  expect_refused([](auto& s) { s.thetas[0] = NAN; }, "theta");
  expect_refused([](auto& s) { s.thetas[0] = 1.0; }, "theta");
  state_.config.mode = "batch";
  expect_refused([](auto& s) { s.segment_ids[2] = kNoSegment; }, "point 2 of segment 0");
  expect_refused([](auto& s) { s.segment_ids[2] = s.next_id; }, "must be in 1 to");
  expect_refused([](auto& s) { s.next_id = 0; }, "must be in 1 to");
  expect_refused([](auto& s) { s.next_id = s.segment_ids[0]; }, "must be in 1 to");
  expect_refused([](auto& s) { s.segment_ids[0] = s.next_id++; }, "other segments");
  expect_refused([](auto& s) { s.points_W[0].x += 1.0F; }, "other segments");
}

TEST_F(SavedMapFile, StaysWhenItCannotBeReplaced) {
  std::filesystem::create_directory(folder_ / "map.partial");  // where the new file would be made
  EXPECT_THAT([&] { write_map_state(state_, path_); },
              ThrowsMessage<std::runtime_error>(HasSubstr(path_.string())));
  EXPECT_EQ(contents(path_), bytes_);
}

}  // namespace
}  // namespace kintsugi::segmenter
