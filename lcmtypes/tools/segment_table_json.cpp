#include <charconv>

#include <nlohmann/json.hpp>

#include "lcmtypes/tools/segment_table_text.hpp"

namespace kintsugi {
namespace {

using Json = nlohmann::ordered_json;  // keys in the order a person reads them

/// The double with the shortest decimals that mean this float: 0.01 instead of 0.00999999977.
double readable(float value) {
  char text[32];
  const auto end = std::to_chars(std::begin(text), std::end(text), value).ptr;
  double result = 0.0;
  std::from_chars(std::begin(text), end, result);
  return result;
}

Json vector_json(const float (&v)[3]) { return {readable(v[0]), readable(v[1]), readable(v[2])}; }

Json born_json(const SegmentTable::Origin* origin) {
  if (origin == nullptr) return nullptr;
  return {{"slice", origin->slice_id}, {"parent", origin->parent_id}};
}

Json segment_json(const SegmentStatistics& s, const SegmentTable& table) {
  return {{"id", s.segment_id},
          {"points", s.num_points},
          {"box_min", vector_json(s.box_min_W)},
          {"box_max", vector_json(s.box_max_W)},
          {"centroid", vector_json(s.centroid_W)},
          {"mean_normal", vector_json(s.mean_normal_W)},
          {"mean_color", {s.mean_color[0], s.mean_color[1], s.mean_color[2]}},
          {"area", readable(s.area_m2)},
          {"first_slice", s.first_slice},
          {"last_slice", s.last_slice},
          {"born", born_json(table.origin(s.segment_id))}};
}

Json header_json(const SegmentTable& table, bool is_whole) {
  const SegmentUpdate newest = table.newest() != nullptr ? *table.newest() : SegmentUpdate();
  return {{"map_name", newest.map_name},
          {"map_session", newest.map_session},
          {"session", newest.session},
          {"complete", table.is_final()},
          {"whole", is_whole},
          {"num_slices", newest.num_slices},
          {"num_points", newest.num_points},
          {"num_segments", newest.num_segments}};
}

}  // namespace

void write_table_json(const SegmentTable& table, bool is_whole, std::ostream& out) {
  std::string head = header_json(table, is_whole).dump(1);
  head.resize(head.rfind('\n'));
  out << head << ",\n \"segments\": [";
  const char* separator = "\n";  // one line for each segment
  for (const auto& [id, segment] : table.segments()) {
    out << separator << "  " << segment_json(segment.statistics, table).dump();
    separator = ",\n";
  }
  out << "\n ]\n}\n";
}

}  // namespace kintsugi
