#include "mapper/output/map_writers.hpp"

#include <cstddef>

namespace kintsugi::mapper {
namespace {

constexpr std::size_t kVertices = 0;
constexpr std::size_t kFaces = 1;

}  // namespace

CloudWriter::CloudWriter(const std::filesystem::path& path)
    : file_(path, {{"vertex",
                    {"float x", "float y", "float z", "float nx", "float ny", "float nz",
                     "uchar red", "uchar green", "uchar blue", "float weight"}}}) {}

void CloudWriter::append(const std::vector<CloudPoint>& points_W) {
  for (const CloudPoint& p : points_W) {
    file_.append(kVertices, p.x, p.y, p.z, p.nx, p.ny, p.nz, p.red, p.green, p.blue, p.weight);
  }
}

std::int64_t CloudWriter::num_points() const { return file_.count(kVertices); }

void CloudWriter::commit() { file_.commit(); }

MeshWriter::MeshWriter(const std::filesystem::path& path)
    : file_(path, {{"vertex",
                    {"float x", "float y", "float z", "uchar red", "uchar green", "uchar blue"}},
                   {"face", {"list uchar int vertex_indices"}}}) {}

void MeshWriter::append(const MeshPiece& piece) {
  constexpr std::uint8_t kCorners = 3;
  for (const MeshPiece::Vertex& v : piece.vertices) {
    file_.append(kVertices, v.x, v.y, v.z, v.color_rgb);
  }
  for (const MeshPiece::Triangle& t : piece.triangles) file_.append(kFaces, kCorners, t);
}

std::int64_t MeshWriter::num_triangles() const { return file_.count(kFaces); }

void MeshWriter::commit() { file_.commit(); }

}  // namespace kintsugi::mapper
