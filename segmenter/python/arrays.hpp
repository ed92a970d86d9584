#pragma once
// numpy arrays of our records, without copies.

#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "lcmtypes/messages.hpp"

namespace kintsugi::python {

namespace py = pybind11;

/// The dtype of a record: its fields, and the gaps between them. They exist once per process.
template <class Record>
py::dtype dtype_of();
template <>
py::dtype dtype_of<CloudPoint>();
template <>
py::dtype dtype_of<SegmentStatistics>();
template <>
py::dtype dtype_of<SegmentEvent>();
template <>
py::dtype dtype_of<LabelRun>();
template <>
py::dtype dtype_of<DescribedSegment>();
template <>
py::dtype dtype_of<SegmentContact>();
template <>
inline py::dtype dtype_of<std::uint32_t>() {
  return py::dtype::of<std::uint32_t>();
}
template <>
inline py::dtype dtype_of<std::int32_t>() {
  return py::dtype::of<std::int32_t>();
}

/// A view that cannot be written, and keeps `owner` alive.
template <class Record>
py::array view(std::span<const Record> records, py::handle owner) {
  py::array array(dtype_of<Record>(), {records.size()}, {sizeof(Record)}, records.data(), owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

/// An array that owns `records`.
template <class Record>
py::array array_of(std::vector<Record> records) {
  auto owned = std::make_unique<std::vector<Record>>(std::move(records));
  const std::vector<Record>& kept = *owned;
  const py::capsule owner(owned.get(),
                          [](void* vector) { delete static_cast<std::vector<Record>*>(vector); });
  (void)owned.release();  // the capsule deletes it
  return py::array(dtype_of<Record>(), {kept.size()}, {sizeof(Record)}, kept.data(), owner);
}

/// A view into a vector that never changes, and lives as long as the array.
template <class Record>
py::array array_of(std::shared_ptr<const std::vector<Record>> records) {
  using Shared = std::shared_ptr<const std::vector<Record>>;
  auto kept = std::make_unique<Shared>(std::move(records));
  const std::span<const Record> span(**kept);
  const py::capsule owner(kept.get(), [](void* shared) { delete static_cast<Shared*>(shared); });
  (void)kept.release();  // the capsule deletes it
  return view(span, owner);
}

/// The dtypes as POINT, SEGMENT, EVENT, RUN, DESCRIBED_SEGMENT and CONTACT of the module.
void add_dtypes(py::module_& module);

}  // namespace kintsugi::python
