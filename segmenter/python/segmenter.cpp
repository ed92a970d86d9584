// kintsugi.Segmenter, kintsugi.estimate_normals

#include <optional>
#include <string>
#include <vector>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "segmenter/library/segmentation.hpp"
#include "segmenter/python/arrays.hpp"
#include "segmenter/python/bind.hpp"
#include "segmenter/python/points.hpp"
#include "segmenter/python/queries.hpp"

namespace kintsugi::python {
namespace {

/// A Segmenter, and the resolution for normals that are not given.
struct SegmenterOfPython {
  SegmenterOfPython(Segmenter made, double resolution_in_m)
      : shared(std::move(made)), resolution_m(resolution_in_m) {}

  Shared<Segmenter> shared;
  const double resolution_m;
};
using Self = SegmenterOfPython;

std::optional<Eigen::Vector3d> viewpoint_argument(const py::object& viewpoint) {
  if (viewpoint.is_none()) return std::nullopt;
  return vector_argument(viewpoint, "viewpoint");
}

/// To be called without the interpreter's lock: takes long where there are no normals.
void complete_normals(PointsArgument& argument, double resolution_m,
                      const std::optional<Eigen::Vector3d>& viewpoint_W) {
  if (argument.has_normals) {
    normalize_normals(argument.points);
  } else {
    estimate_normals(argument.points, resolution_m, viewpoint_W);
  }
}

PieceId add(Self& self, const py::object& points, const py::object& normals,
            const py::object& colors, const py::object& viewpoint) {
  PointsArgument argument = points_argument(points, normals, colors);
  const auto viewpoint_W = viewpoint_argument(viewpoint);
  return self.shared.with([&](Segmenter& segmenter) {
    complete_normals(argument, self.resolution_m, viewpoint_W);
    return segmenter.add(argument.points);
  });
}

void replace(Self& self, PieceId piece, const py::object& points, const py::object& normals,
             const py::object& colors, const py::object& viewpoint) {
  PointsArgument argument = points_argument(points, normals, colors);
  const auto viewpoint_P = viewpoint_argument(viewpoint);
  self.shared.with([&](Segmenter& segmenter) {
    complete_normals(argument, self.resolution_m, viewpoint_P);
    segmenter.replace(piece, argument.points);
  });
}

PieceId piece_argument(const py::handle& piece) {
  try {
    return piece.cast<PieceId>();
  } catch (const py::cast_error&) {
    throw py::type_error("a piece is named by its number, an int");
  }
}

void move(Self& self, const py::object& piece, const py::object& X_WP) {
  std::vector<PieceMove> moves;
  if (py::isinstance<py::dict>(piece)) {
    if (!X_WP.is_none()) throw py::type_error("move takes a dict, or a piece and its pose X_WP");
    for (const auto& [key, pose] : piece.cast<py::dict>()) {
      moves.push_back({piece_argument(key), pose_argument(pose, "X_WP")});
    }
  } else {
    moves.push_back({piece_argument(piece), pose_argument(X_WP, "X_WP")});
  }
  self.shared.with([&](Segmenter& segmenter) { segmenter.move(moves); });
}

py::array labels(Self& self, const std::optional<PieceId>& piece) {
  return array_of(self.shared.with([&](Segmenter& segmenter) {
    if (piece) return segmenter.labels(*piece);
    std::vector<std::uint32_t> all;
    for (const PieceId one : segmenter.pieces()) {
      const auto labels = segmenter.labels(one);
      all.insert(all.end(), labels.begin(), labels.end());
    }
    return all;
  }));
}

py::array estimated_normals(const py::object& points, double resolution,
                            const py::object& viewpoint) {
  PointsArgument argument = points_argument(points, py::none(), py::none());
  const auto viewpoint_W = viewpoint_argument(viewpoint);
  {
    const py::gil_scoped_release released;
    estimate_normals(argument.points, resolution, viewpoint_W);
  }
  const py::array records = array_of(std::move(argument.points));
  return records.attr("__getitem__")("normal");
}

/// A getter without arguments that may have to wait for another thread.
template <class Function>
auto getter(Function function) {
  return [function](Self& self) { return self.shared.with(function); };
}
template <class Function>
auto array_getter(Function function) {
  return [function](Self& self) { return array_of(self.shared.with(function)); };
}

constexpr char kAddHelp[] =
    R"(Add a piece of the map and return its number (int).

points      (N, 3) float32 or float64: positions, metres, W; or (N,) of dtype POINT, which has normals
            and colours, too
normals     (N, 3) floats: towards free space; of any length > 0. None: they are estimated
colors      (N, 3) uint8: red, green, blue. None: without colour, only normals count
viewpoint   (x, y, z): where the sensor was, metres, W; estimated normals point towards it. None: the
            mean of all points, which suits a room seen from inside

A point that cannot be segmented (not finite, without a normal) has the label 0.
Raises TypeError for a wrong dtype, ValueError for a wrong shape.)";

constexpr char kMoveHelp[] =
    R"(Move a piece, or several in one run: move(piece, X_WP), move({piece: X_WP, ...}).

X_WP        (4, 4) floats: pose of the piece, p_W = X_WP p_P, where p_P are the points as given to add().
            It is absolute: two moves of a piece do not add up.

Raises ValueError for a matrix that is not a rotation and a translation, or a piece that there is not.)";

constexpr char kClassHelp[] =
    R"(The segment map of a cloud that is given in pieces.

After each change the segments equal those of a batch segmentation of the whole cloud, at the cost of
what the change touches; segments keep their ids as far as possible. Ids of segments begin at 1; a
point with the label 0 is in no segment.

resolution  spacing of the points (voxel size of the map), metres
preset      "objects": monitors, books and cups come out whole; "paper": Finman et al. 2014
mode        "exact", "voting" or "batch"
parameters  dict of values that replace those of the preset: threshold, scale, color_weight,
            min_points, beta, radius_factor

Long calls release the interpreter's lock; threads may share an object.
Raises ValueError naming the argument, its value and its bound.)";

void add_changes(py::class_<Self>& type) {
  type.def("add", &add, py::arg("points"), py::arg("normals") = py::none(),
           py::arg("colors") = py::none(), py::arg("viewpoint") = py::none(), kAddHelp);
  type.def(
      "replace", &replace, py::arg("piece"), py::arg("points"), py::arg("normals") = py::none(),
      py::arg("colors") = py::none(), py::arg("viewpoint") = py::none(),
      "Replace the points of a piece, which stays where move() has put it. Arguments as add(), in\n"
      "the frame P of the piece. Segments keep their ids where the surface stays.");
  type.def("move", &move, py::arg("piece"), py::arg("X_WP") = py::none(), kMoveHelp);
  type.def(
      "remove",
      [](Self& self, PieceId piece) {
        self.shared.with([&](Segmenter& segmenter) { segmenter.remove(piece); });
      },
      py::arg("piece"), "Remove a piece and its points.");
}

void add_results(py::class_<Self>& type) {
  type.def("labels", &labels, py::arg("piece") = py::none(),
           "(N,) uint32: the segment of each point of a piece, in the order of add(); 0: none.\n"
           "Without a piece: of all pieces, one after the other, in the order of `pieces`.");
  type.def(
      "points",
      [](Self& self, PieceId piece) {
        return array_of(
            self.shared.with([&](Segmenter& segmenter) { return segmenter.points_W(piece); }));
      },
      py::arg("piece"),
      "(M,) of dtype POINT: the points of a piece where it is now, metres, W, without those whose\n"
      "label is 0.");
  type.def("segments", array_getter([](Segmenter& segmenter) { return segmenter.segments(); }),
           "(S,) of dtype SEGMENT: every segment, by ascending id; metres, W.");
  type.def(
      "query",
      [](Self& self, const py::kwargs& keywords) {
        const SegmentQuery query = query_of(keywords);
        return self.shared.with([&](Segmenter& segmenter) { return segmenter.ask(query); });
      },
      (std::string("Find and describe segments.") + kQueryHelp).c_str());
  type.def(
      "save",
      [](Self& self, const std::filesystem::path& file) {
        self.shared.with([&](Segmenter& segmenter) { segmenter.save(file); });
      },
      py::arg("file"),
      "Write the map into a file that load_map(), kintsugi-export and kintsugi-query read.\n"
      "Raises RuntimeError naming the file and the reason.");
}

void add_state(py::class_<Self>& type) {
  type.def_property_readonly("pieces",
                             getter([](Segmenter& segmenter) { return segmenter.pieces(); }),
                             "Numbers of the pieces, ascending.");
  type.def_property_readonly("num_points",
                             getter([](Segmenter& segmenter) { return segmenter.num_points(); }),
                             "Points in the map, without those whose label is 0.");
  type.def_property_readonly("num_segments",
                             getter([](Segmenter& segmenter) { return segmenter.num_segments(); }));
  type.def_property_readonly("events",
                             array_getter([](Segmenter& segmenter) { return segmenter.events(); }),
                             "(E,) of dtype EVENT: which segments the last change created, let "
                             "grow, merged, split, retired.");
  type.def_property_readonly(
      "changed_segments",
      array_getter([](Segmenter& segmenter) { return segmenter.changed_segments(); }),
      "(C,) of dtype SEGMENT: the segments that the last change changed and that still exist.");
  type.def_property_readonly("relabelled_pieces", getter([](Segmenter& segmenter) {
                               return segmenter.relabelled_pieces();
                             }),
                             "Numbers of the pieces whose labels the last change changed.");
  type.def_readonly("resolution", &Self::resolution_m, "Metres.");
}

}  // namespace

void add_segmenter(py::module_& module) {
  py::class_<Self> type(module, "Segmenter", kClassHelp);
  type.def(py::init([](double resolution, const std::string& preset, const std::string& mode,
                       const std::optional<std::map<std::string, double>>& parameters) {
             SegmenterOptions options{resolution, preset, mode,
                                      parameters.value_or(std::map<std::string, double>())};
             return std::make_unique<Self>(Segmenter(options), resolution);
           }),
           py::arg("resolution") = 0.01, py::arg("preset") = "objects", py::arg("mode") = "exact",
           py::arg("parameters") = py::none());
  add_changes(type);
  add_results(type);
  add_state(type);
  type.def("__repr__", [](Self& self) {
    return self.shared.with([](Segmenter& segmenter) {
      return "<kintsugi.Segmenter: " + std::to_string(segmenter.pieces().size()) + " pieces, " +
             std::to_string(segmenter.num_points()) + " points, " +
             std::to_string(segmenter.num_segments()) + " segments>";
    });
  });

  module.def(
      "estimate_normals", &estimated_normals, py::arg("points"), py::arg("resolution"),
      py::arg("viewpoint") = py::none(),
      "(N, 3) float32: unit normals of points (N, 3), metres, as Segmenter.add() estimates them;\n"
      "zero where the neighbours lie on a line. resolution: spacing of the points, metres.");
}

}  // namespace kintsugi::python
