#pragma once

#include <string>

namespace kintsugi::viewer {

/// Where the server listens.
struct Address {
  std::string host;  ///< "localhost" or an address in digits, an IPv6 address without brackets
  int port = 0;      ///< 0: any that is free
  bool is_loopback = false;

  std::string text() const;  ///< HOST:PORT
};

/// Reads HOST:PORT; of IPv6 [HOST]:PORT.
/// @throws std::invalid_argument: names are refused, because whoever answers for a name decides
///   then who can reach the map
Address parse_address(const std::string& text);

}  // namespace kintsugi::viewer
