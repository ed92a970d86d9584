#include "segmenter/io/segments_csv.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <ostream>
#include <string>
#include <string_view>

#include "lcmtypes/base/atomic_file.hpp"
#include "lcmtypes/base/number_text.hpp"

namespace kintsugi::segmenter {
namespace {

/// Calls fn(name, number) for each component.
template <class Vector, class Fn>
void for_each_component(const std::string& name, const Vector& v, const Fn& fn) {
  const char* const suffixes[] = {"_x", "_y", "_z"};
  for (int axis = 0; axis < 3; ++axis) {
    fn(name + suffixes[axis], shortest_text(static_cast<float>(v[axis])));
  }
}

std::string ids_text(std::span<const SegmentNeighbour> neighbours) {
  std::string text;
  for (const SegmentNeighbour& neighbour : neighbours) {
    if (!text.empty()) text += ' ';
    text += std::to_string(neighbour.segment_id);
  }
  return text;
}

template <class Fn>
void for_each_box_field(const OrientedBox& box, const Fn& fn) {
  for_each_component("oriented_center", box.X_WB.translation(), fn);
  for_each_component("oriented_size", box.size_m, fn);
  const Eigen::Quaterniond q_WB(box.X_WB.linear());
  fn("oriented_qw", shortest_text(static_cast<float>(q_WB.w())));
  for_each_component("oriented_q", q_WB.vec(), fn);
}

// Columns of one field of the statistics, by its type.
template <class Fn>
void write_statistic(const std::string& name, float value, const Fn& fn) {
  fn(name, shortest_text(value));
}
template <class Fn>
void write_statistic(const std::string& name, std::int32_t value, const Fn& fn) {
  fn(name, std::to_string(value));
}
template <class Fn>
void write_statistic(const std::string& name, std::uint32_t value, const Fn& fn) {
  fn(name, std::to_string(value));
}
template <class Fn>
void write_statistic(const std::string& name, const float (&vector)[3], const Fn& fn) {
  for_each_component(name, vector, fn);
}
template <class Fn>
void write_statistic(const std::string& /*name*/, const std::uint8_t (&color)[3], const Fn& fn) {
  fn("red", std::to_string(color[0]));
  fn("green", std::to_string(color[1]));
  fn("blue", std::to_string(color[2]));
}

/// The statistics that come before the oriented box, in this order; all others come near the end.
constexpr std::array<std::string_view, 8> kFirstStatistics = {
    "id", "points", "area", "centroid", "mean_normal", "mean_color", "box_min", "box_max"};

template <class Fn>
void for_each_first_statistic(const SegmentStatistics& statistics, const Fn& fn) {
  for (const std::string_view name : kFirstStatistics) {
    SegmentStatistics::visit_fields(
        [&](const StatisticsField& field, const auto& value) {
          if (field.name == name) write_statistic(field.name, value, fn);
        },
        statistics);
  }
}

template <class Fn>
void for_each_other_statistic(const SegmentStatistics& statistics, const Fn& fn) {
  SegmentStatistics::visit_fields(
      [&](const StatisticsField& field, const auto& value) {
        if (std::ranges::count(kFirstStatistics, field.name) == 0) {
          write_statistic(field.name, value, fn);
        }
      },
      statistics);
}

/// Calls fn(name, text) for each column.
template <class Fn>
void for_each_field(const SegmentDescription& segment, const Fn& fn) {
  const PlaneFit& plane = segment.shape.plane;
  for_each_first_statistic(segment.statistics, fn);
  for_each_box_field(segment.shape.box, fn);
  fn("planar", segment.shape.is_planar ? "1" : "0");
  for_each_component("plane_normal", plane.normal_W, fn);
  fn("plane_offset", shortest_text(static_cast<float>(plane.offset_m)));
  fn("plane_rms", shortest_text(static_cast<float>(plane.rms_m)));
  fn("plane_inliers", shortest_text(static_cast<float>(plane.inlier_share)));
  fn("neighbours", ids_text(segment.neighbours));
  for_each_other_statistic(segment.statistics, fn);
  fn("changed_slice", std::to_string(segment.last_change.slice_id));
  fn("changed_utime", std::to_string(segment.last_change.utime));
}

}  // namespace

void write_segments_csv(std::span<const SegmentDescription> segments,
                        const std::filesystem::path& path) {
  AtomicFile file(path);
  std::ostream& out = file.stream();
  const char* separator = "";
  for_each_field({}, [&](const std::string& name, const std::string& /*text*/) {
    out << separator << name;
    separator = ",";
  });
  for (const SegmentDescription& segment : segments) {
    separator = "\n";
    for_each_field(segment, [&](const std::string& /*name*/, const std::string& text) {
      out << separator << text;
      separator = ",";
    });
  }
  out << '\n';
  file.commit();
}

}  // namespace kintsugi::segmenter
