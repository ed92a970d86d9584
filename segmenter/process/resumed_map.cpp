#include "segmenter/process/resumed_map.hpp"

#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "lcmtypes/base/logger.hpp"
#include "segmenter/io/saved_map.hpp"
#include "segmenter/io/views_file.hpp"

namespace kintsugi::segmenter {
namespace {

void require_same(const std::filesystem::path& file, const SegmentMapConfig& saved,
                  const SegmentMapConfig& wanted) {
  const auto require = [&](const std::string& option, const auto& was, const auto& is) {
    if (was != is) {
      throw std::runtime_error(
          fmt::format("'{}' was saved with {} {}, and here it is {}: give {} {} "
                      "to resume it",
                      file.string(), option, was, is, option, was));
    }
  };
  require("--mode", saved.mode, wanted.mode);
  for (const EngineParameter& parameter : kMapParameters) {
    if (parameter.comes_with_slices) continue;
    require(option_name(parameter), saved.engine.*parameter.value, wanted.engine.*parameter.value);
  }
}

}  // namespace

std::unique_ptr<SegmentMap> resume_map(const std::filesystem::path& file,
                                       const SegmentMapConfig& config, const std::string& map_name,
                                       std::int64_t session) {
  SegmentMapState state = read_map_state(file);
  if (!map_name.empty() && state.map_name != map_name) {
    throw std::runtime_error(
        fmt::format("'{}' has the map '{}', and --map-name is '{}': resume it without --map-name, "
                    "or the file of that map",
                    file.string(), state.map_name, map_name));
  }
  require_same(file, state.config, config);
  state.config.engine.neighbour_search = config.engine.neighbour_search;
  state.config.engine.audit = config.engine.audit;
  state.session = session;  // listeners tell the streams of two segmenters apart by it
  auto map = make_map(state, file);
  spdlog::info("resumed {}: {} slices, {} points of session {}", file.string(), state.slices.size(),
               state.points_W.size(), state.map_session);
  return map;
}

void resume_views(const std::filesystem::path& file, const SegmentMap& map,
                  ViewRecorder& recorder) {
  const std::filesystem::path path = views_file_of(file);
  ViewSet views;
  views.map_session = map.map_session();
  views.map_name = map.map_name();
  if (!std::filesystem::exists(path)) {
    spdlog::info("there is no {}: what the camera saw so far is not known", path.string());
  } else if (ViewSet saved = read_views(path); saved.map_session != views.map_session) {
    spdlog::warn("{} has the views of session {}, not of {}: they are replaced", path.string(),
                 saved.map_session, views.map_session);
  } else {
    views = std::move(saved);
    spdlog::info("resumed {}: {} views", path.string(), views.views.size());
  }
  recorder.resume(std::move(views), map);
}

}  // namespace kintsugi::segmenter
