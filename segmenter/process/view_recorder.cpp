#include "segmenter/process/view_recorder.hpp"

#include <utility>

#include "lcmtypes/channels.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr std::size_t kMaxSessions = 64;  // as many as maps are kept

}  // namespace

ViewRecorder::ViewRecorder(std::string map_name)
    : map_name_(std::move(map_name)),
      logged_(channels::kCameraView, [this](const CameraView& view) { add(view); }) {}

// Of sessions beyond the limit the oldest is given up: it is the last one that is saved.
ViewRecord* ViewRecorder::find_or_begin(std::int64_t map_session, const std::string& map_name) {
  if (!map_name_.empty() && map_name != map_name_) return nullptr;
  const auto found = by_session_.try_emplace(map_session, map_session, map_name).first;
  if (by_session_.size() <= kMaxSessions) return &found->second;
  const bool is_oldest = found == by_session_.begin();
  by_session_.erase(by_session_.begin());
  return is_oldest ? nullptr : &found->second;
}

void ViewRecorder::add(const CameraView& view) {
  const std::lock_guard lock(mutex_);
  if (ViewRecord* const record = find_or_begin(view.session, view.map_name)) record->add(view);
}

void ViewRecorder::add(const CloudSlice& slice) {
  const std::lock_guard lock(mutex_);
  if (ViewRecord* const record = find_or_begin(slice.session, slice.map_name)) record->add(slice);
}

bool ViewRecorder::handle(const std::string& channel, ByteView message) {
  return channel == channels::kCameraView && logged_.handle(channel, message);
}

void ViewRecorder::resume(ViewSet saved, const SegmentMap& map) {
  const std::lock_guard lock(mutex_);
  ViewRecord record(std::move(saved), map);
  const auto meanwhile = by_session_.find(map.map_session());
  if (meanwhile != by_session_.end()) record.append(meanwhile->second);
  by_session_.insert_or_assign(map.map_session(), std::move(record));
}

std::shared_ptr<const ViewSet> ViewRecorder::views(std::int64_t map_session) const {
  const std::lock_guard lock(mutex_);
  const auto found = by_session_.find(map_session);
  if (found == by_session_.end()) return nullptr;
  return std::make_shared<const ViewSet>(found->second.views());
}

}  // namespace kintsugi::segmenter
