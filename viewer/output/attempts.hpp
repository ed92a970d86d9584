#pragma once

#include <exception>
#include <string>
#include <utility>

#include "lcmtypes/base/logger.hpp"

namespace kintsugi::viewer {

/// Logs the outcome of an action that is tried repeatedly and may fail for reasons outside the
/// program, such as a full disk: once when it begins to fail and once when it works again.
class Attempts {
 public:
  /// True when `action` did not throw.
  template <class Action>
  bool operator()(Action&& action) {
    try {
      std::forward<Action>(action)();
    } catch (const std::exception& error) {
      note_failure(error.what());
      return false;
    }
    note_success();
    return true;
  }

  void note_failure(const std::string& reason) {
    if (problem_.empty()) spdlog::error("{}", reason);
    problem_ = reason;
  }

  void note_success() {
    if (!problem_.empty()) spdlog::info("writing again, after: {}", problem_);
    problem_.clear();
  }

  /// Why the last attempt failed; empty when it succeeded.
  const std::string& problem() const { return problem_; }

 private:
  std::string problem_;
};

}  // namespace kintsugi::viewer
