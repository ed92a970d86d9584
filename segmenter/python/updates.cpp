// kintsugi.Update, kintsugi.CameraPose, kintsugi.Object, kintsugi.Changes

#include <string>

#include <pybind11/stl.h>

#include "lcmtypes/client/object_text.hpp"
#include "lcmtypes/object_messages.hpp"
#include "segmenter/library/bus.hpp"
#include "segmenter/python/arrays.hpp"
#include "segmenter/python/bind.hpp"
#include "segmenter/python/points.hpp"

namespace kintsugi::python {
namespace {

/// A getter of a vector of records as a view that keeps the object alive.
template <class Object, class Record>
auto records(std::vector<Record> Object::*member) {
  return [member](const py::object& self) {
    return view(std::span<const Record>(self.cast<const Object&>().*member), self);
  };
}

void add_update(py::module_& module) {
  py::class_<SegmentUpdate>(module, "Update",
                            "What the segmenter published when a piece was added or replaced.")
      .def_readonly("utime", &SegmentUpdate::utime, "Device time of the piece, microseconds.")
      .def_readonly("session", &SegmentUpdate::session, "Of the segmenter.")
      .def_readonly("sequence", &SegmentUpdate::sequence, "Ascending in the session.")
      .def_readonly("map_session", &SegmentUpdate::map_session, "Of the mapper.")
      .def_property_readonly("map_name", text(&SegmentUpdate::map_name))
      .def_readonly("piece", &SegmentUpdate::slice_id, "Number of the piece (slice).")
      .def_readonly("revision", &SegmentUpdate::slice_revision, "Of the piece.")
      .def_readonly("is_final", &SegmentUpdate::is_final,
                    "The final piece and all earlier ones are segmented.")
      .def_readonly("num_pieces", &SegmentUpdate::num_slices, "In the map after this update.")
      .def_readonly("num_points", &SegmentUpdate::num_points, "In the map after this update.")
      .def_readonly("num_segments", &SegmentUpdate::num_segments, "In the map after this update.")
      .def_property_readonly(
          "lists_all",
          [](const SegmentUpdate& update) {
            return static_cast<std::int64_t>(update.statistics.size()) == update.num_segments;
          },
          "It has every segment of the map: one that it does not list no longer exists.")
      .def_property_readonly("labels", records(&SegmentUpdate::labels),
                             "(N,) uint32, read-only: the segment of each point of the piece.")
      .def_property_readonly("runs", records(&SegmentUpdate::runs),
                             "(R,) of dtype RUN: points of other pieces whose segment changed.")
      .def_property_readonly("events", records(&SegmentUpdate::events), "(E,) of dtype EVENT.")
      .def_property_readonly("segments", records(&SegmentUpdate::statistics),
                             "(C,) of dtype SEGMENT: the segments that changed; metres, W.");
}

}  // namespace

void add_updates(py::module_& module) {
  add_update(module);
  py::class_<CameraPose>(module, "CameraPose", "The pose of the depth camera at one frame.")
      .def_readonly("utime", &CameraPose::utime, "Device time of the frame, microseconds.")
      .def_readonly("session", &CameraPose::session, "Of the mapper.")
      .def_readonly("frame_index", &CameraPose::frame_index)
      .def_readonly("part", &CameraPose::part, "Part of the map in which the camera is.")
      .def_property_readonly(
          "state", [](const CameraPose& pose) { return std::string(to_string(pose.state)); },
          "'starting', 'tracking', 'lost' or 'given'.")
      .def_property_readonly(
          "X_WC", [](const CameraPose& pose) { return pose_array(pose.X_WC); },
          "(4, 4) float64: p_W = X_WC p_C; C: x right, y down, z forward; metres.");
  py::class_<ObjectDetection>(module, "Object", "A known object that was found in the map.")
      .def_property_readonly("name", text(&ObjectDetection::name), "In the library.")
      .def_readonly("detection", &ObjectDetection::detection, "Its number; from 1.")
      .def_readonly("utime", &ObjectDetection::utime,
                    "Device time of the newest piece looked at, microseconds.")
      .def_property_readonly(
          "event",
          [](const ObjectDetection& object) { return std::string(to_string(object.event)); },
          "'found', 'confirmed' or 'moved'.")
      .def_property_readonly(
          "X_WO", [](const ObjectDetection& object) { return pose_array(object.X_WO); },
          "(4, 4) float64: p_W = X_WO p_O; O: the frame of the object, z up; metres.")
      .def_readonly("score", &ObjectDetection::score, "0 to 1.")
      .def_readonly("points", &ObjectDetection::points, "Of the map that are its surface.")
      .def_property_readonly(
          "segments", [](const ObjectDetection& object) { return array_of(object.segment_ids); },
          "(N,) uint32: the segments it consists of, ascending.")
      .def_property_readonly(
          "box_O",
          [](const ObjectDetection& object) {
            py::array_t<float> box({2, 3});
            auto values = box.mutable_unchecked<2>();
            for (int axis = 0; axis < 3; ++axis) {
              values(0, axis) = object.box_min_O[axis];
              values(1, axis) = object.box_max_O[axis];
            }
            return box;
          },
          "(2, 3) float32: smallest and largest coordinates of the model; metres, O.")
      .def("__repr__", [](const ObjectDetection& object) {
        return text_of("<kintsugi.Object: " + object.name + " (" +
                       std::to_string(object.detection) + ")>");
      });
  py::class_<MapChanges>(module, "Changes", "What one wait() has received.")
      .def_readonly("updates", &MapChanges::updates, "List of Update.")
      .def_readonly("pieces", &MapChanges::pieces,
                    "Numbers of the pieces that came, changed, moved or have other labels.")
      .def_readonly("poses", &MapChanges::poses, "List of CameraPose.")
      .def("__bool__", [](const MapChanges& changes) { return !changes.is_empty(); })
      .def("__repr__", [](const MapChanges& changes) {
        return "<kintsugi.Changes: " + std::to_string(changes.updates.size()) + " updates, " +
               std::to_string(changes.pieces.size()) + " pieces, " +
               std::to_string(changes.poses.size()) + " poses>";
      });
}

}  // namespace kintsugi::python
