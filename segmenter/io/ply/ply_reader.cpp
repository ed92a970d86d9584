#include "segmenter/io/ply/ply_reader.hpp"

#include "segmenter/io/ply/ply_table.hpp"
#include "segmenter/io/points/file_bytes.hpp"
#include "segmenter/io/points/length_unit.hpp"

namespace kintsugi::segmenter {

PlyCloud parse_ply(std::string_view bytes, const std::string& name) {
  const PointTable table = parse_ply_table(bytes, name);
  const PositionFrame frame{.metres_per_unit = metres_per(unit_told_by(table.comments))};
  return cloud_of(table, find_roles(table, name), frame, name);
}

PlyCloud read_ply(const std::filesystem::path& path) {
  return parse_ply(read_file_bytes(path), path.string());
}

}  // namespace kintsugi::segmenter
