#pragma once

#include <memory>
#include <string>

#include "viewer/web/scene/live_scene.hpp"
#include "viewer/web/server/access.hpp"
#include "viewer/web/server/address.hpp"

namespace kintsugi::viewer {

/// Serves a scene to browsers, from threads of its own: GET and HEAD only, nothing can be changed.
///
/// Requests are limited to 4 kB of URL and 8 kB a header, connections to 5 s of silence, and there
/// are 32 threads: whoever can reach the server can keep others from it, but not the viewer from
/// its work.
class HttpServer {
 public:
  /// Listens from now on until it is destroyed. `scene` must outlive it.
  /// @throws std::invalid_argument as Access
  /// @throws std::runtime_error when the address cannot be used
  HttpServer(const Address& address, const std::string& token, LiveScene& scene);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  /// With the port that is used.
  const Address& address() const { return address_; }

 private:
  struct Implementation;

  Address address_;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace kintsugi::viewer
