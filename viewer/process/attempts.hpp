#pragma once

#include <exception>
#include <string>
#include <utility>

#include <spdlog/spdlog.h>

namespace kintsugi::viewer {

/// Tries again and again what the world may refuse, a full disk say: reports when it begins to fail
/// and when it works again, not each time.
class Attempts {
 public:
  /// True when `action` did not throw.
  template <class Action>
  bool operator()(Action&& action) {
    try {
      std::forward<Action>(action)();
    } catch (const std::exception& error) {
      fail(error.what());
      return false;
    }
    succeed();
    return true;
  }

  void fail(const std::string& why) {
    if (problem_.empty()) spdlog::error("{}", why);
    problem_ = why;
  }

  void succeed() {
    if (!problem_.empty()) spdlog::info("writing again, after: {}", problem_);
    problem_.clear();
  }

  /// Why the last attempt failed; empty when it did not.
  const std::string& problem() const { return problem_; }

 private:
  std::string problem_;
};

}  // namespace kintsugi::viewer
