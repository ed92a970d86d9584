#pragma once

#include <optional>
#include <string>

#include "viewer/receiving/message.hpp"
#include "viewer/web/scene/live_scene.hpp"
#include "viewer/web/scene/scene_feed.hpp"
#include "viewer/web/server/http_server.hpp"

namespace kintsugi::viewer {

/// The map in browsers: the scene, what feeds it, and the server.
class WebView {
 public:
  struct Config {
    Address address;
    std::string token;  ///< empty: none
    SplatConfig splat;  ///< of the camera's image
  };

  /// @throws as HttpServer
  explicit WebView(const Config& config);

  // The drawing thread:
  void use(const Message& message);
  /// Call often. `session`: the one to show; nullptr: there is none.
  void refresh(const MapSession* session, const ViewerStatus& status) {
    feed_.refresh(session, status);
  }

 private:
  LiveScene scene_;
  SceneFeed feed_;
  HttpServer server_;
};

}  // namespace kintsugi::viewer
