#include "viewer/process/painter.hpp"

#include <utility>

#include "lcmtypes/base/argument_check.hpp"
#include "viewer/core/charts/timeline_chart.hpp"

namespace kintsugi::viewer {

void Painter::Config::validate() const {
  renderer.validate();
  require(max_drawing_share > 0.0 && max_drawing_share <= 1.0, "Painter::Config::max_drawing_share",
          max_drawing_share, "in (0, 1]");
}

Painter::Painter(const Config& config)
    : config_((config.validate(), config)), renderer_(config.renderer) {}

cv::Mat3b Painter::draw_figure(SessionScene& shown) {
  const Clock::time_point start = Clock::now();
  const Scene& scene = shown.scene();
  Highlight highlight = config_.highlight;
  highlight.insert(shown.answered().begin(), shown.answered().end());
  cv::Mat3b figure = renderer_.draw_figure(
      {scene, scene.heard_track(), shown.followed(), config_.view, std::move(highlight)},
      caption(scene));
  note_time(shown, start);
  return figure;
}

std::vector<NamedPicture> Painter::draw_finals(SessionScene& shown) {
  const Clock::time_point start = Clock::now();
  const Scene& scene = shown.scene();
  const Subject subject{scene, scene.slice_track(), shown.followed(), OverviewView{},
                        config_.highlight};
  std::vector<NamedPicture> pictures;
  pictures.push_back({"final", renderer_.draw_figure(subject, final_caption(scene))});
  note_time(shown, start);
  pictures.push_back({"map_final", renderer_.draw_map(subject, Coloring::kTrue)});
  pictures.push_back({"segments_final", renderer_.draw_map(subject, Coloring::kSegments)});
  if (config_.plots) pictures.push_back({"plots", shown.history().draw({1000, 900})});
  for (const std::uint32_t id : config_.timelines) {
    const SegmentTimeline timeline = timeline_of(id, shown.updates());
    pictures.push_back({"timeline_" + std::to_string(id), draw_timeline(timeline, {1280, 640})});
  }
  return pictures;
}

void Painter::note_time(SessionScene& shown, Clock::time_point start) {
  const Clock::time_point end = Clock::now();
  render_ms_ = std::chrono::duration<double, std::milli>(end - start).count();
  shown.history().add_render_time(shown.scene(), render_ms_);
  const double pause = 1.0 / config_.max_drawing_share - 1.0;
  rested_ = end + std::chrono::duration_cast<Clock::duration>(pause * (end - start));
}

}  // namespace kintsugi::viewer
