// kintsugi-query: asks a segmenter on the bus, or a saved map, about segments, and a detector about
// known objects.

#include <array>
#include <iostream>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "lcmtypes/base/command_line.hpp"
#include "lcmtypes/base/run_main.hpp"
#include "lcmtypes/codec/codec.hpp"
#include "segmenter/io/saved_map.hpp"
#include "segmenter/map/map_snapshot.hpp"
#include "segmenter/query/answer.hpp"
#include "segmenter/query/choose_map.hpp"
#include "segmenter/tools/query/object_query.hpp"
#include "segmenter/tools/query/object_report.hpp"
#include "segmenter/tools/query/query_client.hpp"
#include "segmenter/tools/query/query_options.hpp"
#include "segmenter/tools/query/query_report.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr int kFirstPixelCode = 3;  // exit codes from here on: why a pixel has no segment
constexpr int kNoObjectCode = 6;

SegmentAnswer ask_file(const QueryOptions& options, SegmentQuery query) {
  query.client = 1;
  (void)encode(query);  // checks every field as the bus does
  const MapSnapshot map = take_snapshot(*load_map(options.map));
  choose_map(std::array{MapIdentity{map.state.map_session, map.state.map_name}}, query);
  return answer(map, query);
}

SegmentAnswer ask_bus(const QueryOptions& options, const SegmentQuery& query) {
  return QueryClient(options.lcm_url).ask(query, QueryClient::Seconds(options.timeout_s));
}

int exit_code(const SegmentAnswer& answer, QueryPlace place) {
  if (place != QueryPlace::kPixel) return 0;
  switch (pixel_result(answer)) {
    case PixelResult::kNoView:
      return kFirstPixelCode;
    case PixelResult::kNotMeasured:
      return kFirstPixelCode + 1;
    case PixelResult::kNotSegmented:
      return kFirstPixelCode + 2;
    case PixelResult::kFound:
      break;
  }
  return 0;
}

int run_for_objects(const QueryOptions& options) {
  if (!options.map.empty()) {
    throw std::invalid_argument(
        "--object asks the detector on the bus; kintsugi-objects detect finds objects in a saved "
        "map");
  }
  FoundObjects found = ask_detector(options.lcm_url, options.query.map_name,
                                    QueryClient::Seconds(options.timeout_s));
  if (!found.dropped.empty()) std::cerr << "kintsugi-query: " << found.dropped << '\n';
  keep_named(options.object, found);
  std::cout << (options.json ? objects_json(found) : objects_table(found)) << std::flush;
  if (!std::cout) return 1;
  return any_present(found) ? 0 : kNoObjectCode;
}

int run(const QueryOptions& options) {
  if (asks_for_objects(options)) return run_for_objects(options);
  const SegmentQuery query = make_query(options);
  const SegmentAnswer answer =
      options.map.empty() ? ask_bus(options, query) : ask_file(options, query);
  if (!answer.problem.empty()) throw std::runtime_error(answer.problem);
  std::cout << (options.json ? answer_json(answer, query.place) : answer_table(answer, query.place))
            << std::flush;
  return std::cout ? exit_code(answer, query.place) : 1;
}

}  // namespace
}  // namespace kintsugi::segmenter

int main(int argc, char** argv) {
  using namespace kintsugi::segmenter;
  return kintsugi::run_main(argv, [&] {
    CLI::App app(
        "Asks a segmenter on the bus, or a saved map, about segments: position, size, plane, "
        "neighbours; and a detector on the bus where known objects are.");
    QueryOptions options;
    add_options(app, options);
    kintsugi::add_version_flag(app);
    CLI11_PARSE(app, argc, argv);
    return run(options);
  });
}
