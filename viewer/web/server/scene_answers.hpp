#pragma once

#include <map>
#include <string>

#include "viewer/web/scene/live_scene.hpp"

namespace kintsugi::viewer {

/// What the server answers; without the headers that all answers have.
struct Answer {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::string body;
};

using Parameters = std::multimap<std::string, std::string>;

/// Answers a request for `path`, which anybody may have written: 404 for a path that does not
/// exist, 400 for a parameter that is not what it must be; both with a sentence that says so.
Answer answer(LiveScene& scene, const std::string& path, const Parameters& parameters);

}  // namespace kintsugi::viewer
