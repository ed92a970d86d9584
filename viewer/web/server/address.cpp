#include "viewer/web/server/address.hpp"

#include <charconv>
#include <optional>
#include <stdexcept>

#include <arpa/inet.h>
#include <netinet/in.h>

namespace kintsugi::viewer {
namespace {

/// Nothing: the host is none that we know.
std::optional<bool> is_loopback(const std::string& host) {
  if (host == "localhost") return true;
  in_addr v4{};
  if (inet_pton(AF_INET, host.c_str(), &v4) == 1) return (ntohl(v4.s_addr) >> 24U) == 127;
  in6_addr v6{};
  if (inet_pton(AF_INET6, host.c_str(), &v6) == 1) return IN6_IS_ADDR_LOOPBACK(&v6) != 0;
  return std::nullopt;
}

std::optional<int> port_of(const std::string& text) {
  int port = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, port);
  if (error != std::errc() || rest != end || port < 0 || port > 65535) return std::nullopt;
  return port;
}

}  // namespace

std::string Address::text() const {
  const bool is_v6 = host.find(':') != std::string::npos;
  return (is_v6 ? '[' + host + ']' : host) + ':' + std::to_string(port);
}

Address parse_address(const std::string& text) {
  const auto fail = [&]() -> Address {
    throw std::invalid_argument("--http is \"" + text +
                                "\", must be HOST:PORT, where HOST is localhost or an address in "
                                "digits, of IPv6 in brackets");
  };
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos) return fail();
  Address address;
  address.host = text.substr(0, colon);
  const bool has_brackets =
      address.host.size() > 2 && address.host.front() == '[' && address.host.back() == ']';
  if (has_brackets) address.host = address.host.substr(1, address.host.size() - 2);
  if (has_brackets != (address.host.find(':') != std::string::npos)) return fail();
  const auto port = port_of(text.substr(colon + 1));
  const auto loopback = is_loopback(address.host);
  if (!port || !loopback) return fail();
  address.port = *port;
  address.is_loopback = *loopback;
  return address;
}

}  // namespace kintsugi::viewer
