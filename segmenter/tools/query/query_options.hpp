#pragma once
// The command line of kintsugi-query, and the query that it describes.

#include <filesystem>
#include <string>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace CLI {
class App;
}

namespace kintsugi::segmenter {

struct QueryOptions {
  std::filesystem::path map;  ///< a saved map; empty: ask over the bus
  std::string lcm_url;
  double timeout_s = 5.0;
  bool json = false;

  std::string object;    ///< asks for the known objects of this name
  bool objects = false;  ///< asks for all known objects

  // Of the following, the flags that were not given are empty:
  std::vector<double> point_W;
  std::vector<double> ray;
  std::vector<double> pixel;
  std::vector<double> box_W;
  std::vector<double> pose;
  std::vector<double> intrinsics;
  SegmentQuery query;  ///< all that is not in the fields above
};

void add_options(CLI::App& app, QueryOptions& options);

/// The options ask a detector for objects, and not a segmenter for segments.
inline bool asks_for_objects(const QueryOptions& options) {
  return options.objects || !options.object.empty();
}

/// The query of the options. --pixel asks for what the camera measures there now, and with --pose
/// for what a camera there would see of the map: that is a ray.
/// @throws std::invalid_argument for a direction or rotation that is zero, intrinsics out of range,
///   and for --pixel of a saved map without --pose
SegmentQuery make_query(const QueryOptions& options);

}  // namespace kintsugi::segmenter
