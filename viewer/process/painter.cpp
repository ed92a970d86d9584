#include "viewer/process/painter.hpp"

#include <utility>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/base/stopwatch.hpp"
#include "viewer/core/charts/timeline_chart.hpp"

namespace kintsugi::viewer {

void Painter::Config::validate() const {
  renderer.validate();
  require(max_drawing_share > 0.0 && max_drawing_share <= 1.0, "Painter::Config::max_drawing_share",
          max_drawing_share, "in (0, 1]");
}

Painter::Painter(const Config& config)
    : config_((config.validate(), config)), renderer_(config.renderer) {}

cv::Mat3b Painter::draw_figure(MapSession& session) {
  const Stopwatch stopwatch;
  const ReceivedMap& map = session.map();
  Highlight highlight = config_.highlight;
  highlight.insert(session.answered().begin(), session.answered().end());
  cv::Mat3b figure = renderer_.draw_figure(
      {map, map.received_track(), session.depth_camera(), config_.viewpoint, std::move(highlight)},
      caption(map));
  note_time(session, stopwatch.elapsed_ms());
  return figure;
}

std::vector<NamedPicture> Painter::draw_finals(MapSession& session) {
  const Stopwatch stopwatch;
  const ReceivedMap& map = session.map();
  const Subject subject{map, map.slice_track(), session.depth_camera(), OverviewViewpoint{},
                        config_.highlight};
  std::vector<NamedPicture> pictures;
  pictures.push_back({"final", renderer_.draw_figure(subject, final_caption(map))});
  note_time(session, stopwatch.elapsed_ms());
  pictures.push_back({"map_final", renderer_.draw_map(subject, Coloring::kTrue)});
  pictures.push_back({"segments_final", renderer_.draw_map(subject, Coloring::kSegments)});
  if (config_.plots) pictures.push_back({"plots", session.history().draw({1000, 900})});
  for (const std::uint32_t id : config_.timelines) {
    const SegmentTimeline timeline = timeline_of(id, session.updates());
    pictures.push_back({"timeline_" + std::to_string(id), draw_timeline(timeline, {1280, 640})});
  }
  return pictures;
}

void Painter::note_time(MapSession& session, double render_ms) {
  render_ms_ = render_ms;
  session.history().add_render_time(session.map(), render_ms);
  const std::chrono::duration<double, std::milli> rest((1.0 / config_.max_drawing_share - 1.0) *
                                                       render_ms);
  rest_end_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(rest);
}

}  // namespace kintsugi::viewer
