#include "mapper/output/map_writers.hpp"

#include <cstddef>
#include <cstring>
#include <span>

#include "mapper/output/part_file.hpp"

namespace kintsugi::mapper {
namespace {

constexpr std::size_t kVertices = 0;
constexpr std::size_t kFaces = 1;

/// Moves a vertex, whose record begins with this many of the floats of a CloudPoint; false: it is
/// dropped.
bool move_vertex(const PatchRuns& runs, std::int64_t record, std::span<char> bytes,
                 std::size_t num_floats) {
  CloudPoint point;
  std::memcpy(&point, bytes.data(), num_floats * sizeof(float));
  const auto moved = runs.moved(record, point);
  if (!moved) return false;
  std::memcpy(bytes.data(), &*moved, num_floats * sizeof(float));
  return true;
}

/// Numbers the vertices of a face anew; false: one of them is dropped.
bool renumber_face(const PatchRuns& runs, std::span<char> bytes) {
  MeshPiece::Triangle triangle;
  const std::span<char> indices = bytes.last(sizeof triangle);
  std::memcpy(&triangle, indices.data(), sizeof triangle);
  for (std::uint32_t& vertex : triangle) {
    const auto number = runs.number_of_kept(vertex);
    if (!number) return false;
    vertex = static_cast<std::uint32_t>(*number);
  }
  std::memcpy(indices.data(), &triangle, sizeof triangle);
  return true;
}

/// Part 0 is in the file itself, also where it is empty.
std::vector<WrittenFile> commit_by_part(PlyWriter& file, PatchRuns& runs,
                                        const PlaceOfPatch& place_of, std::size_t counted_element,
                                        const PlyWriter::Rewrite& rewrite) {
  runs.place(place_of);
  std::vector<WrittenFile> written;
  for (const int part : runs.parts()) {
    if (part == 0) continue;
    runs.select(part);
    const std::filesystem::path path = part_file(file.path(), part);
    written.push_back({path, file.write_copy(path, rewrite)[counted_element]});
  }
  runs.select(0);
  written.insert(written.begin(), {file.path(), file.commit(rewrite)[counted_element]});
  return written;
}

}  // namespace

CloudWriter::CloudWriter(const std::filesystem::path& path)
    : file_(path, {{"vertex",
                    {"float x", "float y", "float z", "float nx", "float ny", "float nz",
                     "uchar red", "uchar green", "uchar blue", "float weight"}}}) {}

void CloudWriter::append(const std::vector<CloudPoint>& points, const std::vector<PatchRun>& runs) {
  runs_.append(points.size(), runs);
  for (const CloudPoint& p : points) {
    file_.append(kVertices, p.x, p.y, p.z, p.nx, p.ny, p.nz, p.red, p.green, p.blue, p.weight);
  }
}

std::vector<WrittenFile> CloudWriter::commit(const PlaceOfPatch& place_of) {
  return commit_by_part(
      file_, runs_, place_of, kVertices,
      [this](std::size_t /*element*/, std::int64_t record, std::span<char> bytes) {
        return move_vertex(runs_, record, bytes, 6);
      });
}

MeshWriter::MeshWriter(const std::filesystem::path& path)
    : file_(path, {{"vertex",
                    {"float x", "float y", "float z", "uchar red", "uchar green", "uchar blue"}},
                   {"face", {"list uchar int vertex_indices"}}}) {}

void MeshWriter::append(const MeshPiece& piece, const std::vector<PatchRun>& runs) {
  runs_.append(piece.vertices.size(), runs);
  constexpr std::uint8_t kCorners = 3;
  for (const MeshPiece::Vertex& v : piece.vertices) {
    file_.append(kVertices, v.x, v.y, v.z, v.color_rgb);
  }
  for (const MeshPiece::Triangle& t : piece.triangles) file_.append(kFaces, kCorners, t);
}

std::vector<WrittenFile> MeshWriter::commit(const PlaceOfPatch& place_of) {
  return commit_by_part(file_, runs_, place_of, kFaces,
                        [this](std::size_t element, std::int64_t record, std::span<char> bytes) {
                          return element == kVertices ? move_vertex(runs_, record, bytes, 3)
                                                      : renumber_face(runs_, bytes);
                        });
}

}  // namespace kintsugi::mapper
