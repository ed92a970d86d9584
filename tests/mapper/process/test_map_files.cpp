#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <system_error>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "mapper/process/map_files.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::mapper {
namespace {

using kintsugi::testing::TemporaryFolder;

std::vector<CloudPoint> points(int count) {
  return std::vector<CloudPoint>(static_cast<std::size_t>(count));
}

MeshPiece one_triangle() {
  MeshPiece piece;
  piece.vertices.resize(3);
  piece.triangles = {{0, 1, 2}};
  return piece;
}

/// The header's line that begins with `text`, or "".
std::string header_line(const std::filesystem::path& file, const std::string& text) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line) && line != "end_header";) {
    if (line.starts_with(text)) return line;
  }
  return "";
}

TEST(MapFiles, HoldWhatWasAdded) {
  const TemporaryFolder folder;
  MapFiles files(folder / "cloud.ply", folder / "mesh.ply");
  for (const int num_points : {3, 0, 4}) files.points_sink()(points(num_points), {});
  files.mesh_sink()(one_triangle(), {});
  files.points_sink()(points(2), {});
  EXPECT_FALSE(std::filesystem::exists(folder / "cloud.ply"));
  files.commit();
  EXPECT_EQ(header_line(folder / "cloud.ply", "element vertex"), "element vertex 9");
  EXPECT_EQ(header_line(folder / "mesh.ply", "element face"), "element face 1");
  EXPECT_FALSE(files.failed());
}

TEST(MapFiles, AreThoseThatWereAskedFor) {
  const TemporaryFolder folder;
  MapFiles files("", "");
  EXPECT_FALSE(files.mesh_sink());
  EXPECT_FALSE(files.points_sink());
  files.commit();
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  EXPECT_FALSE(files.failed());
}

TEST(MapFiles, RefuseAFolderThatIsNotThere) {
  EXPECT_THROW(MapFiles("/no/such/folder/cloud.ply", ""), std::system_error);
  EXPECT_THROW(MapFiles("", "/no/such/folder/mesh.ply"), std::system_error);
}

/// A limit on the size of files stands for a disk that fills up.
void add_more_than_fits(const TemporaryFolder& folder) {
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{100'000, RLIM_INFINITY};
  setrlimit(RLIMIT_FSIZE, &limit);
  MapFiles files(folder / "cloud.ply", folder / "mesh.ply");
  const auto sink = files.points_sink();
  for (int i = 0; i < 10; ++i) sink(points(2'000), {});
  files.mesh_sink()(one_triangle(), {});
  files.commit();
  std::exit(files.failed() ? 0 : 1);
}

TEST(MapFiles, GiveUpTheFileThatDoesNotFitAndNothingElse) {
  const TemporaryFolder folder;
  EXPECT_EXIT(add_more_than_fits(folder), ::testing::ExitedWithCode(0), "");
  EXPECT_FALSE(std::filesystem::exists(folder / "cloud.ply"));
  EXPECT_EQ(header_line(folder / "mesh.ply", "element face"), "element face 1");
}

}  // namespace
}  // namespace kintsugi::mapper
