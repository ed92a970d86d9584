#include "segmenter/io/segments_csv.hpp"

#include <ostream>
#include <string>

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

/// Calls fn(name, text) for each column.
template <class Fn>
void for_each_field(const SegmentDescription& segment, const Fn& fn) {
  const SegmentStatistics& s = segment.statistics;
  const PlaneFit& plane = segment.shape.plane;
  fn("id", std::to_string(s.segment_id));
  fn("points", std::to_string(s.num_points));
  fn("area", shortest_text(s.area_m2));
  for_each_component("centroid", s.centroid_W, fn);
  for_each_component("mean_normal", s.mean_normal_W, fn);
  fn("red", std::to_string(s.mean_color[0]));
  fn("green", std::to_string(s.mean_color[1]));
  fn("blue", std::to_string(s.mean_color[2]));
  for_each_component("box_min", s.box_min_W, fn);
  for_each_component("box_max", s.box_max_W, fn);
  for_each_box_field(segment.shape.box, fn);
  fn("planar", segment.shape.is_planar ? "1" : "0");
  for_each_component("plane_normal", plane.normal_W, fn);
  fn("plane_offset", shortest_text(static_cast<float>(plane.offset_m)));
  fn("plane_rms", shortest_text(static_cast<float>(plane.rms_m)));
  fn("plane_inliers", shortest_text(static_cast<float>(plane.inlier_share)));
  fn("neighbours", ids_text(segment.neighbours));
  fn("first_slice", std::to_string(s.first_slice));
  fn("last_slice", std::to_string(s.last_slice));
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
