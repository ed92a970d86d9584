#pragma once
// The stream of segment updates.

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "lcmtypes/bus.hpp"
#include "lcmtypes/stream_publisher.hpp"

namespace kintsugi::segmenter {

/// Publishes what changes, and tells of what cannot be published instead of throwing: the map is
/// worth keeping without a listener.
class UpdatePublisher {
 public:
  /// @param bus must outlive this; null: publishes nothing
  /// @throws std::invalid_argument for an invalid config
  UpdatePublisher(Bus* bus, std::int64_t session, const StreamPublisher::Config& config);

  void publish(SegmentUpdate update);

  /// Waits until everything is sent.
  void flush();

  /// Whether anything waits to be sent.
  [[nodiscard]] bool is_idle() const;

  /// The first thing that could not be published; empty: none. From any thread.
  [[nodiscard]] std::string problem() const;

 private:
  template <class Action>
  void try_to(const Action& action);

  std::unique_ptr<StreamPublisher> stream_;
  mutable std::mutex mutex_;  // guards the next
  std::string problem_;
};

}  // namespace kintsugi::segmenter
