#include "segmenter/python/arrays.hpp"

#include <cstdint>
#include <string>
#include <type_traits>

namespace kintsugi::python {
namespace {

/// Collects the fields of a record, with their places in it.
class Layout {
 public:
  explicit Layout(const void* record) : record_(static_cast<const char*>(record)) {}

  template <class Value>
  void add(const char* name, const Value& first, int length = 0) {
    const py::dtype number = py::dtype::of<Value>();
    append(name,
           length == 0 ? py::object(number)
                       : py::object(py::make_tuple(number, py::make_tuple(length))),
           &first);
  }
  template <class Value>
  void add_field(const char* name, const Value& value) {
    add(name, value);
  }
  template <class Value, std::size_t kSize>
  void add_field(const char* name, const Value (&values)[kSize]) {
    add(name, values[0], static_cast<int>(kSize));
  }
  template <class Value, std::size_t kRows, std::size_t kColumns>
  void add_field(const char* name, const Value (&values)[kRows][kColumns]) {
    append(name, py::make_tuple(py::dtype::of<Value>(), py::make_tuple(kRows, kColumns)),
           &values[0][0]);
  }
  void add_statistics(const SegmentStatistics& statistics) {
    SegmentStatistics::visit_fields(
        [this](const StatisticsField& field, const auto& value) { add_field(field.name, value); },
        statistics);
  }

  void append(const char* name, const py::object& format, const void* place) {
    names_.append(name);
    formats_.append(format);
    offsets_.append(static_cast<const char*>(place) - record_);
  }

  py::dtype dtype(std::size_t size) const {
    py::dict all;
    all["names"] = names_;
    all["formats"] = formats_;
    all["offsets"] = offsets_;
    all["itemsize"] = size;
    return py::dtype::from_args(all);
  }

 private:
  const char* record_;
  py::list names_;
  py::list formats_;
  py::list offsets_;
};

}  // namespace

template <>
py::dtype dtype_of<CloudPoint>() {
  const CloudPoint point;
  Layout layout(&point);
  layout.add("position", point.x, 3);
  layout.add("normal", point.nx, 3);
  layout.add("color", point.red, 3);
  layout.add("weight", point.weight);
  return layout.dtype(sizeof(point));
}

template <>
py::dtype dtype_of<SegmentStatistics>() {
  const SegmentStatistics statistics;
  Layout layout(&statistics);
  layout.add_statistics(statistics);
  return layout.dtype(sizeof(statistics));
}

template <>
py::dtype dtype_of<SegmentEvent>() {
  const SegmentEvent event;
  static_assert(std::is_same_v<std::underlying_type_t<SegmentEventType>, std::uint32_t>);
  Layout layout(&event);
  layout.append("type", py::dtype::of<std::uint32_t>(), &event.type);
  layout.add("id", event.segment_id);
  layout.add("other_id", event.other_id);
  return layout.dtype(sizeof(event));
}

template <>
py::dtype dtype_of<LabelRun>() {
  const LabelRun run;
  Layout layout(&run);
  layout.add("piece", run.slice_id);
  layout.add("first", run.first);
  layout.add("count", run.count);
  layout.add("id", run.segment_id);
  layout.add("revision", run.slice_revision);
  return layout.dtype(sizeof(run));
}

template <>
py::dtype dtype_of<DescribedSegment>() {
  const DescribedSegment segment;
  Layout layout(&segment);
  layout.add_statistics(segment.statistics);
  layout.add("planar", segment.is_planar);
  layout.add("last_change_us", segment.last_change_utime);
  layout.add_field("oriented_box_center", segment.oriented_box_center_W);
  layout.add_field("oriented_box_axes", segment.oriented_box_axes_W);
  layout.add_field("oriented_box_size", segment.oriented_box_size_m);
  layout.add_field("plane_normal", segment.plane_normal_W);
  layout.add("plane_offset", segment.plane_offset_m);
  layout.add("plane_rms", segment.plane_rms_m);
  layout.add("plane_share", segment.plane_share);
  layout.add("distance", segment.distance_m);
  return layout.dtype(sizeof(segment));
}

template <>
py::dtype dtype_of<SegmentContact>() {
  const SegmentContact contact;
  Layout layout(&contact);
  layout.add("id", contact.segment_id);
  layout.add("neighbour_id", contact.neighbour_id);
  layout.add("pairs", contact.num_pairs);
  return layout.dtype(sizeof(contact));
}

void add_dtypes(py::module_& module) {
  module.attr("POINT") = dtype_of<CloudPoint>();
  module.attr("SEGMENT") = dtype_of<SegmentStatistics>();
  module.attr("EVENT") = dtype_of<SegmentEvent>();
  module.attr("RUN") = dtype_of<LabelRun>();
  module.attr("DESCRIBED_SEGMENT") = dtype_of<DescribedSegment>();
  module.attr("CONTACT") = dtype_of<SegmentContact>();
}

}  // namespace kintsugi::python
