#include "viewer/process/viewer.hpp"

#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "lcmtypes/base/argument_check.hpp"

namespace kintsugi::viewer {
void Viewer::Config::validate() const {
  painter.validate();
  require(every_slices >= 1, "Viewer::Config::every_slices", every_slices, ">= 1");
  require(video_period_s > 0.0, "Viewer::Config::video_period_s", video_period_s, "> 0 s");
  require(video_frames_per_s >= 1.0 && video_frames_per_s <= 120.0,
          "Viewer::Config::video_frames_per_s", video_frames_per_s, "in [1, 120]");
}

Viewer::Viewer(const Config& config, Outputs outputs)
    : config_((config.validate(), config)),
      outputs_(std::move(outputs)),
      painter_(config.painter),
      folder_(config.folder),
      sessions_(!config.painter.timelines.empty()) {
  if (config_.video) {
    const Renderer::Config& renderer = config_.painter.renderer;
    const cv::Size size(renderer.width_px, renderer.height_px);
    video_ = std::make_unique<VideoRecorder>(*config_.video, size, config_.video_frames_per_s);
  }
}

void Viewer::add(Message message, double now_s) {
  std::visit([&](auto&& m) { use(std::forward<decltype(m)>(m), now_s); }, std::move(message));
}

void Viewer::use(CloudSlice slice, double now_s) {
  SessionScene* const scene = enter_session(slice.session, now_s);
  if (scene == nullptr) return;
  map_name_ = slice.map_name;
  scene->use(std::move(slice), now_s);
}

void Viewer::use(const SegmentUpdate& update, double now_s) {
  if (auto* const scene = enter_session(update.map_session, now_s)) scene->use(update, now_s);
}

void Viewer::use(const CameraPose& pose, double /*now_s*/) { sessions_.use(pose); }

void Viewer::use(const SegmenterStatus& status, double /*now_s*/) {
  if (SessionScene* const scene = sessions_.find(status.map_session)) scene->use(status);
}

void Viewer::use(const SegmentAnswer& answer, double /*now_s*/) {
  if (SessionScene* const scene = sessions_.find(answer.map_session)) scene->use(answer);
}

SessionScene* Viewer::enter_session(std::int64_t session, double now_s) {
  SessionScene* const scene = sessions_.enter(session, now_s);
  if (scene == nullptr && outputs_.on_forgotten) outputs_.on_forgotten(session);
  if (sessions_.has_too_many()) forget_oldest();
  return scene;
}

void Viewer::forget_oldest() {
  const auto& [session, shown] = *sessions_.scenes().begin();
  if (!write_final(sessions_.scenes().begin()->second)) ++failures_;
  if (outputs_.on_forgotten) outputs_.on_forgotten(session);
  sessions_.forget_oldest();
}

void Viewer::draw_if_due() {
  SessionScene* const scene = sessions_.current_scene();
  if (scene == nullptr) return;
  const bool snapshot = scene->snapshot_is_due(config_.every_slices);
  const bool frame = video_ && scene->frame_is_due(config_.video_period_s);
  const bool answer = scene->answer_is_due();
  if ((!snapshot && !frame && !answer) || painter_.is_resting()) return;
  const cv::Mat3b figure = painter_.draw_figure(*scene);
  if (frame) {
    video_->add(figure);
    scene->note_frame();
  }
  if (answer) write_highlight(*scene, figure);
  if (snapshot) write_snapshot(*scene, figure);
}

void Viewer::draw_snapshot_now() {
  SessionScene* const scene = sessions_.current_scene();
  if (scene != nullptr && scene->scene().newest_slice() != nullptr) {
    write_snapshot(*scene, painter_.draw_figure(*scene));
  }
}

void Viewer::write_snapshot(SessionScene& shown, const cv::Mat3b& figure) {
  const std::string text = caption(shown.scene());
  const std::int32_t slice_id = shown.scene().newest_slice()->id;
  if (!folder_.save(fmt::format("snapshot_{:06}.png", slice_id), figure)) ++failures_;
  outputs_.on_picture(figure, text);
  shown.note_snapshot();
  spdlog::info("{}; drawn in {:.0f} ms", text, painter_.render_ms());
}

void Viewer::write_highlight(SessionScene& shown, const cv::Mat3b& figure) {
  if (!folder_.save("highlight.png", figure)) ++failures_;
  outputs_.on_picture(figure, caption(shown.scene()));
  shown.note_answer();
  spdlog::info("{} segments of an answer in highlight.png", shown.answered().size());
}

std::string Viewer::final_suffix(const SessionScene& shown) const {
  return is_current(shown) ? "" : fmt::format("_{}", shown.scene().map_session());
}

/// A session that another one follows may have ended without a final slice.
bool Viewer::has_ended(const SessionScene& shown, double now_s, bool more_may_come) const {
  if (shown.is_complete()) return true;
  const bool may_have_ended = shown.scene().final_update_seen() || !is_current(shown);
  return may_have_ended && shown.is_silent(now_s) && !more_may_come;
}

void Viewer::write_finals(double now_s, bool more_may_come) {
  bool all_written = true;
  bool has_current_ended = false;
  for (auto& [session, shown] : sessions_.scenes()) {
    if (!has_ended(shown, now_s, more_may_come)) continue;
    has_current_ended |= is_current(shown);
    if (!shown.final_is_due(final_suffix(shown))) continue;
    all_written = finals_retry_.is_time(now_s) && write_final(shown) && all_written;
  }
  note_finals(now_s, all_written, has_current_ended);
  const SessionScene* const replaced = sessions_.replaced();
  if (replaced != nullptr && all_written && replaced->is_complete()) forget_oldest();
}

void Viewer::note_finals(double now_s, bool all_written, bool has_current_ended) {
  if (all_written) {
    finals_retry_.note_success();
  } else {
    finals_retry_.note_failure(now_s);
  }
  finished_ = has_current_ended && (all_written || finals_retry_.has_tried_enough(now_s));
}

/// False when not all of them could be written: they are due again.
bool Viewer::write_final(SessionScene& shown) {
  const std::string suffix = final_suffix(shown);
  if (!shown.final_is_due(suffix)) return true;
  shown.prepare_final();
  const Scene& scene = shown.scene();
  const std::string text = final_caption(scene);
  const std::vector<NamedPicture> pictures = painter_.draw_finals(shown);
  if (!finals_retry_.is_failing()) outputs_.on_picture(pictures.front().picture, text);
  bool is_written = true;
  for (const auto& [name, picture] : pictures) {
    is_written &= folder_.save(name + suffix + ".png", picture);
  }
  if (!is_written) return false;
  shown.note_final(suffix);
  if (scene.lag_slices() > 0) {
    spdlog::warn("map session {}: {} slices lack their segments or are missing",
                 scene.map_session(), scene.lag_slices());
  }
  spdlog::info("final pictures of map session {}: {}", scene.map_session(), text);
  return true;
}

void Viewer::close() {
  for (auto& [session, shown] : sessions_.scenes()) {
    if (!write_final(shown)) ++failures_;
  }
  if (const SessionScene* const shown = sessions_.current_scene()) {
    finished_ = finished_ || shown->is_complete();
  }
  if (video_ && !video_->finish()) ++failures_;
}

ViewerStatus Viewer::status() const {
  ViewerStatus status;
  status.finished = finished_;
  status.snapshots_written = folder_.written();
  status.render_ms = painter_.render_ms();
  status.problem = folder_.problem();
  if (status.problem.empty() && video_) status.problem = video_->problem();
  for (const auto& [session, shown] : sessions_.scenes()) {
    status.memory_bytes += shown.memory_bytes();
  }
  const SessionScene* const shown = sessions_.current_scene();
  if (shown == nullptr) return status;
  const Scene& scene = shown->scene();
  status.map_session = scene.map_session();
  status.map_name = map_name_;
  status.slices_received = scene.counts().slices;
  status.updates_applied = scene.counts().updates;
  status.lag_slices = scene.lag_slices();
  status.points = scene.counts().points;
  status.segments = scene.counts().segments;
  return status;
}

}  // namespace kintsugi::viewer
