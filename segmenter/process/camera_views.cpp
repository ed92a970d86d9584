#include "segmenter/process/camera_views.hpp"

#include <utility>

#include "lcmtypes/channels.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr std::size_t kMaxSessions = 64;  // as many as maps are kept

}  // namespace

CameraViews::CameraViews(std::function<void(const CameraView&)> on_view)
    : stream_(channels::kCameraView, [this, on_view = std::move(on_view)](CameraView view) {
        if (on_view) on_view(view);
        add(std::move(view), Clock::now());
      }) {}

void CameraViews::add(CameraView view, Clock::time_point now) {
  view.color_jpeg = {};
  const std::int64_t session = view.session;
  const std::lock_guard lock(mutex_);
  Received& newest = by_session_[session];
  if (newest.view && newest.view->utime > view.utime) return;  // overtaken
  newest = {std::make_shared<const CameraView>(std::move(view)), now};
  if (by_session_.size() > kMaxSessions) by_session_.erase(by_session_.begin());
}

std::shared_ptr<const CameraView> CameraViews::newest(std::int64_t map_session) const {
  const std::lock_guard lock(mutex_);
  const auto found = by_session_.find(map_session);
  if (found == by_session_.end() || Clock::now() - found->second.time > kMaxAge) return nullptr;
  return is_located(found->second.view->state) ? found->second.view : nullptr;
}

}  // namespace kintsugi::segmenter
