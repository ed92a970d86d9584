#include "viewer/web/server/http_server.hpp"

#include <chrono>
#include <stdexcept>
#include <thread>
#include <utility>

#include <httplib.h>
#include <sys/socket.h>

#include "viewer/web/server/scene_answers.hpp"

namespace kintsugi::viewer {
namespace {

constexpr std::size_t kThreads = 32;
constexpr std::size_t kMaxUrlBytes = 4096;

/// Not the library's: SO_REUSEPORT would let two viewers share a port, each with half the requests.
void set_socket_options(socket_t socket) {
  const int yes = 1;
  setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
}

/// Nothing is loaded from elsewhere, nothing shows the page in a frame, nothing is kept.
void add_headers(httplib::Response& response) {
  response.set_header("Content-Security-Policy",
                      "default-src 'self'; img-src 'self' data:; frame-ancestors 'none'; "
                      "base-uri 'none'; form-action 'none'");
  response.set_header("X-Content-Type-Options", "nosniff");
  response.set_header("Referrer-Policy", "no-referrer");
  response.set_header("Cross-Origin-Resource-Policy", "same-origin");
  response.set_header("Cross-Origin-Opener-Policy", "same-origin");
  response.set_header("Cache-Control", "no-store");
}

void refuse(httplib::Response& response, int status, const std::string& sentence) {
  add_headers(response);
  response.status = status;
  response.set_content(sentence + '\n', "text/plain; charset=utf-8");
}

/// The token is right in the URL: it goes into a cookie and out of the address bar.
void accept_token(const httplib::Request& request, const Access& access,
                  httplib::Response& response) {
  add_headers(response);
  response.status = 303;
  response.set_header("Set-Cookie", access.cookie());
  // Only the path of our own page: never where the request says.
  response.set_header("Location", request.path == "/" ? "/" : "./");
}

/// True when the request has been answered.
bool refuse_or_let_in(const httplib::Request& request, const Access& access,
                      httplib::Response& response) {
  if (request.method != "GET" && request.method != "HEAD") {
    response.set_header("Allow", "GET, HEAD");
    refuse(response, 405, "This server only answers GET and HEAD.");
    return true;
  }
  if (request.target.size() > kMaxUrlBytes) {
    refuse(response, 414, "The address is too long.");
    return true;
  }
  if (request.get_header_value_count("Host") != 1 ||
      !access.is_host(request.get_header_value("Host"))) {
    refuse(response, 421, "This server does not answer for that host.");
    return true;
  }
  if (!access.needs_token()) return false;
  if (request.has_param("token")) {
    if (access.is_token(request.get_param_value("token"))) {
      accept_token(request, access, response);
    } else {
      refuse(response, 403, "The token is wrong.");
    }
    return true;
  }
  for (std::size_t i = 0; i < request.get_header_value_count("Cookie"); ++i) {
    if (access.has_cookie(request.get_header_value("Cookie", i))) return false;
  }
  refuse(response, 401, "This map needs a token: add ?token=TOKEN to the address.");
  return true;
}

}  // namespace

struct HttpServer::Implementation {
  Implementation(const Address& address, const std::string& token, LiveScene& scene)
      : access(address, token) {
    server.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
    server.set_socket_options(set_socket_options);
    server.set_keep_alive_max_count(10'000);
    server.set_payload_max_length(0);
    server.set_tcp_nodelay(true);
    server.set_pre_routing_handler([this](const auto& request, auto& response) {
      return refuse_or_let_in(request, access, response)
                 ? httplib::Server::HandlerResponse::Handled
                 : httplib::Server::HandlerResponse::Unhandled;
    });
    server.Get(".*", [&scene](const httplib::Request& request, httplib::Response& response) {
      Answer found = answer(scene, request.path, request.params);
      add_headers(response);
      response.status = found.status;
      response.body = std::move(found.body);  // set_content() would copy it
      response.set_header("Content-Type", found.type);
    });
    server.set_error_handler([](const httplib::Request&, httplib::Response& response) {
      if (response.body.empty()) refuse(response, response.status, "This request cannot be used.");
    });
    server.set_exception_handler(
        [](const httplib::Request&, httplib::Response& response, const std::exception_ptr&) {
          refuse(response, 500, "The viewer could not answer.");
        });
  }

  Access access;
  httplib::Server server;
  std::thread thread;
};

HttpServer::HttpServer(const Address& address, const std::string& token, LiveScene& scene)
    : address_(address), implementation_(std::make_unique<Implementation>(address, token, scene)) {
  httplib::Server& server = implementation_->server;
  if (address_.port == 0) {
    address_.port = server.bind_to_any_port(address_.host);
  } else if (!server.bind_to_port(address_.host, address_.port)) {
    address_.port = -1;
  }
  if (address_.port <= 0) {
    throw std::runtime_error("--http " + address.text() +
                             ": cannot listen there; another program may use the port");
  }
  implementation_->thread = std::thread([&server] { server.listen_after_bind(); });
}

HttpServer::~HttpServer() {
  // stop() does nothing before the thread has begun to listen.
  for (int i = 0; i < 1000 && !implementation_->server.is_running(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  implementation_->server.stop();
  implementation_->thread.join();
}

}  // namespace kintsugi::viewer
