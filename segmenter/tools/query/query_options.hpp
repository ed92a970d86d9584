#pragma once
// The command line of kintsugi-query, and the query that it describes.

#include <filesystem>
#include <string>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/tools/query/query_client.hpp"

namespace CLI {
class App;
}

namespace kintsugi::segmenter {

struct QueryOptions {
  std::filesystem::path map;  ///< a saved map; empty: ask over the bus
  std::string lcm_url;
  double timeout_s = 5.0;
  bool json = false;

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

/// The query of the options. With --pixel and without --pose, listens to the camera pose.
/// @param client null when there is no bus
/// @throws std::invalid_argument for a direction or rotation that is zero, and for --pixel when
///   there is neither --pose nor bus
/// @throws std::runtime_error as QueryClient::hear_camera()
SegmentQuery make_query(const QueryOptions& options, QueryClient* client);

}  // namespace kintsugi::segmenter
