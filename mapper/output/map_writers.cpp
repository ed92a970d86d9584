#include "mapper/output/map_writers.hpp"

#include <cstddef>
#include <cstring>

namespace kintsugi::mapper {
namespace {

/// Values one after the other, without padding.
class PackedBytes {
 public:
  template <typename... Values>
  void append(const Values&... values) {
    (append_one(values), ...);
  }
  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  template <typename Value>
  void append_one(const Value& value) {
    const auto* first = reinterpret_cast<const std::byte*>(&value);
    bytes_.insert(bytes_.end(), first, first + sizeof value);
  }

  std::vector<std::byte> bytes_;
};

constexpr std::size_t kVertices = 0;
constexpr std::size_t kFaces = 1;

}  // namespace

CloudWriter::CloudWriter(const std::filesystem::path& path)
    : file_(path, {{"vertex",
                    {"float x", "float y", "float z", "float nx", "float ny", "float nz",
                     "uchar red", "uchar green", "uchar blue", "float weight"}}}) {}

void CloudWriter::append(const std::vector<CloudPoint>& points_W) {
  PackedBytes packed;
  for (const CloudPoint& p : points_W) {
    packed.append(p.x, p.y, p.z, p.nx, p.ny, p.nz, p.red, p.green, p.blue, p.weight);
  }
  file_.append(kVertices, packed.bytes(), std::ssize(points_W));
  num_points_ += std::ssize(points_W);
}

void CloudWriter::commit() { file_.commit(); }

MeshWriter::MeshWriter(const std::filesystem::path& path)
    : file_(path, {{"vertex",
                    {"float x", "float y", "float z", "uchar red", "uchar green", "uchar blue"}},
                   {"face", {"list uchar int vertex_indices"}}}) {}

void MeshWriter::append(const MeshPiece& piece) {
  PackedBytes vertices;
  for (const MeshPiece::Vertex& v : piece.vertices) vertices.append(v.x, v.y, v.z, v.color_rgb);
  file_.append(kVertices, vertices.bytes(), std::ssize(piece.vertices));
  PackedBytes faces;
  for (const MeshPiece::Triangle& t : piece.triangles) faces.append(std::uint8_t{3}, t);
  file_.append(kFaces, faces.bytes(), std::ssize(piece.triangles));
  num_triangles_ += std::ssize(piece.triangles);
}

void MeshWriter::commit() { file_.commit(); }

}  // namespace kintsugi::mapper
