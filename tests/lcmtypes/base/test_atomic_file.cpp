#include <fstream>
#include <system_error>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/base/atomic_file.hpp"
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
