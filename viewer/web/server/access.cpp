#include "viewer/web/server/access.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <stdexcept>
#include <utility>

namespace kintsugi::viewer {
namespace {

constexpr std::string_view kCookie = "kintsugi_token";

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

/// Without the port; an IPv6 address without its brackets.
std::string_view name_of(std::string_view host) {
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    return end == std::string_view::npos ? std::string_view() : host.substr(1, end - 1);
  }
  return host.substr(0, host.find(':'));
}

}  // namespace

Access::Access(const Address& address, std::string token)
    : host_(address.host), token_(std::move(token)) {
  if (!address.is_loopback && token_.empty()) {
    throw std::invalid_argument("--http " + address.text() +
                                " can be reached from other hosts: give --http-token FILE, or "
                                "listen at 127.0.0.1");
  }
}

bool Access::is_token(std::string_view given) const {
  // Compares every character, so that the time does not tell how many are right. Its length is no
  // secret.
  unsigned difference = given.size() == token_.size() ? 0U : 1U;
  for (std::size_t i = 0; i < token_.size(); ++i) {
    const char g = given.empty() ? '\0' : given[i % given.size()];
    difference |= static_cast<unsigned char>(g ^ token_[i]);
  }
  return needs_token() && difference == 0;
}

bool Access::has_cookie(std::string_view cookies) const {
  while (!cookies.empty()) {
    const std::size_t end = cookies.find(';');
    const std::string_view cookie = trimmed(cookies.substr(0, end));
    if (cookie.starts_with(kCookie) && cookie.substr(kCookie.size()).starts_with('=') &&
        is_token(cookie.substr(kCookie.size() + 1))) {
      return true;
    }
    if (end == std::string_view::npos) break;
    cookies.remove_prefix(end + 1);
  }
  return false;
}

std::string Access::cookie() const {
  return std::string(kCookie) + '=' + token_ + "; Path=/; HttpOnly; SameSite=Strict";
}

bool Access::is_host(std::string_view host) const {
  if (needs_token()) return true;
  const std::string_view name = name_of(host);
  return name == host_ || name == "localhost" || name == "127.0.0.1" || name == "::1";
}

std::string read_token(const std::filesystem::path& file) {
  constexpr std::size_t kLeast = 16;
  constexpr std::size_t kMost = 256;
  std::ifstream stream(file);
  std::string token;
  if (!std::getline(stream, token)) {
    throw std::runtime_error("--http-token " + file.string() + " cannot be read or is empty");
  }
  const auto is_allowed = [](unsigned char c) { return std::isalnum(c) || c == '-' || c == '_'; };
  if (token.size() < kLeast || token.size() > kMost || !std::ranges::all_of(token, is_allowed)) {
    throw std::runtime_error("--http-token " + file.string() +
                             ": its first line must have 16 to 256 letters, digits, - and _");
  }
  return token;
}

}  // namespace kintsugi::viewer
