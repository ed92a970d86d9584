// The server, over a real socket of the loopback interface.

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/support/temporary_folder.hpp"
#include "viewer/web/server/http_server.hpp"

namespace kintsugi::viewer {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr char kToken[] = "a-token-of-24-characters";

/// What the server sends for these bytes until it closes the connection or has nothing to say.
std::string exchange(int port, const std::string& request) {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    close(socket);
    throw std::runtime_error("cannot connect");
  }
  send(socket, request.data(), request.size(), MSG_NOSIGNAL);
  std::string answer;
  char buffer[4096];
  for (ssize_t got = 0; (got = recv(socket, buffer, sizeof(buffer), 0)) > 0;) {
    answer.append(buffer, static_cast<std::size_t>(got));
  }
  close(socket);
  return answer;
}

class Server : public ::testing::Test {
 protected:
  explicit Server(const std::string& token = "")
      : server_(parse_address("127.0.0.1:0"), token, scene_) {}

  std::string send(const std::string& bytes) const {
    return exchange(server_.address().port, bytes);
  }
  std::string ask(const std::string& line, const std::string& headers = {}) const {
    return send(line + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(server_.address().port) +
                "\r\nConnection: close\r\n" + headers + "\r\n");
  }
  std::string get(const std::string& path, const std::string& headers = {}) const {
    return ask("GET " + path, headers);
  }

  LiveScene scene_;
  HttpServer server_;
};

class ServerWithToken : public Server {
 protected:
  ServerWithToken() : Server(kToken) {}
};

TEST_F(Server, GivesThePageAndNothingFromElsewhere) {
  EXPECT_THAT(get("/"), AllOf(StartsWith("HTTP/1.1 200"), HasSubstr("text/html"),
                              HasSubstr("Content-Security-Policy: default-src 'self'"),
                              HasSubstr("X-Content-Type-Options: nosniff"),
                              HasSubstr("Cache-Control: no-store"), HasSubstr("<canvas")));
  EXPECT_THAT(get("/page.css"), HasSubstr("text/css"));
  EXPECT_THAT(get("/page.js"), AllOf(HasSubstr("text/javascript"), Not(HasSubstr("\nimport "))));
  for (const char* const path : {"/", "/page.css", "/page.js"}) {
    EXPECT_THAT(get(path), AllOf(Not(HasSubstr("http://")), Not(HasSubstr("https://"))));
  }
}

TEST_F(Server, AnswersBeforeAnythingHasCome) {
  EXPECT_THAT(get("/state?epoch=0&since=0"), HasSubstr("\"tiles\":[]"));
  EXPECT_THAT(get("/segments?epoch=0&since=0"), HasSubstr("\"segments\":[]"));
  EXPECT_THAT(get("/points?want=1.0.100"), StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(get("/path?part=-1"), StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(get("/camera.jpg"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(get("/segment?id=1"), StartsWith("HTTP/1.1 404"));
}

TEST_F(Server, HeadHasNoBody) {
  const std::string answer = ask("HEAD /");
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(answer, Not(HasSubstr("<canvas")));
}

TEST_F(Server, RefusesWhatDoesNotExistWithASentence) {
  for (const char* const path : {"/x", "/../etc/passwd", "/%2e%2e/etc/passwd", "/page.js/"}) {
    EXPECT_THAT(get(path), AllOf(StartsWith("HTTP/1.1 404"), HasSubstr("There is no such page.")))
        << path;
  }
}

TEST_F(Server, RefusesNumbersThatAreNone) {
  for (const char* const path : {"/state",
                                 "/state?epoch=1",
                                 "/state?epoch=1&since=-1",
                                 "/state?epoch=1&since=1x",
                                 "/state?epoch=1&since=",
                                 "/state?epoch=1&since=+1",
                                 "/state?epoch=1&since=%201",
                                 "/state?epoch=1&since=99999999999999999999",
                                 "/state?epoch=1&epoch=2&since=0",
                                 "/segment?id=4294967296",
                                 "/segment?id=0x10",
                                 "/path?part=1e3",
                                 "/points",
                                 "/points?want=",
                                 "/points?want=1",
                                 "/points?want=1.2",
                                 "/points?want=1.2.3.4",
                                 "/points?want=1.2.3,",
                                 "/points?want=1.-2.3",
                                 "/points?want=1.0.4000001",
                                 "/labels?want=1.2.3",
                                 "/points?want=1.0.4000000,2.0.1"}) {
    EXPECT_THAT(get(path), AllOf(StartsWith("HTTP/1.1 400"), HasSubstr("."))) << path;
  }
  std::string many = "/labels?want=1.1";
  for (int i = 0; i < 64; ++i) many += ",1.1";
  EXPECT_THAT(get(many), StartsWith("HTTP/1.1 400"));
}

TEST_F(Server, CannotBeChanged) {
  for (const char* const method : {"POST", "PUT", "DELETE", "PATCH", "OPTIONS"}) {
    EXPECT_THAT(ask(std::string(method) + " /", "Content-Length: 0\r\n"),
                AllOf(StartsWith("HTTP/1.1 405"), HasSubstr("Allow: GET, HEAD")))
        << method;
  }
  EXPECT_THAT(ask("FROB /"), StartsWith("HTTP/1.1 400"));
}

TEST_F(Server, RefusesWhatIsTooLongAndGoesOn) {
  EXPECT_THAT(get("/state?epoch=" + std::string(5000, '1')), StartsWith("HTTP/1.1 414"));
  EXPECT_THAT(get("/" + std::string(100'000, 'x')), Not(StartsWith("HTTP/1.1 200")));
  EXPECT_THAT(get("/", "X: " + std::string(100'000, 'x') + "\r\n"),
              Not(StartsWith("HTTP/1.1 200")));
  EXPECT_THAT(send(std::string("\0\xff\r\n\r\n", 6)), Not(StartsWith("HTTP/1.1 200")));
  EXPECT_THAT(send("GET / HTTP/9.9\r\n\r\n"), Not(StartsWith("HTTP/1.1 200")));
  EXPECT_THAT(get("/"), StartsWith("HTTP/1.1 200"));
}

TEST_F(Server, AnswersOnlyForThisMachineAsHost) {
  const auto ask_host = [&](const std::string& header) {
    return send("GET / HTTP/1.1\r\n" + header + "Connection: close\r\n\r\n");
  };
  EXPECT_THAT(ask_host("Host: localhost:1234\r\n"), StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(ask_host("Host: [::1]:1234\r\n"), StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(ask_host("Host: 127.0.0.1\r\n"), StartsWith("HTTP/1.1 200"));
  for (const char* const host : {"", "Host: evil.example\r\n", "Host: localhost.evil.example\r\n",
                                 "Host: 127.0.0.1.evil.example\r\n", "Host:\r\n",
                                 "Host: 127.0.0.1\r\nHost: evil.example\r\n"}) {
    EXPECT_THAT(ask_host(host), StartsWith("HTTP/1.1 421")) << host;
  }
}

TEST_F(ServerWithToken, LetsInWhoBringsTheToken) {
  EXPECT_THAT(get("/"), AllOf(StartsWith("HTTP/1.1 401"), Not(HasSubstr("<canvas"))));
  EXPECT_THAT(get("/state?epoch=0&since=0"), StartsWith("HTTP/1.1 401"));
  EXPECT_THAT(get("/?token=a-token-of-24-characterX"), StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(get("/?token="), StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(get("/?token=" + std::string(kToken)),
              AllOf(StartsWith("HTTP/1.1 303"), HasSubstr("Location: /\r\n"),
                    HasSubstr("Set-Cookie: kintsugi_token=" + std::string(kToken) +
                              "; Path=/; HttpOnly; SameSite=Strict")));
  const std::string cookie = "kintsugi_token=" + std::string(kToken);
  EXPECT_THAT(get("/", "Cookie: " + cookie + "\r\n"), StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(get("/", "Cookie: a=b; " + cookie + "; c=d\r\n"), StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(get("/", "Cookie: x" + cookie + "\r\n"), StartsWith("HTTP/1.1 401"));
  EXPECT_THAT(get("/", "Cookie: " + cookie + "x\r\n"), StartsWith("HTTP/1.1 401"));
}

TEST_F(Server, TwoCannotShareAPort) {
  LiveScene scene;
  EXPECT_THROW(HttpServer(server_.address(), "", scene), std::runtime_error);
}

TEST(Address, IsReadStrictly) {
  EXPECT_TRUE(parse_address("127.0.0.1:8080").is_loopback);
  EXPECT_TRUE(parse_address("127.1.2.3:8080").is_loopback);
  EXPECT_TRUE(parse_address("localhost:1").is_loopback);
  EXPECT_TRUE(parse_address("[::1]:8080").is_loopback);
  EXPECT_FALSE(parse_address("0.0.0.0:8080").is_loopback);
  EXPECT_FALSE(parse_address("[::]:8080").is_loopback);
  EXPECT_FALSE(parse_address("192.168.1.2:8080").is_loopback);
  EXPECT_EQ(parse_address("[::1]:8080").text(), "[::1]:8080");
  for (const char* const text : {"", "8080", ":8080", "127.0.0.1", "127.0.0.1:", "127.0.0.1:x",
                                 "127.0.0.1:65536", "127.0.0.1:-1", "127.0.0.1: 80", "::1:8080",
                                 "[127.0.0.1]:80", "robot.example:8080", "127.0.0.1:80/"}) {
    EXPECT_THROW(parse_address(text), std::invalid_argument) << text;
  }
}

TEST(Access, FromElsewhereNeedsAToken) {
  EXPECT_THROW(Access(parse_address("0.0.0.0:8080"), ""), std::invalid_argument);
  EXPECT_THROW(Access(parse_address("[::]:8080"), ""), std::invalid_argument);
  EXPECT_NO_THROW(Access(parse_address("0.0.0.0:8080"), kToken));
  EXPECT_NO_THROW(Access(parse_address("127.0.0.1:8080"), ""));
}

TEST(Access, ATokenIsTheFirstLineOfItsFile) {
  const testing::TemporaryFolder folder;
  const auto file = folder / "token";
  const auto write = [&](const std::string& text) { std::ofstream(file) << text; };
  write(std::string(kToken) + "\nmore\n");
  EXPECT_EQ(read_token(file), kToken);
  for (const char* const text :
       {"", "\n", "short\n", "sixteen letters with spaces\n", "semicolons;semicolons;\n"}) {
    write(text);
    EXPECT_THROW(read_token(file), std::runtime_error) << text;
  }
  EXPECT_THROW(read_token(folder / "absent"), std::runtime_error);
}

}  // namespace
}  // namespace kintsugi::viewer
