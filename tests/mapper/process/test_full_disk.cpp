// The built program and disks that are full, while it maps and before; in a mount of the test's
// own.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/trajectory.hpp"
#include "tests/mapper/process/mapper_program.hpp"
#include "tests/mapper/process/stored_run.hpp"
#include "tests/support/private_bus.hpp"
#include "tests/support/small_disk.hpp"
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

class FullDisk : public ::testing::Test {
 protected:
  void SetUp() override {
    static const auto no_bus = kintsugi::testing::enter_private_bus();
    if (no_bus) GTEST_SKIP() << *no_bus;
    if (const auto why_not = disk_.mount("64k")) GTEST_SKIP() << *why_not;
  }

  Flags flags(const std::string& log) const {
    Flags flags = brisk_walk(folder_.path(), kNumFrames);
    flags.insert(flags.end(), {"--replay", "--store", log});
    return flags;
  }
  std::string said() const {
    std::ifstream in(folder_ / "said.txt");
    return {std::istreambuf_iterator<char>(in), {}};
  }

  const kintsugi::testing::TemporaryFolder folder_;
  kintsugi::testing::SmallDisk disk_{folder_ / "disk"};
  const std::string log_ = folder_ / "disk" / "run.lcm";
};

TEST_F(FullDisk, WhileMappingIsSaidOnceAndMadeUpForWhenThereIsSpace) {
  const std::string whole_log = folder_ / "undisturbed.lcm";
  ASSERT_EQ(MapperProgram(flags(whole_log), folder_ / "said.txt").wait(), 0);
  const StoredRun expected = read_stored_run(whole_log);
  ASSERT_GT(std::filesystem::file_size(whole_log), 100'000U) << "more than the disk holds";

  const Listener listener;
  Flags lingering = flags(log_);
  *(std::ranges::find(lingering, "--linger") + 1) = "-1";
  MapperProgram mapper(lingering, folder_ / "said.txt");
  ASSERT_TRUE(Listener::wait_until([&] { return listener.heard_the_end(); })) << "it goes on";
  const MapperStatus full = listener.statuses().back();
  EXPECT_THAT(full.store_problem, HasSubstr("No space left on device"));
  EXPECT_GT(full.store_waiting_bytes, 0);
  EXPECT_LE(full.store_bytes, 64 * 1024);
  EXPECT_EQ(full.store_lost_chunks, 0);
  EXPECT_EQ(listener.poses().size(), static_cast<std::size_t>(kNumFrames));
  const StoredRun meanwhile = read_stored_run(log_);
  EXPECT_GT(meanwhile.events, 0);
  // But for the moment of another try, that is.
  EXPECT_TRUE(Listener::wait_until([&] {
    return std::filesystem::file_size(log_) ==
           static_cast<std::uintmax_t>(listener.statuses().back().store_bytes);
  })) << "no half-written event";

  ASSERT_TRUE(disk_.resize("10m"));
  ASSERT_TRUE(
      Listener::wait_until([&] { return listener.statuses().back().store_problem.empty(); }));
  mapper.interrupt();
  EXPECT_EQ(mapper.wait(), 0) << said();
  const std::string text = said();
  const auto first = text.find("[error]");
  EXPECT_NE(first, std::string::npos);
  EXPECT_EQ(text.find("[error]", first + 1), std::string::npos) << "said once: " << text;
  const StoredRun stored = read_stored_run(log_);
  EXPECT_EQ(stored.slice_chunks, expected.slice_chunks);
  EXPECT_EQ(stored.pose_utimes, expected.pose_utimes);
}

TEST_F(FullDisk, InTheEndLeavesAWholeLogThatCanBeResumed) {
  EXPECT_EQ(MapperProgram(flags(log_), folder_ / "said.txt").wait(), 1);
  EXPECT_THAT(said(), HasSubstr("the log is incomplete"));
  const StoredRun before = read_stored_run(log_);
  ASSERT_TRUE(disk_.resize("10m"));
  Flags resume = flags(log_);
  *std::ranges::find(resume, "--store") = "--resume";
  EXPECT_EQ(MapperProgram(resume, folder_ / "said.txt").wait(), 0) << said();
  const StoredRun after = read_stored_run(log_);
  EXPECT_GT(after.slice_chunks.size(), before.slice_chunks.size());
  EXPECT_EQ(after.pose_utimes.size(), static_cast<std::size_t>(kNumFrames));
  EXPECT_TRUE(after.has_final_slice);
}

TEST_F(FullDisk, LosesNoFileThatIsElsewhere) {
  std::ofstream(folder_ / "disk" / "filling") << std::string(60'000, 'x');
  Flags with_files = flags(folder_ / "run.lcm");
  with_files.insert(with_files.end(),
                    {"--timings", folder_ / "disk" / "timings.csv", "--output-trajectory",
                     folder_ / "disk" / "path.txt", "--online-trajectory", folder_ / "online.txt"});
  EXPECT_EQ(MapperProgram(with_files, folder_ / "said.txt").wait(), 1);
  EXPECT_THAT(said(), HasSubstr("timings.csv: No space left on device"));
  EXPECT_THAT(said(), HasSubstr("a file could not be written, see above"));
  EXPECT_THAT(said(), HasSubstr(std::to_string(kNumFrames) + " frames in ")) << "the summary";
  std::ifstream in(folder_ / "online.txt");
  EXPECT_EQ(read_tum(in, "online.txt").size(), static_cast<std::size_t>(kNumFrames));
}

TEST_F(FullDisk, BeforeTheFirstEventIsAnErrorAndLeavesNoFile) {
  std::ofstream(folder_ / "disk" / "filling") << std::string(1'000'000, 'x');
  EXPECT_EQ(MapperProgram(flags(log_), folder_ / "said.txt").wait(), 1);
  EXPECT_THAT(said(), HasSubstr("No space left on device"));
  EXPECT_THAT(said(), HasSubstr(log_));
  EXPECT_FALSE(std::filesystem::exists(log_));
}

TEST_F(FullDisk, OrOneThatMayNotBeWrittenIsAnError) {
  ASSERT_TRUE(disk_.forbid_writing());
  EXPECT_EQ(MapperProgram(flags(log_), folder_ / "said.txt").wait(), 1);
  EXPECT_THAT(said(), HasSubstr("Read-only file system"));
  EXPECT_THAT(said(), HasSubstr(log_));
}

}  // namespace
}  // namespace kintsugi::mapper
