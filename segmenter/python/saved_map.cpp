// kintsugi.SavedMap

#include <filesystem>
#include <memory>
#include <string>

#include <pybind11/stl/filesystem.h>

#include "segmenter/library/segmentation.hpp"
#include "segmenter/python/arrays.hpp"
#include "segmenter/python/bind.hpp"
#include "segmenter/python/queries.hpp"

namespace kintsugi::python {

// It does not change, so that threads share it without a lock.
void add_saved_map(py::module_& module) {
  const auto points = [](const py::object& self) {
    return view(self.cast<const SavedMap&>().points_W(), self);
  };
  const auto labels = [](const py::object& self) {
    return view(self.cast<const SavedMap&>().labels(), self);
  };
  const auto segments = [](const py::object& self) {
    return view(std::span<const SegmentStatistics>(self.cast<const SavedMap&>().segments()), self);
  };
  py::class_<SavedMap>(module, "SavedMap", "A saved map; load_map() reads one. It does not change.")
      .def_property_readonly("name", [](const SavedMap& map) { return text_of(map.name()); })
      .def_property_readonly("resolution", &SavedMap::resolution_m, "Metres.")
      .def_property_readonly("is_complete", &SavedMap::is_complete,
                             "The final slice and all others are in it.")
      .def_property_readonly("points", points,
                             "(N,) of dtype POINT, read-only: all points; metres, W.")
      .def_property_readonly("labels", labels, "(N,) uint32, read-only: the segment of each point.")
      .def("segments", segments,
           "(S,) of dtype SEGMENT, read-only: every segment, by ascending id; metres, W.")
      .def(
          "query",
          [](const SavedMap& map, const py::kwargs& keywords) {
            const SegmentQuery query = query_of(keywords);
            const py::gil_scoped_release released;
            return map.ask(query);
          },
          (std::string("Find and describe segments.") + kQueryHelp).c_str())
      .def("__repr__", [](const SavedMap& map) {
        return text_of("<kintsugi.SavedMap '" + map.name() +
                       "': " + std::to_string(map.points_W().size()) + " points, " +
                       std::to_string(map.segments().size()) + " segments>");
      });
  module.def(
      "load_map",
      [](const std::filesystem::path& file) {
        const py::gil_scoped_release released;
        return std::make_unique<SavedMap>(file);
      },
      py::arg("file"),
      "Read a saved map: what Segmenter.save() or kintsugi-segmenter --save has written.\n\n"
      "Returns a SavedMap. Raises RuntimeError naming the file, the place and the reason.");
}

}  // namespace kintsugi::python
