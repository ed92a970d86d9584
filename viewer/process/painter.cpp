#include "viewer/process/painter.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/base/stopwatch.hpp"
#include "viewer/core/charts/timeline_chart.hpp"

namespace kintsugi::viewer {

void Painter::Config::validate() const {
  renderer.validate();
  require(max_drawing_share > 0.0 && max_drawing_share <= 1.0, "Painter::Config::max_drawing_share",
          max_drawing_share, "in (0, 1]");
  require(map_period_s >= 0.0, "Painter::Config::map_period_s", map_period_s, ">= 0 s");
}

Painter::Painter(const Config& config)
    : config_((config.validate(), config)), renderer_(config.renderer) {}

cv::Mat3b Painter::draw_figure(MapSession& session, RunFigure::Map map_wanted) {
  const Stopwatch stopwatch;
  const ReceivedMap& map = session.map();
  const std::int32_t part = map.camera_part();
  Highlight highlight = config_.highlight;
  highlight.insert(session.answered().begin(), session.answered().end());
  cv::Mat3b figure = run_figure_.draw(
      {map, part, map.received_track(part), session.depth_camera(part), config_.viewpoint,
       std::move(highlight), session.objects()},
      session.view(), caption(map, part), map_is_due(session) ? RunFigure::Map::kNew : map_wanted);
  const double elapsed_ms = stopwatch.elapsed_ms();
  if (!run_figure_.has_drawn_map()) {
    without_map_ms_ = elapsed_ms;
    rest_end_ = after_rest(elapsed_ms);
    return figure;
  }
  map_utime_ = map.utime();
  note_time(session, elapsed_ms);
  return figure;
}

bool Painter::map_is_due(const MapSession& session) const {
  const std::int64_t age_us = session.map().utime() - map_utime_;
  const bool is_old = age_us < 0 || 1e-6 * static_cast<double>(age_us) >= config_.map_period_s;
  return is_old && Clock::now() >= map_rest_end_;
}

std::vector<NamedPicture> Painter::draw_final(MapSession& session, std::int32_t part,
                                              const std::string& part_of_name) {
  const Stopwatch stopwatch;
  const ReceivedMap& map = session.map();
  Subject subject{map,
                  part,
                  map.slice_track(part),
                  session.depth_camera(part),
                  OverviewViewpoint{},
                  config_.highlight};
  std::vector<NamedPicture> pictures;
  pictures.push_back(
      {"final", renderer_.draw_figure(subject, final_caption(map, part)), part_of_name});
  note_time(session, stopwatch.elapsed_ms());
  pictures.push_back({"map_final", renderer_.draw_map(subject, Coloring::kTrue), part_of_name});
  pictures.push_back(
      {"segments_final", renderer_.draw_map(subject, Coloring::kSegments), part_of_name});
  subject.objects = session.objects();
  if (!subject.objects.empty()) {
    pictures.push_back(
        {"objects_final", renderer_.draw_map(subject, Coloring::kTrue), part_of_name});
  }
  return pictures;
}

std::vector<NamedPicture> Painter::draw_finals(MapSession& session) {
  const std::int32_t last_part = session.map().newest_part();
  std::vector<NamedPicture> pictures = draw_final(session, last_part, "");
  for (const std::int32_t part : session.map().parts()) {
    if (part == last_part) continue;
    std::ranges::move(draw_final(session, part, ".part" + std::to_string(part)),
                      std::back_inserter(pictures));
  }
  if (config_.plots) pictures.push_back({"plots", session.history().draw({1000, 900})});
  for (const std::uint32_t id : config_.timelines) {
    const SegmentTimeline timeline = timeline_of(id, session.updates());
    pictures.push_back({"timeline_" + std::to_string(id), draw_timeline(timeline, {1280, 640})});
  }
  return pictures;
}

/// The pictures and the maps in them have half of the share each, so that the camera's image goes
/// on between two maps.
Painter::Clock::time_point Painter::after_rest(double drawing_ms) const {
  const std::chrono::duration<double, std::milli> rest(
      2.0 * (1.0 / config_.max_drawing_share - 1.0) * drawing_ms);
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(rest);
}

/// Of a picture with its map.
void Painter::note_time(MapSession& session, double render_ms) {
  render_ms_ = render_ms;
  session.history().add_render_time(session.map(), render_ms);
  const bool has_view = session.view() != nullptr;
  const double of_picture_ms = has_view ? std::min(without_map_ms_, render_ms) : render_ms;
  rest_end_ = after_rest(of_picture_ms);
  map_rest_end_ = after_rest(render_ms - (has_view ? of_picture_ms : 0.0));
}

}  // namespace kintsugi::viewer
