#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <system_error>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/base/ply_writer.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr std::uint8_t kThree = 3;

std::string read_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::size_t num_files(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

/// Two vertices `x` and one face, as they must be in a file.
const std::string kExpected =
    "ply\nformat binary_little_endian 1.0\ncomment made by a test\nelement vertex 2\n"
    "property uchar x\nelement face 1\nproperty list uchar ushort vertex_indices\nend_header\n" +
    std::string("\x07\x08\x03\x00\x00\x01\x00\x00\x01", 9);

PlyWriter writer_of(const std::filesystem::path& path, std::optional<std::int64_t> num_vertices,
                    std::optional<std::int64_t> num_faces) {
  return PlyWriter(path,
                   {{"vertex", {"uchar x"}, num_vertices},
                    {"face", {"list uchar ushort vertex_indices"}, num_faces}},
                   {"made by a test"});
}

TEST(PlyWriter, WritesTheSameFileWhetherOrNotItKnowsTheCounts) {
  const testing::TemporaryFolder folder;
  for (const bool counts_are_known : {true, false}) {
    const std::filesystem::path path = folder / (counts_are_known ? "known.ply" : "counted.ply");
    using Count = std::optional<std::int64_t>;
    PlyWriter writer = writer_of(path, counts_are_known ? Count(2) : Count(),
                                 counts_are_known ? Count(1) : Count());
    writer.append(0, std::uint8_t{7});
    writer.append(0, std::uint8_t{8});
    writer.append(1, kThree, std::array<std::uint16_t, 3>{0, 1, 256});
    EXPECT_FALSE(std::filesystem::exists(path));
    EXPECT_EQ(writer.count(0), 2);
    writer.commit();
    EXPECT_EQ(read_file(path), kExpected);
  }
  EXPECT_EQ(num_files(folder.path()), 2U) << "no temporary file remains";
}

TEST(PlyWriter, TakesElementsInAnyOrderWhenItCountsThem) {
  const testing::TemporaryFolder folder;
  PlyWriter writer = writer_of(folder / "a.ply", {}, {});
  writer.append(0, std::uint8_t{7});
  writer.append(1, kThree, std::array<std::uint16_t, 3>{0, 1, 256});
  writer.append(0, std::uint8_t{8});
  writer.commit();
  EXPECT_EQ(read_file(folder / "a.ply"), kExpected);
}

TEST(PlyWriter, LeavesNothingWithoutCommit) {
  const testing::TemporaryFolder folder;
  for (const std::optional<std::int64_t> count : {std::optional<std::int64_t>(1), {}}) {
    PlyWriter writer(folder / "a.ply", {{"vertex", {"uchar x"}, count}});
    writer.append(0, kThree);
  }
  EXPECT_EQ(num_files(folder.path()), 0U);
}

TEST(PlyWriter, RefusesACountThatIsNotThatOfTheHeader) {
  const testing::TemporaryFolder folder;
  PlyWriter writer(folder / "a.ply", {{"vertex", {"uchar x"}, 2}});
  writer.append(0, kThree);
  EXPECT_THAT([&] { writer.commit(); },
              ThrowsMessage<std::logic_error>(HasSubstr("1 records of element vertex")));
}

TEST(PlyWriter, RefusesACommentOfSeveralLines) {
  const testing::TemporaryFolder folder;
  EXPECT_THROW(PlyWriter(folder / "a.ply", {{"vertex", {"uchar x"}}}, {"one\ntwo"}),
               std::invalid_argument);
}

TEST(PlyWriter, NamesAFolderThatIsNotThereAtOnce) {
  for (const std::optional<std::int64_t> count : {std::optional<std::int64_t>(1), {}}) {
    EXPECT_THAT(
        [&] {
          PlyWriter("/no/such/folder/a.ply", {{"vertex", {"uchar x"}, count}});
        },
        ThrowsMessage<std::system_error>(HasSubstr("/no/such/folder")));
  }
}

}  // namespace
}  // namespace kintsugi
