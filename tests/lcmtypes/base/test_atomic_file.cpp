#include <cstdlib>
#include <fstream>
#include <random>
#include <span>
#include <stdexcept>
#include <system_error>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "lcmtypes/base/atomic_file.hpp"
#include "lcmtypes/base/file_sync.hpp"
#include "tests/support/power_cut.hpp"
#include "tests/support/small_disk.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi {
namespace {

namespace fs = std::filesystem;
using kintsugi::testing::SmallDisk;
using kintsugi::testing::TemporaryFolder;
using ::testing::HasSubstr;

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::size_t num_files(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator{}));
}

/// The content of a file that is written for the nth time.
std::string nth_content(int n) {
  return std::string(static_cast<std::size_t>(3'000 * n), static_cast<char>('a' + n));
}

constexpr int kNumWritten = 10;

/// Run by the test below.
TEST(AtomicFile, DISABLED_WritesAgainAndAgain) {
  const fs::path folder = fs::path(std::getenv("FORGETFUL_DISK")) / "a" / "b";
  make_folder(folder);
  for (int i = 1; i <= kNumWritten; ++i) {
    AtomicFile file(folder / "map");
    file.stream() << nth_content(i);
    file.commit();
    testing::tell_others(i);
  }
}

TEST(AtomicFile, IsLeftByAPowerCutAsItWasCommittedLastOrAsTheNextOne) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "disk");
  ASSERT_EQ(testing::run_on_forgetful_disk("AtomicFile.DISABLED_WritesAgainAndAgain",
                                           folder / "disk", folder / "journal"),
            0);
  const testing::DiskJournal journal(folder / "journal");
  const std::span events = journal.events();
  ASSERT_EQ(testing::last_told(events), kNumWritten);
  std::mt19937 random(3);
  for (int i = 0; i < 200; ++i) {
    const std::size_t num_events = random() % (events.size() + 1);
    testing::cut_power(events.first(num_events), {}, random(), folder / "left");
    const int told = testing::last_told(events.first(num_events));
    const fs::path file = folder / "left" / "a" / "b" / "map";
    if (told == 0 && !fs::exists(file)) continue;
    ASSERT_TRUE(content(file) == nth_content(told) || content(file) == nth_content(told + 1))
        << "after event " << num_events << ", told " << told;
  }
}

TEST(AtomicFile, HasItsNameAfterCommit) {
  const TemporaryFolder folder;
  AtomicFile file(folder / "map.ply");
  file.stream() << "new";
  EXPECT_FALSE(fs::exists(folder / "map.ply"));
  file.commit();
  EXPECT_EQ(content(folder / "map.ply"), "new");
  EXPECT_EQ(num_files(folder.path()), 1U);
}

TEST(AtomicFile, LeavesOnlyTheOldContentWithoutCommit) {
  const TemporaryFolder folder;
  std::ofstream(folder / "map.ply") << "old";
  {
    AtomicFile file(folder / "map.ply");
    file.stream() << "new";
    file.stream().flush();
    EXPECT_EQ(num_files(folder.path()), 2U);
  }
  EXPECT_EQ(content(folder / "map.ply"), "old");
  EXPECT_EQ(num_files(folder.path()), 1U);
}

TEST(AtomicFile, GivesThePartialFileTheSameExtension) {
  const TemporaryFolder folder;
  AtomicFile file(folder / "run.final.png");
  EXPECT_EQ(file.partial_path().extension(), ".png");
  EXPECT_EQ(file.partial_path().parent_path(), folder.path());
  std::ofstream(file.partial_path()) << "picture";
  file.commit();
  EXPECT_EQ(content(folder / "run.final.png"), "picture");
  EXPECT_EQ(num_files(folder.path()), 1U);
}

TEST(AtomicFile, IsWhereALinkLeads) {
  const TemporaryFolder folder;
  std::ofstream(folder / "real.json") << "old";
  fs::create_symlink("real.json", folder / "link.json");
  AtomicFile file(folder / "link.json");
  file.stream() << "new";
  file.commit();
  EXPECT_TRUE(fs::is_symlink(folder / "link.json"));
  EXPECT_EQ(content(folder / "real.json"), "new");
}

TEST(AtomicFile, DoesNotReplaceWhatIsNoFile) {
  const TemporaryFolder folder;
  const fs::path pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  fs::create_symlink("pipe", folder / "link");
  for (const fs::path& path : {pipe, folder / "link"}) {
    EXPECT_THAT([&] { AtomicFile file(path); },
                ::testing::ThrowsMessage<std::invalid_argument>(HasSubstr("is no regular file")));
  }
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST(AtomicFile, WritesMoreThanItsBufferInOrder) {
  const TemporaryFolder folder;
  std::string expected;
  AtomicFile file(folder / "map.ply");
  for (int i = 0; i < 50'000; ++i) {
    const std::string line = std::to_string(i) + "\n";
    expected += line;
    file.stream() << line;
  }
  const std::string block(200'000, 'x');
  expected += block;
  file.stream().write(block.data(), static_cast<std::streamsize>(block.size()));
  file.commit();
  EXPECT_EQ(content(folder / "map.ply"), expected);
}

TEST(AtomicFile, TheErrorNamesAMissingFolder) {
  const TemporaryFolder folder;
  AtomicFile file(folder / "no" / "map.ply");
  try {
    file.stream();
    FAIL() << "opened";
  } catch (const std::system_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("no/map.ply' (by way of 'map.partial.ply'): No such file"));
  }
  EXPECT_THROW(AtomicFile(folder.path() / ""), std::invalid_argument);
}

TEST(AtomicFile, CommitFailsWhenNothingWasWritten) {
  const TemporaryFolder folder;
  AtomicFile file(folder / "map.ply");
  EXPECT_THROW(file.commit(), std::system_error);
  EXPECT_EQ(num_files(folder.path()), 0U);
}

TEST(AtomicFile, AFullDiskIsReportedAndKeepsTheOldFile) {
  const TemporaryFolder folder;
  SmallDisk disk(folder.path());
  if (const auto why_not = disk.mount("64k")) GTEST_SKIP() << *why_not;
  std::ofstream(folder / "map.ply") << "old";
  try {
    AtomicFile file(folder / "map.ply");
    for (int i = 0; i < 100'000; ++i) file.stream() << "more than fits\n";
    file.commit();
    ADD_FAILURE() << "committed";
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.code(), std::errc::no_space_on_device);
    EXPECT_EQ(std::string(error.what()), "cannot write '" + (folder / "map.ply").string() +
                                             "' (by way of 'map.partial.ply'): No space left on "
                                             "device");
  }
  EXPECT_EQ(content(folder / "map.ply"), "old");
  EXPECT_EQ(num_files(folder.path()), 1U);
}

}  // namespace
}  // namespace kintsugi
