// The built program, and power cuts at any moments: tests/support/forgetful_disk.cpp writes down
// what it does to the disk, tests/support/power_cut.hpp makes of that what each cut leaves.

#include <algorithm>
#include <cstdlib>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/channels.hpp"
#include "mapper/session/session_store.hpp"
#include "tests/mapper/process/mapper_program.hpp"
#include "tests/mapper/process/stored_run.hpp"
#include "tests/support/power_cut.hpp"
#include "tests/support/private_bus.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;
using kintsugi::testing::cut_power;
using kintsugi::testing::DiskAction;
using kintsugi::testing::DiskEvent;
using kintsugi::testing::DiskJournal;
using testing::brisk_walk;
using ::testing::HasSubstr;
using testing::MapperProgram;
using testing::read_stored_run;
using testing::StoredRun;

using Flags = std::vector<std::string>;
using Events = std::span<const DiskEvent>;
constexpr int kNumFrames = 40;
constexpr std::int64_t kSession = 7;  // of brisk_walk()

/// scripts/faults power-cut has more.
int num_cuts() {
  const char* number = std::getenv("KINTSUGI_POWER_CUTS");
  return number == nullptr ? 40 : static_cast<int>(std::strtol(number, nullptr, 10));
}

std::string text_of(const fs::path& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// One past the last chunk of a slice that others have heard.
std::int64_t heard_end(Events events) {
  constexpr std::size_t kLcmHeaderBytes = 8;
  std::int64_t end = 0;
  for (const DiskEvent& event : events) {
    if (event.record.action != DiskAction::kSent) continue;
    const std::string_view rest = event.text.substr(kLcmHeaderBytes);
    const std::string_view channel = rest.substr(0, rest.find('\0'));
    if (channel != channels::kCloudSlice) continue;
    const std::string_view data = rest.substr(channel.size() + 1);
    const Bytes bytes(data.begin(), data.end());
    end = std::max(end, decode_chunk<CloudSlice>(bytes).sequence + 1);
  }
  return end;
}

/// How long before the cut the last event was appended that is left: what was lost, seconds.
double lost_s(const StoredRun& left, const StoredRun& whole, std::int64_t cut_utime) {
  const auto num_left = static_cast<std::size_t>(left.events);
  if (num_left >= whole.event_utimes.size()) return 0.0;
  return std::max(0.0, 1e-6 * static_cast<double>(cut_utime - whole.event_utimes[num_left]));
}

class PowerCut : public ::testing::Test {
 protected:
  void SetUp() override {
    static const auto why_not = kintsugi::testing::enter_private_bus();
    if (why_not) GTEST_SKIP() << *why_not;
#ifdef __SANITIZE_THREAD__
    GTEST_SKIP()
        << "the disk that forgets writes past the thread sanitizer, which then does not see "
           "that threads wait for each other by pipes";
#endif
    fs::create_directory(disk_);
  }

  /// Some seconds with this rate, so that there are some syncs.
  Flags flags(const std::string& store_or_resume) const {
    Flags flags = brisk_walk(folder_.path(), kNumFrames);
    flags.insert(flags.end(), {store_or_resume, log_, "--replay", "--durable", "--rate", "0.5"});
    return flags;
  }

  /// Runs the mapper on the disk that forgets. Returns its exit code.
  int run(const Flags& flags, const Flags& faults = {}) const {
    Flags words = kintsugi::testing::forgetful_disk(disk_, journal_);
    words.insert(words.end(), faults.begin(), faults.end());
    words.push_back(MapperProgram::path());
    const Flags on_bus = MapperProgram::on_private_bus(flags);
    words.insert(words.end(), on_bus.begin(), on_bus.end());
    return kintsugi::testing::ChildProgram("/usr/bin/env", words, folder_ / "said.txt").wait();
  }
  std::string said() const { return text_of(folder_ / "said.txt"); }

  /// Cuts the power after these events, and opens what is left of the log, which must be the
  /// beginning of the whole one and have all that others have heard. Returns what it has lost, s.
  double expect_beginning(Events events, std::uint32_t seed, const StoredRun& whole) const {
    cut_power(events, {}, seed, left_);
    const std::int64_t heard = heard_end(events);
    if (!fs::exists(left_ / "run.lcm")) {
      EXPECT_EQ(heard, 0) << "there is no log";
      return 0.0;
    }
    {
      SessionStore store({.path = left_ / "run.lcm", .resume = true, .durable = true});
      EXPECT_EQ(store.sessions().size(), 1U);
      EXPECT_GE(store.stream(channels::kCloudSlice, kSession).next_sequence(), heard);
    }
    const StoredRun left = read_stored_run(left_ / "run.lcm");
    EXPECT_EQ(left.damage, "") << "it was cut where it is whole";
    for (const auto& [key, chunk] : left.slice_chunks) {
      EXPECT_EQ(chunk, whole.slice_chunks.at(key));
    }
    EXPECT_TRUE(std::ranges::equal(left.pose_utimes,
                                   std::span(whole.pose_utimes).first(left.pose_utimes.size())));
    return events.empty() ? 0.0 : lost_s(left, whole, events.back().record.time_us);
  }

  /// At moments and with seeds by chance.
  void expect_beginnings(const DiskJournal& journal, const StoredRun& whole) const {
    std::mt19937 random(11);
    double most_lost_s = 0.0;
    for (int i = 0; i < num_cuts(); ++i) {
      const std::size_t num_events = random() % (journal.events().size() + 1);
      const std::uint32_t seed = random();
      SCOPED_TRACE("after event " + std::to_string(num_events) + ", seed " + std::to_string(seed));
      const double lost = expect_beginning(Events(journal.events()).first(num_events), seed, whole);
      most_lost_s = std::max(most_lost_s, lost);
      if (HasFailure()) return;
    }
    std::printf("power cuts: %d, most lost: %.2f s\n", num_cuts(), most_lost_s);
  }

  const kintsugi::testing::TemporaryFolder folder_;
  const fs::path disk_ = folder_ / "disk";
  const fs::path left_ = folder_ / "left";
  const fs::path journal_ = folder_ / "journal";
  const std::string log_ = disk_ / "run.lcm";
};

TEST_F(PowerCut, LeavesTheBeginningOfTheLogWithAllThatOthersHaveHeard) {
  ASSERT_EQ(run(flags("--store")), 0) << said();
  const StoredRun whole = read_stored_run(log_);
  ASSERT_GT(whole.slice_chunks.size(), 10U);
  const DiskJournal journal(journal_);
  EXPECT_GT(heard_end(journal.events()), 10) << "what others hear is seen";
  expect_beginnings(journal, whole);
}

TEST_F(PowerCut, LeavesNoHoleInALogOfSeveralFiles) {
  Flags rotating = flags("--store");
  rotating.insert(rotating.end(),
                  {"--store-frames", "--store-file-size", "1", "--max-frames", "12"});
  ASSERT_EQ(run(rotating), 0) << said();
  ASSERT_TRUE(fs::exists(disk_ / "run.2.lcm")) << "that there are some";
  const DiskJournal journal(journal_);
  std::mt19937 random(12);
  for (int i = 0; i < num_cuts(); ++i) {
    const std::size_t num_events = random() % (journal.events().size() + 1);
    const Events events = Events(journal.events()).first(num_events);
    cut_power(events, {}, random(), left_);
    if (!fs::exists(left_ / "run.lcm")) continue;
    SCOPED_TRACE("after event " + std::to_string(num_events));
    SessionStore store({.path = left_ / "run.lcm", .resume = true, .durable = true});
    EXPECT_GE(store.stream(channels::kCloudSlice, kSession).next_sequence(), heard_end(events));
    EXPECT_EQ(store.stream(channels::kRgbdFrame, kSession).first_sequence(), 0);
  }
}

TEST_F(PowerCut, AgainAndAgainTheSessionIsThatOfARunWithoutFaults) {
  Flags undisturbed = brisk_walk(folder_.path(), kNumFrames);
  undisturbed.insert(undisturbed.end(), {"--store", folder_ / "undisturbed.lcm", "--replay"});
  ASSERT_EQ(MapperProgram(undisturbed, folder_ / "said.txt").wait(), 0) << said();
  const StoredRun expected = read_stored_run(folder_ / "undisturbed.lcm");
  std::mt19937 random(13);
  const fs::path before = folder_ / "before";
  for (int i = 0; i < 3; ++i) {
    fs::remove_all(before);
    fs::copy(disk_, before, fs::copy_options::recursive);
    ASSERT_EQ(run(flags(fs::exists(log_) ? "--resume" : "--store")), 0) << said();
    const DiskJournal journal(journal_);
    // In the last half, so that the log grows from time to time.
    const std::size_t half = journal.events().size() / 2;
    const Events events = Events(journal.events()).first(half + random() % half);
    cut_power(events, before, random(), left_);
    fs::remove_all(disk_);
    fs::rename(left_, disk_);
  }
  ASSERT_EQ(run(flags("--resume")), 0) << said();
  const StoredRun resumed = read_stored_run(log_);
  EXPECT_EQ(resumed.slice_chunks, expected.slice_chunks);
  EXPECT_EQ(resumed.pose_utimes, expected.pose_utimes);
  EXPECT_TRUE(resumed.has_final_slice);
}

TEST_F(PowerCut, LosesNothingWhereTheDiskHasFailedToSync) {
  ASSERT_EQ(run(flags("--store"), {"FORGETFUL_FAIL_SYNCS=3-4"}), 0) << said();
  EXPECT_THAT(said(), HasSubstr("cannot sync log"));
  EXPECT_THAT(said(), HasSubstr("can be written again"));
  const StoredRun whole = read_stored_run(log_);
  const auto has_problem = [](const MapperStatus& status) {
    return status.store_problem.find("Input/output error") != std::string::npos;
  };
  EXPECT_TRUE(std::ranges::any_of(whole.statuses, has_problem)) << "the status says so";
  const DiskJournal journal(journal_);
  for (std::uint32_t seed = 0; seed < 8; ++seed) {
    cut_power(journal.events(), {}, seed, left_);
    EXPECT_EQ(text_of(left_ / "run.lcm"), text_of(log_)) << "at the end all is on the disk";
  }
}

TEST_F(PowerCut, IsSaidToTakeMoreWhileTheDiskIsSlow) {
  ASSERT_EQ(run(flags("--store"), {"FORGETFUL_SYNC_MS=1500"}), 0) << said();
  EXPECT_THAT(said(), HasSubstr("s behind, which a power cut would take"));
  const StoredRun whole = read_stored_run(log_);
  const auto is_behind = [](const MapperStatus& status) {
    return status.store_problem.find("behind") != std::string::npos;
  };
  EXPECT_TRUE(std::ranges::any_of(whole.statuses, is_behind)) << "the status says so";
  EXPECT_EQ(whole.pose_utimes.size(), static_cast<std::size_t>(kNumFrames));
  EXPECT_TRUE(whole.has_final_slice);
}

}  // namespace
}  // namespace kintsugi::mapper
