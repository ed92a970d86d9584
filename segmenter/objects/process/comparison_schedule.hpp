#pragma once
// When a map that grows is compared.

#include <chrono>

namespace kintsugi::segmenter {

/// Now and then while there is news, and once more when the map is complete: that may become known
/// long after the last news.
class ComparisonSchedule {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param period between the beginnings of two comparisons of a map that grows
  explicit ComparisonSchedule(std::chrono::duration<double> period) : period_(period) {}

  /// The map has changed.
  void note_news() { has_news_ = true; }
  /// @param now never goes back
  [[nodiscard]] bool is_due(bool is_complete, Clock::time_point now) const {
    if (is_complete) return has_news_ || !is_of_complete_map_;
    return has_news_ && now - begin_ >= period_;
  }
  /// A comparison of the map as it is begins.
  void begin(bool is_complete, Clock::time_point now) {
    begin_ = now;
    has_news_ = false;
    is_of_complete_map_ = is_complete;
  }

 private:
  std::chrono::duration<double> period_;
  Clock::time_point begin_{};  // of the last one
  bool has_news_ = false;      // since
  bool is_of_complete_map_ = false;
};

}  // namespace kintsugi::segmenter
