#include "lcmtypes/client/segment_table_text.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "lcmtypes/base/text_format.hpp"

namespace kintsugi {
namespace {

/// The type that `%lld` needs.
long long number(std::int64_t value) { return value; }

std::string summary_text(const SegmentUpdate& update) {
  std::array<int, 5> counts{};
  for (const SegmentEvent& event : update.events) ++counts.at(static_cast<std::size_t>(event.type));
  std::string text = format("slice %d", update.slice_id);
  if (update.slice_revision > 0) text += format(" revision %d", update.slice_revision);
  text += format(": %lld points, %lld segments", number(update.num_points),
                 number(update.num_segments));
  if (update.events.empty() && lists_all_segments(update)) return text + ", all listed\n";
  return text + format("; %d created, %d grown, %d merged, %d split, %d retired\n", counts[0],
                       counts[1], counts[2], counts[3], counts[4]);
}

std::string event_text(const SegmentEvent& event) {
  switch (event.type) {
    case SegmentEventType::kCreated:
      return format("  %u created", event.segment_id);
    case SegmentEventType::kGrown:
      return format("  %u grown", event.segment_id);
    case SegmentEventType::kMerged:
      return format("  %u merged into %u", event.other_id, event.segment_id);
    case SegmentEventType::kSplit:
      return format("  %u split off %u", event.other_id, event.segment_id);
    case SegmentEventType::kRetired:
      return format("  %u retired", event.segment_id);
  }
  return "";
}

/// The segment whose statistics are printed with the event: the new one, or the one that has grown.
std::uint32_t subject(const SegmentEvent& event) {
  return event.type == SegmentEventType::kSplit ? event.other_id : event.segment_id;
}

std::string statistics_text(const SegmentStatistics& s) {
  return format(": %u points at %.2f %.2f %.2f m", s.num_points, s.centroid_W[0], s.centroid_W[1],
                s.centroid_W[2]);
}

std::string row_text(const SegmentStatistics& s) {
  const auto side_m = [&](int axis) {
    return double{s.box_max_W[axis]} - double{s.box_min_W[axis]};
  };
  return format("%8u %9u %9.3f   %6.2f %6.2f %6.2f   %5.2f %5.2f %5.2f   %3d %3d %3d   %d-%d\n",
                s.segment_id, s.num_points, s.area_m2, s.centroid_W[0], s.centroid_W[1],
                s.centroid_W[2], side_m(0), side_m(1), side_m(2), s.mean_color[0], s.mean_color[1],
                s.mean_color[2], s.first_slice, s.last_slice);
}

std::vector<SegmentStatistics> largest(const SegmentTable& table, std::size_t count) {
  std::vector<SegmentStatistics> all;
  all.reserve(table.segments().size());
  for (const auto& [id, segment] : table.segments()) all.push_back(segment.statistics);
  std::ranges::stable_sort(all, std::ranges::greater(), &SegmentStatistics::num_points);
  all.resize(std::min(count, all.size()));
  return all;
}

}  // namespace

std::string update_text(const SegmentUpdate& update, bool with_grown) {
  if (update.events.empty() && update.statistics.empty()) return "";
  std::map<std::uint32_t, const SegmentStatistics*> changed;
  for (const SegmentStatistics& s : update.statistics) changed[s.segment_id] = &s;
  std::string text = summary_text(update);
  for (const SegmentEvent& event : update.events) {
    if (event.type == SegmentEventType::kGrown && !with_grown) continue;
    text += event_text(event);
    const auto found = changed.find(subject(event));
    if (found != changed.end()) text += statistics_text(*found->second);
    text += '\n';
  }
  return text;
}

std::string table_text(const SegmentTable& table, std::size_t num_listed) {
  if (table.newest() == nullptr) return "no segment updates\n";
  const SegmentUpdate& newest = *table.newest();
  std::string text =
      "map '" + newest.map_name + "' " +
      format("of session %lld: %d slices, %lld points, %zu segments%s\n",
             number(newest.map_session), newest.num_slices, number(newest.num_points),
             table.segments().size(), table.is_final() ? ", complete" : "");
  const std::vector<SegmentStatistics> rows = largest(table, num_listed);
  if (!rows.empty()) {
    text +=
        "      id    points  area m^2   centroid in W, m         box, m              "
        "colour        slices\n";
  }
  for (const SegmentStatistics& row : rows) text += row_text(row);
  const std::size_t num_more = table.segments().size() - rows.size();
  if (num_more > 0) text += format("and %zu smaller ones\n", num_more);
  return text;
}

}  // namespace kintsugi
