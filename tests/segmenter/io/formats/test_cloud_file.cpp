#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segmenter/io/formats/cloud_file.hpp"
#include "tests/segmenter/io/formats/example_clouds.hpp"
#include "tests/segmenter/io/formats/expect_example.hpp"
#include "tests/segmenter/io/formats/hostile_bytes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::HasSubstr;

TEST(CloudFile, KnowsAFileByItsContentsWhateverItsName) {
  for (const char* name : {"cloud", "cloud.ply", "cloud.txt", "cloud.data"}) {
    EXPECT_EQ(format_of("ply\nformat ascii 1.0\n", name), CloudFormat::kPly);
    EXPECT_EQ(format_of("ply\r\nformat ascii 1.0\r\n", name), CloudFormat::kPly);
    EXPECT_EQ(format_of(testing::pcd_binary(), name), CloudFormat::kPcd);
    EXPECT_EQ(format_of("VERSION .7\nFIELDS x y z\n", name), CloudFormat::kPcd);
    EXPECT_EQ(format_of(testing::las_cloud(0), name), CloudFormat::kLas);
    EXPECT_EQ(format_of(testing::npy_cloud(), name), CloudFormat::kNpy);
  }
  EXPECT_EQ(format_of("1 2 3\n", "cloud"), CloudFormat::kText);
  EXPECT_EQ(format_of("", "cloud.PTS"), CloudFormat::kText);
  EXPECT_EQ(format_of("", "cloud.ply"), CloudFormat::kPly);
}

TEST(CloudFile, NamesTheFormatsItReads) {
  const auto error_of = [](const std::string& bytes) {
    return testing::error_of([&] { format_of(bytes, "cloud.data"); });
  };
  EXPECT_THAT(error_of("ASTM-E57"),
              HasSubstr("cloud.data: is an E57 file, expected a cloud as PLY"));
  EXPECT_THAT(error_of(std::string("\0\1", 2)), HasSubstr("unknown format: begins with '\?\?'"));
}

TEST(CloudFile, ReadsEveryFormat) {
  const kintsugi::testing::TemporaryFolder folder;
  const std::string path = (folder / "cloud").string();
  for (const std::string& bytes : {testing::npy_cloud(), testing::pcd_binary(),
                                   testing::pcd_compressed(), testing::las_cloud(7)}) {
    std::ofstream(path, std::ios::binary) << bytes;
    testing::expect_example(read_cloud_file(path, LabelUse::kRead).table);
  }
}

TEST(CloudFile, RefusesAFileWithoutPositions) {
  const kintsugi::testing::TemporaryFolder folder;
  const std::string path = (folder / "cloud.pcd").string();
  std::ofstream(path) << "FIELDS x y\nSIZE 4 4\nTYPE F F\nPOINTS 1\nDATA ascii\n1 2\n";
  EXPECT_THAT(testing::error_of([&] { read_cloud_file(path, LabelUse::kRead); }),
              HasSubstr("line 1: the list of FIELDS lacks property 'z'"));
}

}  // namespace
}  // namespace kintsugi::segmenter
