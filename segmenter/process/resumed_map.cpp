#include "segmenter/process/resumed_map.hpp"

#include <stdexcept>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "segmenter/io/saved_map.hpp"

namespace kintsugi::segmenter {
namespace {

void require_same(const std::filesystem::path& file, const SegmentMapConfig& saved,
                  const SegmentMapConfig& wanted) {
  const auto require = [&](const char* option, const auto& was, const auto& is) {
    if (was != is) {
      throw std::runtime_error(
          fmt::format("'{}' was saved with {} {}, and here it is {}: give {} {} "
                      "to go on with it",
                      file.string(), option, was, is, option, was));
    }
  };
  require("--mode", saved.mode, wanted.mode);
  require("--threshold", saved.engine.threshold, wanted.engine.threshold);
  require("--scale", saved.engine.scale, wanted.engine.scale);
  require("--color-weight", saved.engine.color_weight, wanted.engine.color_weight);
  require("--min-points", saved.engine.min_points, wanted.engine.min_points);
  require("--beta", saved.engine.beta, wanted.engine.beta);
  require("--radius-factor", saved.engine.radius_factor, wanted.engine.radius_factor);
}

}  // namespace

std::unique_ptr<SegmentMap> resume_map(const std::filesystem::path& file,
                                       const SegmentMapConfig& config, std::int64_t session) {
  SegmentMapState state = read_map_state(file);
  require_same(file, state.config, config);
  state.config.engine.neighbour_search = config.engine.neighbour_search;
  state.config.engine.audit = config.engine.audit;
  state.session = session;  // listeners tell the streams of two segmenters apart by it
  auto map = make_map(state, file);
  spdlog::info("resumed {}: {} slices, {} points of session {}", file.string(), state.slices.size(),
               state.points_W.size(), state.map_session);
  return map;
}

}  // namespace kintsugi::segmenter
