#pragma once
// Receives the maps of guests from the bus.

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "lcmtypes/base/patient_clock.hpp"
#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/bus/bus_thread.hpp"
#include "lcmtypes/messages.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"

namespace kintsugi::mapper {

/// Receives the keyframes of mappers that join this map (--join), and the slices of those mappers.
/// Nothing is lost: what is missing is requested again, from the beginning of the guest's session.
class GuestReceiver {
 public:
  /// What has been received.
  struct News {
    std::vector<KeyframeMessage> keyframes;
    std::vector<CloudSlice> slices;
  };

  /// @param map_name of this map
  /// @param session of this mapper, for its requests
  /// @throws std::runtime_error when the bus cannot be opened
  GuestReceiver(const std::string& lcm_url, std::string map_name, std::int64_t session);

  /// What has come since the last call.
  News take();

 private:
  void receive(KeyframeMessage keyframe);
  void subscribe_to_slices(std::int64_t guest, const std::string& map_name);
  void receive_slice(ByteView message);
  void hear(ByteView heartbeat);
  void ask();

  const std::string map_name_;
  const std::int64_t session_;
  PatientClock clock_;
  Bus bus_;
  // Of the thread:
  std::map<std::int64_t, std::string> found_;  ///< guests and their map names, since the last ask()
  StreamSubscriber<KeyframeMessage> keyframes_;
  /// By session of the guest. There are none before the first keyframe of one: who has no guests
  /// does not decode the slices of others.
  std::map<std::int64_t, std::unique_ptr<StreamSubscriber<CloudSlice>>> slices_;

  std::mutex mutex_;
  News news_;                          ///< guarded by mutex_
  std::unique_ptr<BusThread> thread_;  ///< last: it uses the rest
};

}  // namespace kintsugi::mapper
