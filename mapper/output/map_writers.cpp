#include "mapper/output/map_writers.hpp"

#include <cstddef>
#include <cstring>
#include <span>

namespace kintsugi::mapper {
namespace {

constexpr std::size_t kVertices = 0;
constexpr std::size_t kFaces = 1;

/// Moves vertices, whose records begin with this many of the floats of a CloudPoint.
PlyWriter::Rewrite moves(PatchRuns& runs, const PoseOfPatch& pose_of, std::size_t num_floats) {
  if (!pose_of) return {};
  return [&runs, &pose_of, num_floats](std::size_t element, std::int64_t record,
                                       std::span<char> bytes) {
    if (element != kVertices) return;
    CloudPoint point;
    std::memcpy(&point, bytes.data(), num_floats * sizeof(float));
    point = runs.moved(record, point, pose_of);
    std::memcpy(bytes.data(), &point, num_floats * sizeof(float));
  };
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

std::int64_t CloudWriter::num_points() const { return file_.count(kVertices); }

void CloudWriter::commit(const PoseOfPatch& pose_of) { file_.commit(moves(runs_, pose_of, 6)); }

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

std::int64_t MeshWriter::num_triangles() const { return file_.count(kFaces); }

void MeshWriter::commit(const PoseOfPatch& pose_of) { file_.commit(moves(runs_, pose_of, 3)); }

}  // namespace kintsugi::mapper
