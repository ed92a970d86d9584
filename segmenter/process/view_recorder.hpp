#pragma once
// What the cameras of all maps saw, to be kept beside the saved map.

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "lcmtypes/stream/stream_subscriber.hpp"
#include "segmenter/views/view_record.hpp"

namespace kintsugi::segmenter {

/// Has a ViewRecord for each map session. For any thread.
class ViewRecorder {
 public:
  /// @param map_name only views of this map; empty: of all
  explicit ViewRecorder(std::string map_name);

  void add(const CameraView& view);
  void add(const CloudSlice& slice);
  /// The same of a message of a log. False when it is on another channel.
  bool handle(const std::string& channel, ByteView message);

  /// Goes on with the views of a saved map.
  void resume(ViewSet saved, const SegmentMap& map);

  /// Of a map session, as of now; null: there are none. Copies share the depth images.
  [[nodiscard]] std::shared_ptr<const ViewSet> views(std::int64_t map_session) const;

 private:
  ViewRecord* find_or_begin(std::int64_t map_session, const std::string& map_name);

  const std::string map_name_;
  mutable std::mutex mutex_;  // guards the next
  std::map<std::int64_t, ViewRecord> by_session_;
  StreamSubscriber<CameraView> logged_;
};

}  // namespace kintsugi::segmenter
