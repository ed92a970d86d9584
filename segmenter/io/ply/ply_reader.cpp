#include "segmenter/io/ply/ply_reader.hpp"

#include "segmenter/io/ply/ply_table.hpp"
#include "segmenter/io/points/file_bytes.hpp"

namespace kintsugi::segmenter {

PlyCloud parse_ply(std::string_view bytes, const std::string& name) {
  const PointTable table = parse_ply_table(bytes, name);
  return cloud_of(table, find_roles(table, name), {}, name);
}

PlyCloud read_ply(const std::filesystem::path& path) {
  return parse_ply(read_file_bytes(path), path.string());
}

}  // namespace kintsugi::segmenter
