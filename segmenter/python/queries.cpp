#include "segmenter/python/queries.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include <pybind11/stl.h>

#include "segmenter/python/bind.hpp"
#include "segmenter/python/points.hpp"

namespace kintsugi::python {
namespace {

template <class Value>
Value value_of(const py::handle& object, const char* name, const char* what) {
  try {
    return object.cast<Value>();
  } catch (const py::cast_error&) {
    throw py::type_error(std::string(name) + " must be " + what);
  }
}

void copy(const Eigen::Vector3d& from, double (&to)[3]) { std::copy_n(from.data(), 3, to); }

std::pair<Eigen::Vector3d, Eigen::Vector3d> two_vectors(const py::handle& object,
                                                        const char* name) {
  const auto pair = value_of<std::pair<py::object, py::object>>(object, name, "a pair of vectors");
  return {vector_argument(pair.first, name), vector_argument(pair.second, name)};
}

void set_ray(SegmentQuery& query, const py::handle& ray) {
  const auto [start_W, direction_W] = two_vectors(ray, "ray");
  if (!(direction_W.norm() > 0.0)) throw std::invalid_argument("ray has a direction of length 0");
  copy(start_W, query.point_W);
  copy(direction_W.normalized(), query.direction_W);
}

void set_box(SegmentQuery& query, const py::handle& box) {
  const auto [lowest_W, highest_W] = two_vectors(box, "box");
  copy(lowest_W, query.box_min_W);
  copy(highest_W, query.box_max_W);
}

/// False: `name` is no place.
bool set_place(SegmentQuery& query, const std::string& name, const py::handle& value) {
  if (name == "at") {
    query.place = QueryPlace::kPoint;
    copy(vector_argument(value, "at"), query.point_W);
  } else if (name == "ray") {
    query.place = QueryPlace::kRay;
    set_ray(query, value);
  } else if (name == "box") {
    query.place = QueryPlace::kBox;
    set_box(query, value);
  } else if (name == "ids") {
    query.place = QueryPlace::kIds;
    query.segment_ids =
        value_of<std::vector<std::uint32_t>>(value, "ids", "a sequence of segment ids");
  } else if (name == "pixel") {
    query.place = QueryPlace::kPixel;
    const auto pixel = value_of<std::pair<double, double>>(value, "pixel", "a pair (u, v)");
    query.pixel_px[0] = pixel.first;
    query.pixel_px[1] = pixel.second;
  } else {
    return false;
  }
  return true;
}

void set_filter(SegmentQuery& query, const std::string& name, const py::handle& value) {
  if (name == "radius") {
    query.radius_m = value_of<double>(value, "radius", "a number of metres");
  } else if (name == "planar") {
    query.only_planar = value_of<bool>(value, "planar", "True or False");
  } else if (name == "changed_since") {
    query.changed_since = value_of<std::int64_t>(value, "changed_since", "a time in microseconds");
  } else if (name == "largest") {
    query.max_segments = value_of<std::int32_t>(value, "largest", "a number of segments");
  } else {
    throw py::type_error("a query has no keyword '" + name +
                         "'; there are at, ray, box, ids, pixel, radius, planar, changed_since and "
                         "largest");
  }
}

py::object position(bool is_there, const float (&p)[3]) {
  if (!is_there) return py::none();
  return py::array(std::vector<py::ssize_t>{3}, std::data(p));
}

}  // namespace

SegmentQuery query_of(const py::kwargs& keywords) {
  SegmentQuery query;
  for (const auto& [key, value] : keywords) {
    if (value.is_none()) continue;
    const bool has_place = query.place != QueryPlace::kAnywhere;
    if (!set_place(query, py::str(key), value)) {
      set_filter(query, py::str(key), value);
    } else if (has_place) {
      throw std::invalid_argument("a query has at most one place: at, ray, box, ids or pixel");
    }
  }
  return query;
}

void add_answer(py::module_& module) {
  const auto segments = [](const py::object& self) {
    return view(std::span<const DescribedSegment>(self.cast<const SegmentAnswer&>().segments),
                self);
  };
  const auto contacts = [](const py::object& self) {
    return view(std::span<const SegmentContact>(self.cast<const SegmentAnswer&>().contacts), self);
  };
  py::class_<SegmentAnswer>(module, "Answer", "The answer to a query.")
      .def_property_readonly("segments", segments,
                             "Array of DESCRIBED_SEGMENT, the largest first; metres, W.")
      .def_property_readonly("contacts", contacts,
                             "Array of CONTACT: which segments each of them touches.")
      .def_property_readonly(
          "hit", [](const SegmentAnswer& answer) { return position(answer.has_hit, answer.hit_W); },
          "(3,) float32: the map point that at, ray or pixel found, metres, W; None: there is "
          "none.")
      .def_property_readonly(
          "surface_distance",
          [](const SegmentAnswer& answer) {
            return answer.surface_distance_m > 0.0F
                       ? py::object(py::float_(answer.surface_distance_m))
                       : py::object(py::none());
          },
          "pixel: metres from the camera to what it measures; None: it measures nothing there.")
      .def_readonly("view_utime", &SegmentAnswer::view_utime,
                    "pixel: device time of the camera's image, microseconds; 0: there was none.")
      .def_property_readonly("problem", text(&SegmentAnswer::problem),
                             "Why the query cannot be answered; empty: it is answered.")
      .def_property_readonly("map_name", text(&SegmentAnswer::map_name))
      .def_readonly("map_session", &SegmentAnswer::map_session, "Of the mapper; 0: no such map.")
      .def_readonly("map_points", &SegmentAnswer::map_points)
      .def_readonly("map_segments", &SegmentAnswer::map_segments)
      .def_readonly("num_matching", &SegmentAnswer::num_matching,
                    "Segments that match; `segments` has at most `largest` of them.");
}

}  // namespace kintsugi::python
