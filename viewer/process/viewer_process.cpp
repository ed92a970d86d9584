#include "viewer/process/viewer_process.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/base/logger.hpp"
#include "lcmtypes/base/process_memory.hpp"

namespace kintsugi::viewer {

void ViewerProcess::Config::validate() const {
  painter.validate();
  require(every_s > 0.0, "ViewerProcess::Config::every_s", every_s, "> 0 s");
  check_range("ViewerProcess::Config::video_rate_hz", video_rate_hz, 0.1, 120.0);
  if (video) check_video_name(*video);
}

ViewerProcess::ViewerProcess(const Config& config, Outputs outputs)
    : config_((config.validate(), config)),
      outputs_(std::move(outputs)),
      painter_(config.painter),
      folder_(config.folder),
      video_clock_(config.video_rate_hz),
      sessions_(!config.painter.timelines.empty()) {
  if (config_.video) {
    const MapRenderer::Config& renderer = config_.painter.renderer;
    const cv::Size size(renderer.width_px, renderer.height_px);
    video_ = std::make_unique<VideoRecorder>(*config_.video, size, config_.video_rate_hz);
  }
}

void ViewerProcess::add(Message message, double now_s) {
  const auto use = [&]<class M>(M&& m) {
    using Type = std::remove_cvref_t<M>;
    if constexpr (std::is_same_v<Type, CloudSlice>) {
      if (MapSession* const session = find_or_create_session(m.session, now_s)) {
        map_name_ = m.map_name;
        session->use(std::forward<M>(m), now_s);
      }
    } else if constexpr (std::is_same_v<Type, SegmentUpdate>) {
      MapSession* const session = find_or_create_session(m.map_session, now_s);
      if (session != nullptr) session->use(m, now_s);
    } else if constexpr (std::is_same_v<Type, CameraPose>) {
      sessions_.use(m);
    } else if constexpr (std::is_same_v<Type, CameraView>) {
      MapSession* const session = find_or_create_session(m.session, now_s);
      if (session != nullptr) session->use(std::forward<M>(m));
    } else if constexpr (std::is_same_v<Type, ObjectDetection> ||
                         std::is_same_v<Type, DetectorStatus>) {
      if (MapSession* const session = sessions_.find(m.map_session)) session->use(m, now_s);
    } else {  // a status or an answer of the segmenter
      if (MapSession* const session = sessions_.find(m.map_session)) session->use(m);
    }
  };
  std::visit(use, std::move(message));
}

/// nullptr when the session is too old to be drawn.
MapSession* ViewerProcess::find_or_create_session(std::int64_t session, double now_s) {
  MapSession* const found = sessions_.find_or_create(session, now_s);
  if (found == nullptr) outputs_.on_forgotten(session);
  if (sessions_.has_too_many()) forget_oldest();
  return found;
}

void ViewerProcess::forget_oldest() {
  auto& [number, session] = *sessions_.all().begin();
  if (!write_final(session)) ++failures_;
  outputs_.on_forgotten(number);
  sessions_.forget_oldest();
}

/// Pictures of the video that the map has passed and that are not in it.
int ViewerProcess::frames_due() const {
  const MapSession* const session = sessions_.current();
  if (!video_ || session == nullptr || !session->has_picture()) return 0;
  return video_clock_.due(session->map().utime());
}

void ViewerProcess::draw_if_due() {
  MapSession* const session = sessions_.current();
  if (session == nullptr) return;
  const bool snapshot = session->snapshot_is_due(config_.every_s);
  const bool answer = session->answer_is_due();
  const int frames = frames_due();
  if ((!snapshot && frames == 0 && !answer) || painter_.is_resting()) return;
  const auto map = snapshot || answer ? RunFigure::Map::kNew : RunFigure::Map::kMayBeOld;
  const cv::Mat3b figure = painter_.draw_figure(*session, map);
  if (frames > 0) add_to_video(*session, figure, frames);
  if (answer) write_highlight(*session, figure);
  if (snapshot) write_snapshot(*session, figure);
}

void ViewerProcess::add_to_video(const MapSession& session, const cv::Mat3b& figure, int frames) {
  video_->add(figure, frames);
  video_clock_.note(session.map().utime(), frames);
}

void ViewerProcess::draw_snapshot_now() {
  MapSession* const session = sessions_.current();
  if (session != nullptr && session->has_picture()) {
    write_snapshot(*session, painter_.draw_figure(*session, RunFigure::Map::kNew));
  }
}

void ViewerProcess::write_snapshot(MapSession& session, const cv::Mat3b& figure) {
  const ReceivedMap& map = session.map();
  const double time_s = 1e-6 * static_cast<double>(map.utime() - map.first_utime());
  if (!folder_.save(fmt::format("snapshot_{:06.1f}s.png", time_s), figure)) ++failures_;
  const std::string text = caption(map, map.camera_part());
  outputs_.on_picture(figure, text);
  session.note_snapshot();
  spdlog::info("{}; drawn in {:.0f} ms", text, painter_.render_ms());
}

void ViewerProcess::write_highlight(MapSession& session, const cv::Mat3b& figure) {
  if (!folder_.save("highlight.png", figure)) ++failures_;
  const ReceivedMap& map = session.map();
  outputs_.on_picture(figure, caption(map, map.camera_part()));
  session.note_answer();
  spdlog::info("{} segments of an answer in highlight.png", session.answered().size());
}

std::string ViewerProcess::final_suffix(const MapSession& session) const {
  return is_current(session) ? "" : fmt::format("_{}", session.map().map_session());
}

bool ViewerProcess::has_ended(const MapSession& session, double now_s, bool more_may_come) const {
  if (session.is_searched(now_s)) return false;
  if (session.is_complete()) return true;
  // The mapper may have begun a new session without completing this one.
  const bool may_have_ended = session.map().final_update_seen() || !is_current(session);
  return may_have_ended && session.is_silent(now_s) && !more_may_come;
}

void ViewerProcess::write_finals(double now_s, bool more_may_come) {
  bool all_written = true;
  bool have_all_ended = !sessions_.all().empty();
  for (auto& [number, session] : sessions_.all()) {
    if (!has_ended(session, now_s, more_may_come)) {
      have_all_ended = false;  // the session before may still be missing something
      continue;
    }
    if (!session.final_is_due(final_suffix(session))) continue;
    all_written = finals_retry_.is_time(now_s) && write_final(session) && all_written;
  }
  note_finals(now_s, all_written, have_all_ended);
  const MapSession* const replaced = sessions_.replaced();
  if (replaced != nullptr && all_written && replaced->is_complete()) forget_oldest();
}

void ViewerProcess::note_finals(double now_s, bool all_written, bool have_all_ended) {
  if (all_written) {
    finals_retry_.note_success();
  } else {
    finals_retry_.note_failure(now_s);
  }
  finished_ = have_all_ended && (all_written || finals_retry_.has_given_up(now_s));
}

/// False when not all pictures could be written; they remain due.
bool ViewerProcess::write_final(MapSession& session) {
  const std::string suffix = final_suffix(session);
  if (!session.final_is_due(suffix)) return true;
  session.prepare_final();
  const ReceivedMap& map = session.map();
  const std::string text = final_caption(map, map.newest_part());
  const std::vector<NamedPicture> pictures = painter_.draw_finals(session);
  if (!finals_retry_.is_failing()) outputs_.on_picture(pictures.front().picture, text);
  bool is_written = true;
  std::set<std::string> files;
  for (const auto& [name, picture, part] : pictures) {
    const std::string file = fmt::format("{}{}{}.png", name, suffix, part);
    is_written &= folder_.save(file, picture);
    files.insert(file);
  }
  if (!is_written) return false;
  replace_finals(suffix, std::move(files));
  session.note_final(suffix);
  if (map.lag_slices() > 0) {
    spdlog::warn("map session {}: {} slices lack their segments or are missing", map.map_session(),
                 map.lag_slices());
  }
  spdlog::info("final pictures of map session {}: {}", map.map_session(), text);
  return true;
}

/// Removes earlier final pictures of parts that the map has no longer.
void ViewerProcess::replace_finals(const std::string& suffix, std::set<std::string> files) {
  std::set<std::string>& before = finals_[suffix];
  for (const std::string& file : before) {
    if (!files.contains(file)) folder_.remove(file);
  }
  before = std::move(files);
}

/// The last picture of the video shows all that came.
void ViewerProcess::end_video() {
  MapSession* const session = sessions_.current();
  if (session != nullptr && session->has_picture()) {
    const cv::Mat3b figure = painter_.draw_figure(*session, RunFigure::Map::kNew);
    add_to_video(*session, figure, std::max(1, frames_due()));
  }
  if (!video_->finish()) ++failures_;
}

void ViewerProcess::close() {
  if (video_) end_video();
  for (auto& [number, session] : sessions_.all()) {
    if (!write_final(session)) ++failures_;
  }
  if (const MapSession* const session = sessions_.current()) {
    finished_ = finished_ || session->is_complete();
  }
}

ViewerStatus ViewerProcess::status() const {
  ViewerStatus status;
  status.finished = finished_;
  status.snapshots_written = folder_.written();
  status.render_ms = painter_.render_ms();
  status.problem = folder_.problem();
  if (status.problem.empty() && video_) status.problem = video_->problem();
  status.memory_bytes = process_memory().resident_bytes;
  const MapSession* const session = sessions_.current();
  if (session == nullptr) return status;
  const ReceivedMap& map = session->map();
  status.map_session = map.map_session();
  status.map_name = map_name_;
  status.slices_received = map.counts().slices;
  status.updates_applied = map.counts().updates;
  status.lag_slices = map.lag_slices();
  status.points = map.counts().points;
  status.segments = map.counts().segments;
  return status;
}

}  // namespace kintsugi::viewer
