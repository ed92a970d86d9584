// The built program, killed and resumed: in the end the log holds what a run without faults leaves.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <random>
#include <span>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/conversion/recording_writer.hpp"
#include "tests/mapper/core/synthetic_frames.hpp"
#include "tests/mapper/process/mapper_program.hpp"
#include "tests/mapper/process/stored_run.hpp"
#include "tests/support/private_bus.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::mapper {
namespace {

using testing::brisk_walk;
using ::testing::HasSubstr;
using testing::Listener;
using testing::MapperProgram;
using testing::read_stored_run;
using testing::StoredRun;

using Flags = std::vector<std::string>;
constexpr int kNumFrames = 40;

std::string text_of(const std::filesystem::path& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

class Resume : public ::testing::Test {
 protected:
  void SetUp() override {
    static const auto why_not = kintsugi::testing::enter_private_bus();
    if (why_not) GTEST_SKIP() << *why_not;
  }

  Flags flags(const std::string& store_or_resume, const Flags& more = {"--replay"}) const {
    Flags flags = brisk_walk(folder_.path(), kNumFrames);
    flags.insert(flags.end(), {store_or_resume, log_});
    flags.insert(flags.end(), more.begin(), more.end());
    return flags;
  }

  int run(const Flags& flags) const { return MapperProgram(flags, folder_ / "said.txt").wait(); }
  std::string said() const { return text_of(folder_ / "said.txt"); }

  /// In bytes; nothing where there is no log.
  std::optional<std::uintmax_t> log_size() const {
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(log_, error);
    return error ? std::nullopt : std::optional(bytes);
  }

  /// What a run without faults leaves.
  StoredRun undisturbed() const {
    const std::filesystem::path log = folder_ / "undisturbed.lcm";
    Flags flags = brisk_walk(folder_.path(), kNumFrames);
    flags.insert(flags.end(), {"--store", log, "--replay"});
    EXPECT_EQ(run(flags), 0);
    StoredRun run = read_stored_run(log);
    EXPECT_GT(run.slice_chunks.size(), 10U) << "a run that is worth killing";
    return run;
  }

  /// Kills a run once it has logged so many slice chunks, up to 8. A replay needs 10 s for all of
  /// them, because it waits for the bus: so there is time to see when.
  void kill_after(const Flags& flags, std::size_t num_chunks) const {
    kill_when(flags, [=](const StoredRun& run) { return run.slice_chunks.size() >= num_chunks; });
  }
  void kill_when(Flags flags, const std::function<bool(const StoredRun&)>& is_time) const {
    flags.insert(flags.end(), {"--rate", "0.01"});
    MapperProgram mapper(flags, folder_ / "said.txt");
    EXPECT_TRUE(Listener::wait_until([&] {
      return log_size().value_or(0) > 0 && is_time(read_stored_run(log_));
    })) << said();
    EXPECT_TRUE(mapper.crash()) << "it was not killed: " << said();
  }

  const kintsugi::testing::TemporaryFolder folder_;
  const std::string log_ = folder_ / "run.lcm";
};

TEST_F(Resume, KilledAtAnyMomentsTheSessionIsThatOfARunWithoutFaults) {
  const StoredRun expected = undisturbed();
  std::mt19937 random(5);
  // A moment is a size of the log, which grows from the first event on: the same moments on any
  // machine. The first kill comes as soon as the log is there, perhaps before its first event.
  std::uniform_int_distribution<std::uintmax_t> growth_bytes(1, 30'000);
  for (int i = 0; i < 8; ++i) {
    const std::uintmax_t begin = log_size().value_or(0);
    const std::uintmax_t end = i == 0 ? 0 : begin + growth_bytes(random);
    MapperProgram mapper(
        flags(log_size() ? "--resume" : "--store", {"--replay", "--rate", "0.002"}),
        folder_ / "said.txt");
    EXPECT_TRUE(Listener::wait_until([&] { return log_size() && *log_size() >= end; },
                                     std::chrono::milliseconds(1)))
        << said();
    EXPECT_TRUE(mapper.crash()) << "it was not killed: " << said();
  }
  EXPECT_GT(read_stored_run(log_).slice_chunks.size(), 0U) << "something was mapped";
  EXPECT_FALSE(read_stored_run(log_).has_final_slice) << "something is left to map";
  EXPECT_EQ(run(flags("--resume")), 0) << said();
  const StoredRun resumed = read_stored_run(log_);
  EXPECT_EQ(resumed.slice_chunks, expected.slice_chunks);
  EXPECT_EQ(resumed.pose_utimes, expected.pose_utimes);
  EXPECT_TRUE(resumed.statuses.back().finished);
}

TEST_F(Resume, MapsTheFramesAgainThatWereMappedThenAndNoOthers) {
  const auto at_own_pace = [this](const std::string& store_or_resume) {
    Flags flags = this->flags(store_or_resume, {});
    flags[1] = "synthetic://office?frames=120";  // 4 s: it is killed before
    return flags;
  };
  kill_after(at_own_pace("--store"), 3);
  const StoredRun before = read_stored_run(log_);
  EXPECT_EQ(run(at_own_pace("--resume")), 0) << said();
  const StoredRun after = read_stored_run(log_);
  ASSERT_GE(after.pose_utimes.size(), before.pose_utimes.size());
  EXPECT_TRUE(std::ranges::is_sorted(after.pose_utimes, std::ranges::less_equal()))
      << "no frame is mapped that was dropped before";
  for (const auto& [key, chunk] : before.slice_chunks) {
    EXPECT_EQ(after.slice_chunks.at(key), chunk);
  }
  EXPECT_TRUE(after.has_final_slice);
  EXPECT_EQ(after.statuses.back().frames_resumed,
            static_cast<std::int64_t>(before.pose_utimes.size()))
      << said();
}

/// A walk in which the camera stops at each step for some frames.
void write_halting_walk(const std::filesystem::path& path, int frames_of_step,
                        std::int64_t period_us) {
  const auto writer = open_recording_writer(path, {.jpeg_quality = 0});
  std::int64_t utime = 0;
  for (RgbdFrame frame : testing::synthetic_run("office", 50, false).frames) {
    for (int i = 0; i < frames_of_step; ++i) {
      frame.utime = utime;
      writer->add(frame);
      utime += period_us;
    }
  }
  writer->finish({});
}

TEST_F(Resume, RepeatsWhichFramesWereFusedAndWhichOnlyTracked) {
  const auto walk = [&](const std::string& recording, const std::string& store_or_resume,
                        const std::string& log) {
    // With so few fused frames as a loaded machine has time for, there are points all the same.
    return Flags{"--device",      folder_ / recording,
                 "--resolution",  "0.02",
                 "--min-weight",  "0",
                 "--session",     "7",
                 "--linger",      "0",
                 store_or_resume, log};
  };
  // Four times as fast as this machine maps it.
  write_halting_walk(folder_ / "calm.klg", 1, 33'333);
  Flags calm = walk("calm.klg", "--store", folder_ / "calm.lcm");
  calm.emplace_back("--replay");
  ASSERT_EQ(run(calm), 0) << said();
  // Each status tells of the frames since the one before, and the last one of few or none.
  const double frame_ms = std::ranges::max(read_stored_run(folder_ / "calm.lcm").statuses, {},
                                           &MapperStatus::frame_p50_ms)
                              .frame_p50_ms;
  ASSERT_GT(frame_ms, 0.0);
  write_halting_walk(folder_ / "hasty.klg", 4, std::llround(1e3 * frame_ms / 4));
  const auto hasty = [&](const std::string& store_or_resume) {
    return walk("hasty.klg", store_or_resume, log_);
  };
  kill_when(hasty("--store"), [](const StoredRun& run) {
    return run.slice_chunks.size() >= 8 && run.tracked_only_utimes.size() >= 3;
  });
  const StoredRun before = read_stored_run(log_);
  ASSERT_LT(before.tracked_only_utimes.size(), before.pose_utimes.size());
  // It compares its slices with those in the log, and fails where they differ.
  EXPECT_EQ(run(hasty("--resume")), 0) << said();
  const StoredRun after = read_stored_run(log_);
  EXPECT_TRUE(after.has_final_slice);
  EXPECT_TRUE(std::ranges::equal(
      before.tracked_only_utimes,
      std::span(after.tracked_only_utimes).first(before.tracked_only_utimes.size())));
}

TEST_F(Resume, StoppedBeforeItHasCaughtUpLeavesTheSessionOpen) {
  const StoredRun expected = undisturbed();
  kill_after(flags("--store"), 8);
  {
    const Listener listener;
    MapperProgram mapper(flags("--resume"), folder_ / "said.txt");
    ASSERT_TRUE(Listener::wait_until([&] { return !listener.statuses().empty(); }));
    mapper.interrupt();
    EXPECT_EQ(mapper.wait(), 0) << said();
    EXPECT_THAT(said(), HasSubstr("resume once more"));
    EXPECT_FALSE(listener.statuses().back().finished);
  }
  EXPECT_FALSE(read_stored_run(log_).has_final_slice);
  EXPECT_EQ(run(flags("--resume")), 0) << said();
  EXPECT_EQ(read_stored_run(log_).slice_chunks, expected.slice_chunks);
}

TEST_F(Resume, ServesASessionThatHasEndedToWhoComesLate) {
  ASSERT_EQ(run(flags("--store")), 0);
  const StoredRun stored = read_stored_run(log_);
  const Listener listener;
  Flags late = flags("--resume");
  *(std::ranges::find(late, "--linger") + 1) = "1";
  EXPECT_EQ(run(late), 0) << said();
  ASSERT_TRUE(Listener::wait_until([&] { return listener.heard_the_end(); }));
  ASSERT_FALSE(listener.slices().empty());
  EXPECT_TRUE(testing::ids_have_no_gap(listener.slices()));
  EXPECT_EQ(listener.slices().back().session, 7);
  const MapperStatus status = listener.statuses().back();
  EXPECT_TRUE(status.lingering);
  EXPECT_EQ(status.slices_published, std::ssize(listener.slices()));
  EXPECT_GE(status.chunks_resent, static_cast<std::int64_t>(stored.slice_chunks.size()));
  EXPECT_EQ(read_stored_run(log_).slice_chunks, stored.slice_chunks);
}

TEST_F(Resume, RefusesOtherOptionsAndAnotherDeviceAndSaysWhich) {
  kill_after(flags("--store"), 2);
  const auto size = std::filesystem::file_size(log_);
  for (const auto& [flag, value] : {std::pair{"--resolution", "0.03"},
                                    {"--min-weight", "2"},
                                    {"--device", "synthetic://office?frames=41"}}) {
    Flags other = flags("--resume");
    *(std::ranges::find(other, flag) + 1) = value;
    EXPECT_EQ(run(other), 1);
    EXPECT_THAT(said(), HasSubstr(std::string(flag) + " is '" + value + "', was '"));
  }
  Flags other = flags("--resume");
  *(std::ranges::find(other, "--session") + 1) = "8";
  EXPECT_EQ(run(other), 1);
  EXPECT_THAT(said(), HasSubstr("the session to resume is 7"));
  EXPECT_EQ(std::filesystem::file_size(log_), size) << "nothing was written";
}

TEST_F(Resume, FindsOutThatTheDeviceShowsSomethingElse) {
  kill_after(flags("--store"), 4);
  // The same command line, but another walk in the file that it names.
  Flags other = flags("--resume");
  std::ofstream walk(folder_ / "walk.txt");
  for (int i = 0; i < 200; ++i) {
    walk << 1.0 / 30.0 * i << ' ' << 0.15 * i << " 0 0 0 0 0 1\n";
  }
  walk.close();
  EXPECT_EQ(run(other), 1);
  EXPECT_THAT(said(), HasSubstr("differs from what was sent before"));
}

TEST_F(Resume, BeginsANewSessionBesideTheOldOneForALiveCamera) {
  const auto live = [this](const std::string& store_or_resume) {
    Flags flags = this->flags(store_or_resume, {});
    flags[1] = "synthetic://office?frames=60&camera=on";
    return flags;
  };
  kill_after(live("--store"), 3);
  const StoredRun before = read_stored_run(log_);
  const Listener listener;
  MapperProgram mapper(live("--resume"), folder_ / "said.txt");
  ASSERT_TRUE(Listener::wait_until([&] {
    const auto slices = listener.slices();
    const auto of_old = std::ranges::count(slices, 7, &CloudSlice::session);
    return of_old >= 2 && slices.size() > static_cast<std::size_t>(of_old);
  })) << "slices of the old session and of the new one";
  mapper.interrupt();
  EXPECT_EQ(mapper.wait(), 0) << said();
  EXPECT_THAT(said(), HasSubstr("a new session begins"));
  const StoredRun after = read_stored_run(log_);
  EXPECT_GT(after.slice_chunks.size(), before.slice_chunks.size());
  EXPECT_GT(after.slice_chunks.rbegin()->first.first, 7);
}

TEST_F(Resume, GoesOnWithALiveCameraWhenTheLogHasItsFrames) {
  const auto live = [this](const std::string& store_or_resume) {
    Flags flags = this->flags(store_or_resume, {"--store-frames"});
    flags[1] = "synthetic://office?frames=60&camera=on";
    return flags;
  };
  kill_after(live("--store"), 3);
  const StoredRun before = read_stored_run(log_);
  const Listener listener;
  MapperProgram mapper(live("--resume"), folder_ / "said.txt");
  ASSERT_TRUE(Listener::wait_until([&] {
    return read_stored_run(log_).pose_utimes.size() > before.pose_utimes.size() + 5;
  })) << said();
  mapper.interrupt();
  EXPECT_EQ(mapper.wait(), 0) << said();
  const StoredRun after = read_stored_run(log_);
  EXPECT_EQ(after.slice_chunks.rbegin()->first.first, 7) << "the same session";
  for (const auto& [key, chunk] : before.slice_chunks) {
    EXPECT_EQ(after.slice_chunks.at(key), chunk);
  }
  EXPECT_TRUE(after.has_final_slice);
  EXPECT_TRUE(std::ranges::is_sorted(after.pose_utimes, std::ranges::less_equal()))
      << "times go on";
  EXPECT_EQ(after.statuses.back().frames_resumed,
            static_cast<std::int64_t>(before.pose_utimes.size()));
}

}  // namespace
}  // namespace kintsugi::mapper
