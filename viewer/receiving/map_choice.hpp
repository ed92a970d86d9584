#pragma once

#include <cstdint>
#include <mutex>
#include <set>
#include <string>

namespace kintsugi::viewer {

/// Decides which of the maps on the bus is drawn: the one named by the user, otherwise the first
/// one received. Thread-safe.
class MapChoice {
 public:
  /// `name` empty: the first map received.
  explicit MapChoice(std::string name) : name_(std::move(name)), is_open_(name_.empty()) {}

  /// Whether the map of this name is drawn. Logs each other name once.
  bool is_drawn(const std::string& name);

  /// Names the maps that are not drawn and counts their messages; empty when there are none or the
  /// user named the map.
  std::string problem() const;

 private:
  static constexpr std::size_t kMaxNames = 16;  ///< of other maps, that are remembered

  mutable std::mutex mutex_;  // guards what follows
  std::string name_;
  bool is_open_;                    // no name was given, and no map received yet
  bool is_first_received_ = false;  // and not named by the user
  std::set<std::string> others_;
  std::int64_t other_messages_ = 0;
};

}  // namespace kintsugi::viewer
