#include "segmenter/tools/query/query_report.hpp"

#include <algorithm>
#include <iterator>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "lcmtypes/base/json_text.hpp"
#include "lcmtypes/client/statistics_json.hpp"

namespace kintsugi::segmenter {
namespace {

using Json = nlohmann::ordered_json;  // keys in the order a person reads them
using Appender = std::back_insert_iterator<std::string>;

constexpr std::string_view kRow = "{:>10} {:>10} {:>9} {:>20} {:>22} {:>8} {:>15}  {}\n";

bool has_plane(const DescribedSegment& segment) {
  const auto& n = segment.plane_normal_W;
  return n[0] != 0.0F || n[1] != 0.0F || n[2] != 0.0F;
}

std::string text(const float (&v)[3], std::string_view separator, int decimals) {
  return fmt::format("{:.{}f}{}{:.{}f}{}{:.{}f}", v[0], decimals, separator, v[1], decimals,
                     separator, v[2], decimals);
}

std::string plane_text(const DescribedSegment& segment) {
  if (!has_plane(segment)) return "none";
  return fmt::format("{:+.2f} {:+.2f} {:+.2f} = {:+.3f}{}", segment.plane_normal_W[0],
                     segment.plane_normal_W[1], segment.plane_normal_W[2], segment.plane_offset_m,
                     segment.is_planar != 0 ? ", planar" : "");
}

std::string row(const DescribedSegment& segment, std::ptrdiff_t num_neighbours) {
  const SegmentStatistics& s = segment.statistics;
  const auto& rgb = s.mean_color;
  return fmt::format(kRow, s.segment_id, s.num_points, fmt::format("{:.3f}", s.area_m2),
                     text(segment.oriented_box_size_m, " x ", 2), text(s.centroid_W, " ", 2),
                     fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]), num_neighbours,
                     plane_text(segment));
}

/// What does not fit into a row.
std::string details(const DescribedSegment& segment, std::span<const SegmentContact> contacts) {
  const SegmentStatistics& s = segment.statistics;
  std::string out = fmt::format("\nsegment {}\n", s.segment_id);
  Appender to(out);
  fmt::format_to(to, "  box            {} to {}\n", text(s.box_min_W, " ", 3),
                 text(s.box_max_W, " ", 3));
  fmt::format_to(to, "  oriented box   centre {}, size {}\n",
                 text(segment.oriented_box_center_W, " ", 3),
                 text(segment.oriented_box_size_m, " x ", 3));
  for (const auto& axis : segment.oriented_box_axes_W) {
    fmt::format_to(to, "                 axis {}\n", text(axis, " ", 4));
  }
  fmt::format_to(to, "  mean normal    {}\n", text(s.mean_normal_W, " ", 4));
  fmt::format_to(to, "  plane          {}, rms {:.1f} mm, {:.0f} % of the points within a voxel\n",
                 plane_text(segment), 1e3 * segment.plane_rms_m, 1e2 * segment.plane_share);
  fmt::format_to(to, "  slices         {} to {}, last change at {} us\n", s.first_slice,
                 s.last_slice, segment.last_change_utime);
  fmt::format_to(to, "  neighbours    ");
  for (const SegmentContact& contact : contacts) {
    fmt::format_to(to, " {} ({} pairs)", contact.neighbour_id, contact.num_pairs);
  }
  return out + (contacts.empty() ? " none\n" : "\n");
}

/// The contacts of `segment_id`; those of one segment follow each other.
std::span<const SegmentContact> contacts_of(const SegmentAnswer& answer, std::uint32_t segment_id) {
  const auto is_of = [&](const SegmentContact& contact) {
    return contact.segment_id == segment_id;
  };
  const auto first = std::find_if(answer.contacts.begin(), answer.contacts.end(), is_of);
  return {first, std::find_if_not(first, answer.contacts.end(), is_of)};
}

Json plane_json(const DescribedSegment& segment) {
  if (!has_plane(segment)) return nullptr;
  return {{"normal", vector_json(segment.plane_normal_W)},
          {"offset", readable(segment.plane_offset_m)},
          {"rms", readable(segment.plane_rms_m)},
          {"inliers", readable(segment.plane_share)}};
}

Json segment_json(const DescribedSegment& segment, std::span<const SegmentContact> contacts) {
  const auto& axes = segment.oriented_box_axes_W;
  Json neighbours = Json::array();
  for (const SegmentContact& contact : contacts) {
    neighbours.push_back({{"id", contact.neighbour_id}, {"pairs", contact.num_pairs}});
  }
  Json json = statistics_json(segment.statistics);
  json["last_change"] = {{"utime", segment.last_change_utime}};
  json["oriented_box"] = {
      {"center", vector_json(segment.oriented_box_center_W)},
      {"size", vector_json(segment.oriented_box_size_m)},
      {"axes", {vector_json(axes[0]), vector_json(axes[1]), vector_json(axes[2])}}};
  json["plane"] = plane_json(segment);
  json["planar"] = segment.is_planar != 0;
  json["distance"] = readable(segment.distance_m);
  json["neighbours"] = std::move(neighbours);
  return json;
}

/// Why there is no segment.
std::string pixel_text(const SegmentAnswer& answer) {
  switch (pixel_result(answer)) {
    case PixelResult::kNoView:
      return "no view of the camera: the segmenter has received none with a known pose in the last "
             "2 s; is a mapper running, and does it track the camera?\n";
    case PixelResult::kNotMeasured:
      return "the camera measures nothing at this pixel\n";
    case PixelResult::kNotSegmented:
      return fmt::format("the surface at this pixel, {:.2f} m away, is in no segment yet\n",
                         answer.surface_distance_m);
    case PixelResult::kFound:
      break;
  }
  return "";
}

}  // namespace

PixelResult pixel_result(const SegmentAnswer& answer) {
  if (answer.has_hit) return PixelResult::kFound;
  if (answer.view_utime == 0) return PixelResult::kNoView;
  return answer.surface_distance_m == 0.0F ? PixelResult::kNotMeasured : PixelResult::kNotSegmented;
}

std::string answer_table(const SegmentAnswer& answer, QueryPlace place) {
  std::string out =
      fmt::format("map '{}' of session {}: {} slices, {} points, {} segments\n", answer.map_name,
                  answer.map_session, answer.map_slices, answer.map_points, answer.map_segments);
  Appender to(out);
  if (answer.has_hit) fmt::format_to(to, "found at {}\n", text(answer.hit_W, " ", 3));
  if (place == QueryPlace::kPixel && !answer.has_hit) return out + pixel_text(answer);
  if (answer.segments.empty()) return out + "no segment matches\n";
  if (answer.num_matching > std::ssize(answer.segments)) {
    fmt::format_to(to, "the {} largest of {} that match\n", answer.segments.size(),
                   answer.num_matching);
  }
  fmt::format_to(to, kRow, "id", "points", "area m^2", "size m", "centre m", "colour", "neighbours",
                 "plane");
  for (const DescribedSegment& segment : answer.segments) {
    out += row(segment, std::ssize(contacts_of(answer, segment.statistics.segment_id)));
  }
  if (answer.segments.size() == 1) out += details(answer.segments.front(), answer.contacts);
  return out;
}

std::string answer_json(const SegmentAnswer& answer, QueryPlace place) {
  Json segments = Json::array();
  for (const DescribedSegment& segment : answer.segments) {
    segments.push_back(segment_json(segment, contacts_of(answer, segment.statistics.segment_id)));
  }
  Json root{
      {"map",
       {{"name", answer.map_name},
        {"map_session", answer.map_session},
        {"session", answer.session},
        {"slices", answer.map_slices},
        {"points", answer.map_points},
        {"segments", answer.map_segments}}},
      {"matching", answer.num_matching},
      {"hit", answer.has_hit ? vector_json(answer.hit_W) : Json(nullptr)},
  };
  if (place == QueryPlace::kPixel) {
    const PixelResult result = pixel_result(answer);
    const bool is_measured = answer.surface_distance_m > 0.0F;
    root["view_utime"] = result == PixelResult::kNoView ? Json(nullptr) : Json(answer.view_utime);
    root["surface_distance_m"] =
        is_measured ? Json(readable(answer.surface_distance_m)) : Json(nullptr);
  }
  root["segments"] = std::move(segments);
  return json_text(root, 1) + "\n";
}

}  // namespace kintsugi::segmenter
