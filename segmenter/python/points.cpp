#include "segmenter/python/points.hpp"

#include <stdexcept>
#include <string>
#include <type_traits>

namespace kintsugi::python {
namespace {

std::string shape_text(const py::array& array) { return py::str(py::tuple(array.attr("shape"))); }
std::string dtype_text(const py::array& array) { return py::str(array.dtype()); }

/// As an `Array`; its constructor, unlike ensure(), throws what numpy raises.
template <class Array>
Array converted(const py::handle& object) {
  return Array(py::reinterpret_borrow<py::object>(object));
}

/// An array where numpy can make one; `what` says what was wanted.
/// @throws py::type_error, and what else is raised meanwhile: there is no memory, or Ctrl-C
template <class Array>
Array any_array(const py::handle& object, const std::string& what) {
  try {
    return converted<Array>(object);
  } catch (const py::error_already_set& error) {
    if (!error.matches(PyExc_TypeError) && !error.matches(PyExc_ValueError)) throw;
    throw py::type_error(what);
  }
}

void require_shape(const py::array& array, const std::string& name, py::ssize_t rows,
                   py::ssize_t columns) {
  const bool fits =
      array.ndim() == 2 && array.shape(1) == columns && (rows < 0 || array.shape(0) == rows);
  if (fits) return;
  const std::string wanted =
      (rows < 0 ? "N" : std::to_string(rows)) + ", " + std::to_string(columns);
  throw std::invalid_argument(name + " must have the shape (" + wanted + "), not " +
                              shape_text(array));
}

/// Floats of any size, or for doubles also integers, as `Number`, row after row.
template <class Number>
py::array_t<Number, py::array::c_style> floats(const py::handle& object, const std::string& name,
                                               py::ssize_t rows, py::ssize_t columns) {
  const auto array = any_array<py::array>(object, name + " must be a numpy array");
  const char kind = array.dtype().kind();
  const bool is_whole = kind == 'i' || kind == 'u';
  if (kind != 'f' && !(is_whole && std::is_same_v<Number, double>)) {
    throw py::type_error(name + " must be of floats (float32 or float64), not " +
                         dtype_text(array));
  }
  require_shape(array, name, rows, columns);
  return converted<py::array_t<Number, py::array::c_style | py::array::forcecast>>(array);
}

/// True for records with the fields of POINT; numpy leaves out the gaps between them where it makes
/// an array from several.
bool is_points(const py::array& array) {
  return array.dtype().kind() == 'V' &&
         array.dtype().attr("names").equal(dtype_of<CloudPoint>().attr("names"));
}

/// Byte order and gaps may differ.
void require_fields(const py::array& array) {
  const auto format = [](const py::dtype& record, const py::handle& name) {
    return record[name].attr("newbyteorder")("=");
  };
  const py::dtype wanted = dtype_of<CloudPoint>();
  for (const py::handle name : wanted.attr("names")) {
    const py::object given_format = format(array.dtype(), name);
    const py::object wanted_format = format(wanted, name);
    if (given_format.equal(wanted_format)) continue;
    throw py::type_error("field '" + std::string(py::str(name)) + "' of points must be of dtype " +
                         std::string(py::str(wanted_format)) + ", not " +
                         std::string(py::str(given_format)));
  }
}

std::vector<CloudPoint> records(const py::array& array) {
  require_fields(array);
  if (array.ndim() != 1) {
    throw std::invalid_argument("points of dtype POINT must have the shape (N,), not " +
                                shape_text(array));
  }
  const py::array packed =
      array.attr("astype")(dtype_of<CloudPoint>(), "C", py::arg("copy") = false);
  const auto* const first = static_cast<const CloudPoint*>(packed.data());
  std::vector<CloudPoint> points(first, first + packed.size());
  for (CloudPoint& point : points) point.reserved = 0;  // a gap, in which anything may be
  return points;
}

void set_colors(const py::handle& colors, std::vector<CloudPoint>& points) {
  const auto array = any_array<py::array>(colors, "colors must be a numpy array");
  if (!array.dtype().equal(py::dtype::of<std::uint8_t>())) {
    throw py::type_error("colors must be of dtype uint8, from 0 to 255, not " + dtype_text(array));
  }
  require_shape(array, "colors", static_cast<py::ssize_t>(points.size()), 3);
  const auto packed = converted<py::array_t<std::uint8_t, py::array::c_style>>(array);
  const auto rgb = packed.unchecked<2>();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto row = static_cast<py::ssize_t>(i);
    points[i].red = rgb(row, 0);
    points[i].green = rgb(row, 1);
    points[i].blue = rgb(row, 2);
  }
}

}  // namespace

PointsArgument points_argument(const py::handle& points, const py::handle& normals,
                               const py::handle& colors) {
  const auto given = any_array<py::array>(points, "points must be a numpy array");
  if (is_points(given)) {
    if (!normals.is_none() || !colors.is_none()) {
      throw std::invalid_argument("points of dtype POINT have normals and colours already");
    }
    return {records(given), true};
  }
  const auto positions = floats<float>(points, "points", -1, 3);
  const auto xyz = positions.unchecked<2>();
  PointsArgument argument;
  argument.points.resize(static_cast<std::size_t>(xyz.shape(0)));
  for (std::size_t i = 0; i < argument.points.size(); ++i) {
    const auto row = static_cast<py::ssize_t>(i);
    CloudPoint& point = argument.points[i];
    point.x = xyz(row, 0);
    point.y = xyz(row, 1);
    point.z = xyz(row, 2);
  }
  if (!normals.is_none()) {
    const auto array = floats<float>(normals, "normals", xyz.shape(0), 3);
    const auto n = array.unchecked<2>();
    for (std::size_t i = 0; i < argument.points.size(); ++i) {
      const auto row = static_cast<py::ssize_t>(i);
      argument.points[i].nx = n(row, 0);
      argument.points[i].ny = n(row, 1);
      argument.points[i].nz = n(row, 2);
    }
    argument.has_normals = true;
  }
  if (!colors.is_none()) set_colors(colors, argument.points);
  return argument;
}

Pose pose_argument(const py::handle& matrix, const char* name) {
  const auto array = floats<double>(matrix, name, 4, 4);
  const auto m = array.unchecked<2>();
  if (m(3, 0) != 0.0 || m(3, 1) != 0.0 || m(3, 2) != 0.0 || m(3, 3) != 1.0) {
    throw std::invalid_argument(std::string("the last row of ") + name + " must be 0 0 0 1");
  }
  Pose pose = Pose::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) pose.matrix()(row, column) = m(row, column);
  }
  return pose;
}

py::array pose_array(const Pose& pose) {
  py::array_t<double> array({4, 4});
  auto m = array.mutable_unchecked<2>();
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) m(row, column) = pose.matrix()(row, column);
  }
  return array;
}

Eigen::Vector3d vector_argument(const py::handle& numbers, const char* name) {
  const auto array = any_array<py::array_t<double, py::array::c_style | py::array::forcecast>>(
      numbers, std::string(name) + " must be three numbers");
  if (array.ndim() != 1 || array.shape(0) != 3) {
    throw std::invalid_argument(
        std::string(name) + " must be three numbers, not an array of shape " + shape_text(array));
  }
  const Eigen::Vector3d vector(array.at(0), array.at(1), array.at(2));
  if (!vector.allFinite()) {
    throw std::invalid_argument(std::string(name) + " must be finite");
  }
  return vector;
}

}  // namespace kintsugi::python
