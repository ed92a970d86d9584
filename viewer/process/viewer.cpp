#include "viewer/process/viewer.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "viewer/core/require.hpp"
#include "viewer/output/picture_file.hpp"

namespace kintsugi::viewer {
namespace {

std::string snapshot_name(std::int32_t slice_id) {
  return fmt::format("snapshot_{:06}.png", slice_id);
}

double milliseconds(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double, std::milli>(duration).count();
}

}  // namespace

void Viewer::Config::validate() const {
  renderer.validate();
  require(every_slices >= 1, "Viewer::Config::every_slices", every_slices, ">= 1");
  require(video_period_s > 0.0, "Viewer::Config::video_period_s", video_period_s, "> 0 s");
  require(video_frames_per_s >= 1.0 && video_frames_per_s <= 120.0,
          "Viewer::Config::video_frames_per_s", video_frames_per_s, "in [1, 120]");
  require(max_drawing_share > 0.0 && max_drawing_share <= 1.0, "Viewer::Config::max_drawing_share",
          max_drawing_share, "in (0, 1]");
}

Viewer::Viewer(const Config& config, OnSnapshot on_snapshot)
    : config_((config.validate(), config)),
      on_snapshot_(std::move(on_snapshot)),
      renderer_(config.renderer) {
  if (config_.video) {
    const cv::Size size(config_.renderer.width_px, config_.renderer.height_px);
    video_ = std::make_unique<VideoFile>(*config_.video, size, config_.video_frames_per_s);
  }
}

void Viewer::add(Message message) {
  std::visit([this](auto&& m) { use(std::forward<decltype(m)>(m)); }, std::move(message));
}

void Viewer::use(CloudSlice slice) {
  if (!is_wanted(slice.map_name) || !enter_session(slice.session)) return;
  scene_->add_slice(std::move(slice));
  changed_since_final_ = true;
  last_map_message_ = Clock::now();
}

void Viewer::use(const SegmentUpdate& update) {
  if (!is_wanted(update.map_name) || !enter_session(update.map_session)) return;
  scene_->apply_update(update);
  history_.add_lag(*scene_);
  changed_since_final_ = true;
  last_map_message_ = Clock::now();
}

void Viewer::use(const CameraPose& pose) {
  const bool known = scene_ && scene_->map_session() == pose.session;
  if (!known && (!is_wanted("") || !enter_session(pose.session))) return;
  scene_->add_pose(pose);
  followed_.update(pose, scene_->up().up_W());
}

void Viewer::use(const SegmenterStatus& status) {
  if (scene_ && status.map_session == scene_->map_session()) history_.add_slice_time(status);
}

bool Viewer::is_wanted(const std::string& map_name) const {
  return config_.map_name.empty() || map_name == config_.map_name;
}

/// False for what is left over from a session that has been replaced.
bool Viewer::enter_session(std::int64_t session) {
  if (scene_ && scene_->map_session() == session) return true;
  if (past_sessions_.contains(session)) return false;
  if (scene_) {
    spdlog::info("map session {} follows {}", session, scene_->map_session());
    if (scene_->counts().slices > 0) write_final_as(fmt::format("_{}", scene_->map_session()));
    past_sessions_.insert(scene_->map_session());
  }
  scene_.emplace(session);
  followed_ = {};
  history_ = {};
  last_frame_utime_.reset();
  shown_in_snapshot_ = 0;
  changed_since_final_ = false;
  finished_ = false;
  return true;
}

/// Slices with their segments, corrected ones again; without a segmenter, slices.
std::int64_t Viewer::shown_slices() const {
  const SceneCounts& counts = scene_->counts();
  return counts.updates > 0 ? counts.labellings : counts.slices;
}

bool Viewer::snapshot_due() const {
  return scene_ && shown_slices() >= shown_in_snapshot_ + config_.every_slices &&
         scene_->newest_slice() != nullptr;
}

bool Viewer::frame_due() const {
  if (!scene_ || !video_ || scene_->counts().slices == 0) return false;
  const double elapsed_s =
      1e-6 * static_cast<double>(scene_->utime() - last_frame_utime_.value_or(0));
  return !last_frame_utime_ || elapsed_s >= config_.video_period_s;
}

void Viewer::draw_if_due() {
  const bool snapshot = snapshot_due();
  const bool frame = frame_due();
  if ((!snapshot && !frame) || Clock::now() < next_drawing_) return;
  const cv::Mat3b figure = draw(config_.view);
  if (frame) add_frame(figure);
  if (snapshot) write_snapshot(figure);
}

void Viewer::draw_snapshot_now() {
  if (scene_ && scene_->newest_slice() != nullptr) write_snapshot(draw(config_.view));
}

cv::Mat3b Viewer::draw(const View& view) {
  const Clock::time_point start = Clock::now();
  cv::Mat3b figure = renderer_.draw_figure(*scene_, scene_->heard_track(), followed_, view, caption(*scene_));
  const Clock::time_point end = Clock::now();
  render_ms_ = milliseconds(end - start);
  history_.add_render_time(*scene_, render_ms_);
  const double pause = 1.0 / config_.max_drawing_share - 1.0;
  next_drawing_ = end + std::chrono::duration_cast<Clock::duration>(pause * (end - start));
  return figure;
}

void Viewer::write_snapshot(const cv::Mat3b& figure) {
  const std::string text = caption(*scene_);
  save(snapshot_name(scene_->newest_slice()->id), figure);
  on_snapshot_(figure, text);
  shown_in_snapshot_ = shown_slices();
  spdlog::info("{}; drawn in {:.0f} ms", text, render_ms_);
}

void Viewer::add_frame(const cv::Mat3b& figure) {
  video_->add(figure);
  last_frame_utime_ = scene_->utime();
}

bool Viewer::complete() const {
  if (!scene_ || !scene_->final_update_seen()) return false;
  const std::chrono::duration<double> silence = Clock::now() - last_map_message_;
  return scene_->lag_slices() == 0 || silence.count() >= kPatience_s;
}

void Viewer::write_final() {
  if (scene_ && changed_since_final_) write_final_as("");
  finished_ = complete();
}

void Viewer::write_final_as(const std::string& suffix) {
  const cv::Mat3b figure = draw(OverviewView{});
  save("final" + suffix + ".png", figure);
  save("map_final" + suffix + ".png",
       renderer_.draw_map(*scene_, scene_->slice_track(), followed_, OverviewView{}, Coloring::kTrue));
  save("segments_final" + suffix + ".png",
       renderer_.draw_map(*scene_, scene_->slice_track(), followed_, OverviewView{}, Coloring::kSegments));
  if (config_.plots) save("plots" + suffix + ".png", history_.draw({1000, 900}));
  on_snapshot_(figure, caption(*scene_));
  changed_since_final_ = false;
  if (scene_->lag_slices() > 0) {
    spdlog::warn("map session {}: {} slices lack their segments or are missing",
                 scene_->map_session(), scene_->lag_slices());
  }
  spdlog::info("final pictures of map session {}: {}", scene_->map_session(), caption(*scene_));
}

void Viewer::close() {
  write_final();
  if (!video_) return;
  if (attempt([this] { video_->finish(); }) && video_->frames() > 0) {
    spdlog::info("{} frames in {}", video_->frames(), video_->path().string());
  }
  video_.reset();
}

void Viewer::save(const std::string& name, const cv::Mat3b& image) {
  if (attempt([&] { write_png(config_.folder / name, image); })) ++snapshots_written_;
}

template <class Action>
bool Viewer::attempt(Action&& action) {
  try {
    action();
    return true;
  } catch (const std::exception& error) {
    ++failures_;
    spdlog::error("{}", error.what());
    return false;
  }
}

ViewerStatus Viewer::status() const {
  ViewerStatus status;
  status.finished = finished_;
  status.snapshots_written = snapshots_written_;
  status.render_ms = render_ms_;
  if (!scene_) return status;
  const SceneCounts& counts = scene_->counts();
  status.slices_received = counts.slices;
  status.updates_applied = counts.updates;
  status.lag_slices = scene_->lag_slices();
  status.points = counts.points;
  status.segments = counts.segments;
  status.memory_bytes = scene_->memory_bytes();
  return status;
}

}  // namespace kintsugi::viewer
