#pragma once
// Receives what is published of the objects of one map, from the bus or a log.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/client/event_table.hpp"

namespace kintsugi {

/// Keeps the detections of objects and the changes of one map. Only one thread may use it.
class ObjectListener {
 public:
  struct Handlers {
    /// Called with each event once, after it was applied.
    std::function<void(const ObjectDetection&)> on_detection;
    std::function<void(const ChangeReport&)> on_change;
  };

  /// @param map_name empty: the map of the first message that is received
  /// @param handlers may be empty
  explicit ObjectListener(std::string map_name, Handlers handlers = {});
  ObjectListener(const ObjectListener&) = delete;  // the bus calls it
  ObjectListener& operator=(const ObjectListener&) = delete;

  /// From now on bus.handle() applies messages, at the time of `now_s`: seconds that never
  /// decrease. This must outlive the last bus.handle().
  void subscribe(Bus& bus, const std::function<double()>& now_s);
  /// Handles one LCM message of a log.
  void handle(const std::string& channel, ByteView message, double now_s);

  const ObjectTable& objects() const { return objects_; }
  const ChangeTable& changes() const { return changes_; }
  /// The newest status of the detector; nothing: none was heard.
  const std::optional<DetectorStatus>& detector() const { return detector_; }
  /// Empty: no message of any map was heard.
  const std::string& map_name() const { return map_name_; }
  /// Which events were lost, as text for a person; empty: none.
  std::string losses() const;
  /// How many messages were dropped as invalid, and why the last was; empty: none.
  const std::string& dropped() const { return dropped_; }

 private:
  bool is_followed(const std::string& map_name);
  void use(const ObjectDetection& detection, double now_s);
  void use(const ChangeReport& change, double now_s);
  void use(const DetectorStatus& status, double now_s);

  std::string map_name_;
  const Handlers handlers_;
  ObjectTable objects_;
  ChangeTable changes_;
  std::optional<DetectorStatus> detector_;
  std::int64_t num_bad_ = 0;
  std::string dropped_;
};

}  // namespace kintsugi
