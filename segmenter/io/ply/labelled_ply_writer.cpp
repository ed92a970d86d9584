#include "segmenter/io/ply/labelled_ply_writer.hpp"

#include <limits>
#include <stdexcept>

namespace kintsugi::segmenter {
namespace {

kintsugi::PlyElement vertex_element(std::int64_t num_points) {
  return {.name = "vertex",
          .properties = {"float x", "float y", "float z", "float nx", "float ny", "float nz",
                         "uchar red", "uchar green", "uchar blue", "int segment_id", "int slice_id",
                         "float weight", "uchar in_volume"},
          .count = num_points};
}

}  // namespace

std::int32_t signed_label(std::uint32_t segment_id) {
  if (segment_id > static_cast<std::uint32_t>(std::numeric_limits<std::int32_t>::max())) {
    throw std::overflow_error("segment_id " + std::to_string(segment_id) +
                              " does not fit into the int of a PLY file");
  }
  return static_cast<std::int32_t>(segment_id);
}

LabelledPlyWriter::LabelledPlyWriter(const std::filesystem::path& path, std::int64_t num_points,
                                     const std::vector<std::string>& comments)
    : writer_(path, {vertex_element(num_points)}, comments) {}

void LabelledPlyWriter::append(const CloudPoint& point_W, std::uint32_t segment_id,
                               std::int32_t slice_id, bool is_in_volume) {
  const CloudPoint& p = point_W;
  const std::int32_t label = signed_label(segment_id);
  writer_.append(0, p.x, p.y, p.z, p.nx, p.ny, p.nz, p.red, p.green, p.blue, label, slice_id,
                 p.weight, static_cast<std::uint8_t>(is_in_volume ? 1 : 0));
}

}  // namespace kintsugi::segmenter
