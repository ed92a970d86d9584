#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/codec/codec.hpp"
#include "lcmtypes/log/log_writer.hpp"
#include "mapper/output/cloud_reader.hpp"
#include "mapper/output/map_writers.hpp"
#include "tests/support/allocation_limit.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::mapper {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

std::string read_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

int num_files(const std::filesystem::path& folder) {
  return static_cast<int>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

/// Reads values one after the other, as the PLY format has them; knows nothing of the writers.
class Bytes {
 public:
  explicit Bytes(std::string bytes) : bytes_(std::move(bytes)) {}
  std::string line() {
    const std::size_t end = bytes_.find('\n', position_);
    std::string result = bytes_.substr(position_, end - position_);
    position_ = end + 1;
    return result;
  }
  template <typename Value>
  Value value() {
    Value result;
    std::memcpy(&result, bytes_.data() + position_, sizeof result);
    position_ += sizeof result;
    return result;
  }
  bool at_end() const { return position_ == bytes_.size(); }

 private:
  std::string bytes_;
  std::size_t position_ = 0;
};

CloudPoint example_point(int i) {
  const auto f = static_cast<float>(i);
  return {.x = f,
          .y = 2 * f,
          .z = -f,
          .nx = 0,
          .ny = 0.6F,
          .nz = 0.8F,
          .red = static_cast<std::uint8_t>(i),
          .green = 2,
          .blue = 3,
          .weight = 10 + f};
}

TEST(CloudWriter, WritesWhatAReaderOfPlyExpects) {
  const kintsugi::testing::TemporaryFolder folder;
  CloudWriter writer(folder.path() / "map.ply");
  writer.append({example_point(0), example_point(1)});
  writer.append({});
  writer.append({example_point(2)});
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "map.ply"));
  EXPECT_EQ(writer.commit().at(0).count, 3);
  Bytes bytes(read_file(folder.path() / "map.ply"));
  for (const char* expected :
       {"ply", "format binary_little_endian 1.0", "element vertex 3", "property float x",
        "property float y", "property float z", "property float nx", "property float ny",
        "property float nz", "property uchar red", "property uchar green", "property uchar blue",
        "property float weight", "end_header"}) {
    EXPECT_EQ(bytes.line(), expected);
  }
  for (int i = 0; i < 3; ++i) {
    const CloudPoint p = example_point(i);
    for (const float expected : {p.x, p.y, p.z, p.nx, p.ny, p.nz}) {
      EXPECT_EQ(bytes.value<float>(), expected);
    }
    for (const int expected : {i, 2, 3}) EXPECT_EQ(bytes.value<std::uint8_t>(), expected);
    EXPECT_EQ(bytes.value<float>(), p.weight);
  }
  EXPECT_TRUE(bytes.at_end());
}

TEST(CloudWriter, LeavesNothingWithoutCommit) {
  const kintsugi::testing::TemporaryFolder folder;
  {
    CloudWriter writer(folder.path() / "map.ply");
    writer.append({example_point(1)});
  }
  EXPECT_EQ(num_files(folder.path()), 0);
}

TEST(CloudWriter, SaysAtOnceThatAFolderIsNotThere) {
  EXPECT_THROW(CloudWriter("/nonexistent/folder/map.ply"), std::system_error);
}

TEST(MeshWriter, WritesWhatAReaderOfPlyExpects) {
  const kintsugi::testing::TemporaryFolder folder;
  MeshWriter writer(folder.path() / "mesh.ply");
  writer.append({.vertices = {{1, 2, 3, {4, 5, 6}}, {7, 8, 9, {1, 1, 1}}, {0, 0, 0, {2, 2, 2}}},
                 .triangles = {{0, 1, 2}}});
  writer.append({.vertices = {{5, 5, 5, {3, 3, 3}}}, .triangles = {{2, 1, 3}, {3, 0, 2}}});
  EXPECT_EQ(writer.commit().at(0).count, 3);
  EXPECT_EQ(num_files(folder.path()), 1);
  Bytes bytes(read_file(folder.path() / "mesh.ply"));
  for (const char* expected :
       {"ply", "format binary_little_endian 1.0", "element vertex 4", "property float x",
        "property float y", "property float z", "property uchar red", "property uchar green",
        "property uchar blue", "element face 3", "property list uchar int vertex_indices",
        "end_header"}) {
    EXPECT_EQ(bytes.line(), expected);
  }
  EXPECT_EQ(bytes.value<float>(), 1.0F);
  for (int i = 0; i < 2; ++i) bytes.value<float>();
  EXPECT_EQ(bytes.value<std::uint8_t>(), 4);
  for (int i = 0; i < 2 + 2 * 15; ++i) bytes.value<std::uint8_t>();
  EXPECT_EQ(bytes.value<float>(), 5.0F);
  for (int i = 0; i < 2; ++i) bytes.value<float>();
  for (int i = 0; i < 3; ++i) EXPECT_EQ(bytes.value<std::uint8_t>(), 3);
  for (const auto& triangle : {std::array{0, 1, 2}, std::array{2, 1, 3}, std::array{3, 0, 2}}) {
    EXPECT_EQ(bytes.value<std::uint8_t>(), 3);
    for (const int vertex : triangle) EXPECT_EQ(bytes.value<std::int32_t>(), vertex);
  }
  EXPECT_TRUE(bytes.at_end());
}

TEST(CloudReader, ReadsWhatTheWriterWrote) {
  const kintsugi::testing::TemporaryFolder folder;
  CloudWriter writer(folder.path() / "map.ply");
  std::vector<CloudPoint> points(100);
  for (int i = 0; i < 100; ++i) points[i] = example_point(i);
  writer.append(points);
  writer.commit();
  EXPECT_EQ(read_cloud(folder.path() / "map.ply"), points);
}

TEST(CloudReader, SaysWhatIsWrongWithAFile) {
  const kintsugi::testing::TemporaryFolder folder;
  const auto path = folder.path() / "map.ply";
  EXPECT_THAT([&] { read_cloud(path); }, ThrowsMessage<std::runtime_error>(HasSubstr("map.ply: ")));
  CloudWriter writer(path);
  writer.append({example_point(1), example_point(2)});
  writer.commit();
  const std::string whole = read_file(path);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    std::ofstream(path, std::ios::binary) << whole.substr(0, size);
    EXPECT_THROW(read_cloud(path), std::runtime_error) << size;
  }
}

TEST(CloudReader, RefusesPointsThatAreNowhere) {
  const kintsugi::testing::TemporaryFolder folder;
  const auto path = folder.path() / "map.ply";
  for (const float x : {NAN, INFINITY, 1e30F}) {
    CloudPoint nowhere = example_point(2);
    nowhere.x = x;
    CloudWriter writer(path);
    writer.append({example_point(1), nowhere});
    writer.commit();
    EXPECT_THAT([&] { read_cloud(path); },
                ThrowsMessage<std::runtime_error>(HasSubstr("map.ply: point 1 has coordinates")));
  }
}

TEST(CloudReader, TakesNoMemoryForPointsThatCannotBeThere) {
  const kintsugi::testing::TemporaryFolder folder;
  const auto path = folder.path() / "map.ply";
  CloudWriter writer(path);
  writer.append({example_point(1), example_point(2)});
  writer.commit();
  const std::string whole = read_file(path);
  const std::size_t count = whole.find("vertex ") + 7;
  const std::size_t end = whole.find('\n', count);
  for (const char* claim : {"2000000000", "99999999999999999999", "-1", "2x", ""}) {
    std::ofstream(path, std::ios::binary) << std::string(whole).replace(count, end - count, claim);
    const auto refuse = [&] { EXPECT_THROW(read_cloud(path), std::runtime_error) << claim; };
    EXPECT_LT(kintsugi::testing::allocated_by(refuse), 32'768U) << claim;  // the stream's buffer
  }
}

TEST(CloudReader, RefusesAHeaderWithoutAnEnd) {
  const kintsugi::testing::TemporaryFolder folder;
  const auto path = folder.path() / "map.ply";
  CloudWriter writer(path);
  writer.commit();
  std::string header = read_file(path);
  header.pop_back();
  // A claim that the length of the file, taken for that of the points, would bear out.
  const std::string claim = std::to_string((header.size() + 1) / 31);
  const std::size_t count = header.find("vertex ") + 7;
  header.replace(count, header.find('\n', count) - count, claim);
  std::ofstream(path, std::ios::binary) << header;
  EXPECT_THAT([&] { read_cloud(path); },
              ThrowsMessage<std::runtime_error>(HasSubstr("ends with its header")));
}

TEST(CloudReader, RefusesALogThatIsDamagedOrHasNoSlices) {
  const kintsugi::testing::TemporaryFolder folder;
  const auto path = folder.path() / "run.lcm";
  {
    LogWriter log = LogWriter::create(path);
    for (std::int32_t id = 0; id < 2; ++id) {
      CloudSlice slice;
      slice.session = 1;
      slice.id = id;
      slice.map_name = "map";
      slice.resolution_m = 0.01F;
      slice.points_W = {example_point(id)};
      log.append(1, channels::kCloudSlice, encode_chunk(slice, id, 0, kDefaultMaxChunkBytes));
    }
  }
  EXPECT_EQ(read_cloud(path).size(), 2U);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 1);
  EXPECT_THAT([&] { read_cloud(path); },
              ThrowsMessage<std::runtime_error>(HasSubstr("the event lacks its last 1 bytes")));
  LogWriter::create_anew(path).append(1, channels::kCameraPose, kintsugi::Bytes(9));
  EXPECT_THAT([&] { read_cloud(path); },
              ThrowsMessage<std::runtime_error>(HasSubstr("run.lcm: has no slices")));
}

TEST(CloudWriter, MovesPointsOfPatchesWhenTheFileIsCompleted) {
  const kintsugi::testing::TemporaryFolder folder;
  const auto path = folder.path() / "map.ply";
  CloudWriter writer(path);
  const std::vector<CloudPoint> points = {example_point(1), example_point(2), example_point(3)};
  writer.append(points, {{1, 7}, {2, 8}});
  writer.append(points);
  writer.append({example_point(4)}, {{1, 8}});
  writer.commit([](int patch) {
    Pose X_WP = Pose::Identity();
    X_WP.translation().z() = patch == 7 ? 100.0 : 200.0;
    return PatchPlace{.X_WP = X_WP, .correction = 1, .part = 0};
  });
  const std::vector<CloudPoint> read = read_cloud(path);
  ASSERT_EQ(read.size(), 7U);
  const std::array<float, 7> motion_m = {100.0F, 200.0F, 200.0F, 0.0F, 0.0F, 0.0F, 200.0F};
  const std::array<int, 7> source = {1, 2, 3, 1, 2, 3, 4};
  for (std::size_t i = 0; i < read.size(); ++i) {
    CloudPoint expected = example_point(source[i]);
    expected.z += motion_m[i];
    EXPECT_EQ(read[i], expected) << "point " << i;
  }
}

TEST(MeshWriter, MovesVerticesOfPatchesAndLeavesTriangles) {
  const kintsugi::testing::TemporaryFolder folder;
  const auto still = folder.path() / "still.ply";
  const auto moved = folder.path() / "moved.ply";
  MeshPiece piece;
  piece.vertices = {{1, 2, 3, {9, 8, 7}}, {4, 5, 6, {6, 5, 4}}, {7, 8, 9, {3, 2, 1}}};
  piece.triangles = {{0, 1, 2}};
  MeshPiece expected = piece;
  expected.vertices[2].x += 10.0F;
  MeshWriter expected_writer(still);
  expected_writer.append(expected);
  expected_writer.commit();
  MeshWriter writer(moved);
  writer.append(piece, {{2, kNoPatch}, {1, 0}});
  writer.commit([](int) {
    Pose X_WP = Pose::Identity();
    X_WP.translation().x() = 10.0;
    return PatchPlace{.X_WP = X_WP, .correction = 1, .part = 0};
  });
  EXPECT_EQ(read_file(moved), read_file(still));
}

/// Patch 1 was replaced.
std::optional<PatchPlace> all_but_patch_1(int patch) {
  return patch == 1 ? std::nullopt : std::optional(PatchPlace());
}

TEST(CloudWriter, DropsPointsOfPatchesThatCountNoMore) {
  const kintsugi::testing::TemporaryFolder folder;
  CloudWriter writer(folder.path() / "map.ply");
  std::vector<CloudPoint> points(10'000);
  for (int i = 0; i < 10'000; ++i) points[i] = example_point(i);
  writer.append(points, {{3'000, 0}, {4'000, 1}, {2'000, kNoPatch}, {1'000, 2}});
  EXPECT_EQ(writer.commit(all_but_patch_1).at(0).count, 6'000);
  points.erase(points.begin() + 3'000, points.begin() + 7'000);
  EXPECT_EQ(read_cloud(folder.path() / "map.ply"), points);
  EXPECT_EQ(num_files(folder.path()), 1);
}

/// Patch 2 is in part 3 of the map, the others in part 0.
std::optional<PatchPlace> patch_2_in_part_3(int patch) {
  return PatchPlace{.X_WP = {}, .correction = 0, .part = patch == 2 ? 3 : 0};
}

TEST(CloudWriter, WritesAFileForEachPartOfTheMap) {
  const kintsugi::testing::TemporaryFolder folder;
  CloudWriter writer(folder.path() / "map.ply");
  writer.append({example_point(1), example_point(2), example_point(3)}, {{1, 1}, {2, 2}});
  writer.append({example_point(4)}, {{.num_points = 1, .patch = kNoPatch, .part = 3}});
  const std::vector<WrittenFile> written = writer.commit(patch_2_in_part_3);
  ASSERT_EQ(written.size(), 2U);
  EXPECT_EQ(written[0].count, 1);
  EXPECT_EQ(written[1].path, folder.path() / "map.part3.ply");
  EXPECT_EQ(written[1].count, 3);
  EXPECT_EQ(read_cloud(folder.path() / "map.ply"), (std::vector{example_point(1)}));
  EXPECT_EQ(read_cloud(written[1].path),
            (std::vector{example_point(2), example_point(3), example_point(4)}));
  EXPECT_EQ(num_files(folder.path()), 2) << "no temporary file is left";
}

TEST(MeshWriter, WritesAFileForEachPartOfTheMap) {
  const kintsugi::testing::TemporaryFolder folder;
  MeshWriter writer(folder.path() / "mesh.ply");
  MeshPiece piece;
  for (int i = 0; i < 6; ++i) piece.vertices.push_back({static_cast<float>(i), 0, 0, {}});
  piece.triangles = {{0, 1, 2}, {3, 4, 5}};
  writer.append(piece, {{3, 1}, {3, 2}});
  writer.commit(patch_2_in_part_3);
  MeshWriter expected(folder.path() / "expected.ply");
  piece.vertices.erase(piece.vertices.begin(), piece.vertices.begin() + 3);
  piece.triangles = {{0, 1, 2}};
  expected.append(piece);
  expected.commit();
  EXPECT_EQ(read_file(folder.path() / "mesh.part3.ply"), read_file(folder.path() / "expected.ply"));
}

TEST(MeshWriter, DropsFacesOfVerticesThatCountNoMore) {
  const kintsugi::testing::TemporaryFolder folder;
  MeshWriter writer(folder.path() / "mesh.ply");
  MeshPiece piece;
  for (int i = 0; i < 6; ++i) piece.vertices.push_back({static_cast<float>(i), 0, 0, {}});
  piece.triangles = {{0, 1, 4}, {1, 2, 4}, {4, 5, 0}, {2, 3, 4}};
  writer.append(piece, {{2, 0}, {2, 1}, {2, 2}});
  EXPECT_EQ(writer.commit(all_but_patch_1).at(0).count, 2);
  Bytes bytes(read_file(folder.path() / "mesh.ply"));
  while (bytes.line() != "end_header") {
  }
  for (const float x : {0.0F, 1.0F, 4.0F, 5.0F}) {
    EXPECT_EQ(bytes.value<float>(), x);
    for (int i = 0; i < 2; ++i) bytes.value<float>();
    for (int i = 0; i < 3; ++i) bytes.value<std::uint8_t>();
  }
  for (const auto& triangle : {std::array{0, 1, 2}, std::array{2, 3, 0}}) {
    EXPECT_EQ(bytes.value<std::uint8_t>(), 3);
    for (const int vertex : triangle) EXPECT_EQ(bytes.value<std::int32_t>(), vertex);
  }
  EXPECT_TRUE(bytes.at_end());
}

}  // namespace
}  // namespace kintsugi::mapper
