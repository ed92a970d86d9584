#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/bus.hpp"
#include "lcmtypes/messages.hpp"
#include "lcmtypes/stream_publisher.hpp"
#include "mapper/core/rgbd_frame.hpp"

namespace kintsugi::mapper {

/// Everything the mapper says on the bus. The bulk streams are paced and drop nothing: who
/// publishes faster than they flow looks at has_room() and waits.
class MapPublisher {
 public:
  struct Config {
    std::string lcm_url;  ///< empty: LCM's default
    std::string map_name;
    std::int64_t session = 0;
    bool publish_frames = false;
    int jpeg_quality = 90;  ///< of published frames
    StreamPublisher::Config stream;
    std::size_t max_queued_bytes = 32U << 20U;  ///< per stream; no room above this
  };

  /// @throws std::runtime_error when the bus cannot be opened, with the cure
  explicit MapPublisher(const Config& config);

  void publish_slices(std::vector<CloudSlice> slices);
  void publish_pose(CameraPose pose);
  void publish_status(MapperStatus status);
  /// Does nothing unless frames are to be published.
  void publish_frame(const RgbdFrame& frame);

  /// The queues are short enough for more. After a failure of the bus they stay long: the next
  /// publish_...() throws it.
  bool has_room() const;

  /// What waits to be sent.
  std::size_t queued_bytes() const;

  /// Waits until everything is sent.
  void flush();

  std::int64_t slices_published() const { return slices_published_; }
  std::int64_t points_published() const { return points_published_; }
  std::int64_t chunks_published() const { return slice_stream_.chunks_published(); }

 private:
  Config config_;
  Bus bus_;
  StreamPublisher slice_stream_;
  std::optional<StreamPublisher> frame_stream_;
  std::int64_t slices_published_ = 0;
  std::int64_t points_published_ = 0;
};

}  // namespace kintsugi::mapper
