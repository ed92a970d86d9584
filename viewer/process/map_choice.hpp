#pragma once

#include <cstdint>
#include <mutex>
#include <set>
#include <string>

namespace kintsugi::viewer {

/// Which map of those on the bus is drawn: the one that was named, otherwise the first that is
/// heard of. Any thread may ask.
class MapChoice {
 public:
  /// `name` empty: the first.
  explicit MapChoice(std::string name) : name_(std::move(name)), is_open_(name_.empty()) {}

  /// Whether the map of this name is drawn. Says once of each other name that it is not.
  bool is_drawn(const std::string& name);

  /// What a person should know: maps that nobody has chosen to leave out, and how much came of
  /// them; empty when there are none.
  std::string problem() const;

 private:
  static constexpr std::size_t kMaxNames = 16;  ///< of other maps that are told apart

  mutable std::mutex mutex_;  // guards what follows
  std::string name_;
  bool is_open_;  // nothing has been heard yet, and no name was given
  bool is_first_heard_ = false;
  std::set<std::string> others_;
  std::int64_t other_messages_ = 0;
};

}  // namespace kintsugi::viewer
