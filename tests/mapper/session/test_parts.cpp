// The built program and a camera that is suddenly in another room: the map goes on in another part,
// on the bus, in the files, in the log and when it is resumed.

#include <algorithm>
#include <fstream>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/trajectory.hpp"
#include "mapper/session/stored_sessions.hpp"
#include "tests/mapper/process/mapper_program.hpp"
#include "tests/mapper/process/stored_run.hpp"
#include "tests/mapper/process/two_rooms.hpp"
#include "tests/support/private_bus.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::mapper {
namespace {

using ::testing::HasSubstr;
using testing::kFramesInEachRoom;
using testing::Listener;
using testing::MapperProgram;
using testing::read_stored_run;
using testing::StoredRun;

using Flags = std::vector<std::string>;
constexpr int kNumFrames = 2 * kFramesInEachRoom;
constexpr int kNumLost = 6;  // 0.2 s; the frame after them begins part 1

class Parts : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    rooms_ = new kintsugi::testing::TemporaryFolder;
    testing::write_two_rooms(rooms_->path());
  }
  static void TearDownTestSuite() { delete rooms_; }
  void SetUp() override {
    static const auto why_not = kintsugi::testing::enter_private_bus();
    if (why_not) GTEST_SKIP() << *why_not;
  }

  /// Those that map the recording, with `more` (each with its value) instead of or besides them.
  static Flags flags(const Flags& more) {
    Flags flags = testing::map_two_rooms(rooms_->path());
    for (std::size_t i = 0; i < more.size(); i += 2) {
      const auto given = std::ranges::find(flags, more[i]);
      if (given == flags.end()) {
        flags.insert(flags.end(), {more[i], more[i + 1]});
      } else {
        *std::next(given) = more[i + 1];
      }
    }
    return flags;
  }
  int run(const Flags& more) const {
    return MapperProgram(flags(more), folder_ / "said.txt").wait();
  }
  std::string said() const {
    std::ifstream in(folder_ / "said.txt");
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::size_t poses_in(const std::string& file) const {
    std::ifstream in(folder_ / file);
    return read_tum(in, file).size();
  }

  /// `log` as it was after the first event on `channel` for which `is_last` is true.
  template <class Predicate>
  void cut_after(const std::string& log, const std::string& to, Predicate is_last) const {
    std::filesystem::copy_file(folder_ / log, folder_ / to);
    LogReader reader(folder_ / log);
    while (const auto event = reader.next()) {
      if (!is_last(*event)) continue;
      std::filesystem::resize_file(folder_ / to, static_cast<std::uintmax_t>(reader.bytes_read()));
      return;
    }
    ADD_FAILURE() << "there is no such event";
  }

  static kintsugi::testing::TemporaryFolder* rooms_;
  const kintsugi::testing::TemporaryFolder folder_;
};

kintsugi::testing::TemporaryFolder* Parts::rooms_ = nullptr;

TEST_F(Parts, ACameraThatStaysLostBeginsAnotherPartFarAway) {
  const Listener listener;
  EXPECT_EQ(run({}), 0);
  ASSERT_TRUE(Listener::wait_until([&] { return listener.heard_the_end(); }));

  const auto poses = listener.poses();
  constexpr std::size_t first_of_part1 = kFramesInEachRoom + kNumLost;
  ASSERT_EQ(poses.size(), static_cast<std::size_t>(kNumFrames));
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(poses[i].session, 7);
    EXPECT_EQ(poses[i].part, i < first_of_part1 ? 0 : 1) << i;
    const bool is_lost = i >= kFramesInEachRoom && i < first_of_part1;
    EXPECT_EQ(poses[i].state, is_lost ? TrackingState::kLost : TrackingState::kTracking) << i;
    const double distance_m = (poses[i].X_WC.translation() - poses[0].X_WC.translation()).norm();
    EXPECT_EQ(distance_m > 500.0, poses[i].part == 1) << i;
  }

  const std::vector<CloudSlice> slices = listener.slices();
  EXPECT_EQ(slices.back().kind, SliceKind::kFinal);
  EXPECT_TRUE(testing::ids_have_no_gap(slices));
  std::set<std::int32_t> parts;
  for (const CloudSlice& slice : slices) {
    if (slice.points_W.empty()) continue;
    parts.insert(slice.part);
    EXPECT_EQ(slice.points_W.front().x > 500.0F, slice.part == 1);
    EXPECT_EQ(slice.X_WC.translation().x() > 500.0, slice.part == 1);
  }
  EXPECT_EQ(parts, (std::set<std::int32_t>{0, 1}));
  const MapperStatus status = listener.statuses().back();
  EXPECT_EQ(status.part, 1);
  EXPECT_EQ(status.parts, 2);
  EXPECT_EQ(status.frames_read, kNumFrames);
  EXPECT_EQ(status.frames_lost, kNumLost);
  EXPECT_EQ(status.frames_relocalised, 0) << "it never was in the second room before";
}

TEST_F(Parts, EveryPartHasFilesAndTheSummaryNamesThem) {
  EXPECT_EQ(run({"--cloud", folder_ / "cloud.ply", "--mesh", folder_ / "mesh.ply",
                 "--output-trajectory", folder_ / "path.txt", "--timings", folder_ / "times.csv"}),
            0);
  for (const char* file : {"cloud.ply", "cloud.part1.ply", "mesh.ply", "mesh.part1.ply"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / file)) << file;
  }
  EXPECT_EQ(poses_in("path.txt"), static_cast<std::size_t>(kFramesInEachRoom));
  EXPECT_EQ(poses_in("path.part1.txt"), static_cast<std::size_t>(kFramesInEachRoom - kNumLost));
  std::ifstream times(folder_ / "times.csv");
  int frames_of_part1 = 0;
  for (std::string line; std::getline(times, line);) {
    frames_of_part1 += line.find(",1,tracking,") != std::string::npos ? 1 : 0;
  }
  EXPECT_EQ(frames_of_part1, kFramesInEachRoom - kNumLost);
  EXPECT_THAT(said(), HasSubstr("lost for 0.2 s (--restart-after)"));
  EXPECT_THAT(said(),
              HasSubstr("2 parts, frames located in each: 16 of 22, 10 of 10; 2 are apart"));
}

TEST_F(Parts, ThereIsOneWithoutTheOptionAndWithGivenPoses) {
  EXPECT_EQ(run({"--restart-after", "0", "--cloud", folder_ / "cloud.ply"}), 0);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "cloud.part1.ply"));
  std::ofstream(folder_ / "given.txt") << "0 0 0 0 0 0 0 1\n0.2 0 0 0 0 0 0 1\n";
  EXPECT_EQ(run({"--trajectory", folder_ / "given.txt", "--cloud", folder_ / "given.ply"}), 0);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "given.part1.ply"));
}

TEST_F(Parts, ARunThatIsResumedInAnyPartEndsAsOneWithoutInterruption) {
  ASSERT_EQ(run({"--store", folder_ / "whole.lcm"}), 0);
  const StoredRun whole = read_stored_run(folder_ / "whole.lcm");
  const auto is_pose = [](int number) {
    return [number, seen = 0](const LogEvent& event) mutable {
      return event.channel == channels::kCameraPose && ++seen == number;
    };
  };
  constexpr int kLast = kFramesInEachRoom + kNumLost;  // of part 0
  cut_after("whole.lcm", "in-part0.lcm", is_pose(12));
  cut_after("whole.lcm", "lost.lcm", is_pose(kLast));
  cut_after("whole.lcm", "begins-part1.lcm", is_pose(kLast + 1));
  cut_after("whole.lcm", "in-part1.lcm", is_pose(kLast + 5));
  for (const char* log : {"in-part0.lcm", "lost.lcm", "begins-part1.lcm", "in-part1.lcm"}) {
    EXPECT_EQ(run({"--resume", folder_ / log, "--cloud", folder_ / "cloud.ply"}), 0) << log << '\n'
                                                                                     << said();
    const StoredRun resumed = read_stored_run(folder_ / log);
    EXPECT_EQ(resumed.slice_chunks, whole.slice_chunks) << log;
    EXPECT_EQ(resumed.pose_utimes, whole.pose_utimes) << log;
    EXPECT_TRUE(resumed.statuses.back().finished) << log;
    EXPECT_TRUE(std::filesystem::remove(folder_ / "cloud.part1.ply"));
  }
}

TEST_F(Parts, AWholeRunThatIsResumedServesAllItsParts) {
  ASSERT_EQ(run({"--store", folder_ / "run.lcm"}), 0);
  const Listener listener;
  EXPECT_EQ(run({"--resume", folder_ / "run.lcm", "--linger", "1"}), 0) << said();
  EXPECT_THAT(said(), HasSubstr("session 7 is complete"));
  std::set<std::int32_t> parts;
  for (const CloudSlice& slice : listener.slices()) parts.insert(slice.part);
  EXPECT_EQ(parts, (std::set<std::int32_t>{0, 1}));
  EXPECT_EQ(listener.statuses().back().part, 1);
}

TEST_F(Parts, ACameraWithStoredFramesIsResumedInItsPart) {
  const std::string device = "folder://" + rooms_->path().string() + "?camera=on";
  const auto camera = [&](const std::string& store_or_resume) {
    Flags all = flags({"--device", device, store_or_resume, folder_ / "run.lcm"});
    all.emplace_back("--store-frames");
    return all;
  };
  {
    const Listener listener;
    MapperProgram mapper(camera("--store"), folder_ / "said.txt");
    ASSERT_TRUE(Listener::wait_until([&] {
      const auto statuses = listener.statuses();
      return !statuses.empty() && statuses.back().part >= 1;
    })) << said();
    EXPECT_TRUE(mapper.crash());
  }
  const StoredRun before = read_stored_run(folder_ / "run.lcm");
  const Listener listener;
  MapperProgram mapper(camera("--resume"), folder_ / "said.txt");
  ASSERT_TRUE(Listener::wait_until([&] {
    const auto statuses = listener.statuses();
    return !statuses.empty() && statuses.back().part >= 1;
  })) << said();
  mapper.interrupt();
  EXPECT_EQ(mapper.wait(), 0) << said();
  const StoredRun after = read_stored_run(folder_ / "run.lcm");
  for (const auto& [key, chunk] : before.slice_chunks) {
    EXPECT_EQ(after.slice_chunks.at(key), chunk);
  }
}

}  // namespace
}  // namespace kintsugi::mapper
