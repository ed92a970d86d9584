#include "lcmtypes/base/json_text.hpp"
#include "lcmtypes/client/segment_table_text.hpp"
#include "lcmtypes/client/statistics_json.hpp"

namespace kintsugi {
namespace {

using Json = nlohmann::ordered_json;  // keeps the order of the keys

Json born_json(const SegmentTable::Origin* origin) {
  if (origin == nullptr) return nullptr;
  return {{"slice", origin->slice_id}, {"parent", origin->parent_id}};
}

Json segment_json(const SegmentStatistics& s, const SegmentTable& table) {
  Json json = statistics_json(s);
  json["born"] = born_json(table.origin(s.segment_id));
  return json;
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
  std::string head = json_text(header_json(table, is_whole), 1);
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
