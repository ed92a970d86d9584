#pragma once
// Queries and their answers, as Python has them.

#include "lcmtypes/messages.hpp"
#include "segmenter/python/arrays.hpp"

namespace kintsugi::python {

/// The query that the keywords `at`, `ray`, `box`, `ids`, `pixel`, `radius`, `planar`,
/// `changed_since` and `largest` ask for.
/// @throws py::type_error for another keyword or a wrong type, std::invalid_argument for a wrong
/// shape
///   or several places
SegmentQuery query_of(const py::kwargs& keywords);

/// The class Answer.
void add_answer(py::module_& module);

/// What the documentation of each query() says of its keywords.
inline constexpr char kQueryHelp[] = R"(

Give at most one place:
    at       (x, y, z): the segment of the map point nearest to it; metres, W
    ray      ((x, y, z), (dx, dy, dz)): the segment that is hit first, from a point along a direction
    box      ((x, y, z), (x, y, z)): the segments with a point in it, from its lowest to its highest corner
    ids      the segments with these ids; ids that do not exist are ignored
    pixel    (u, v): of what the camera measures there now; of a live map only
Restrict the answer with:
    radius   at, ray, pixel: largest distance of the map point, metres; 0: two voxels
    planar   True: only segments that are planar
    changed_since   device time, microseconds: only segments that changed after it
    largest  only so many, the largest; 0: all

Returns an Answer, the largest segments first. Raises ValueError for what is out of its bounds, and
TypeError for a keyword that there is not.)";

}  // namespace kintsugi::python
