#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "viewer/web/server/address.hpp"

namespace kintsugi::viewer {

/// Who may see the map.
///
/// Without a token: whoever can reach the loopback address. Browsers of this machine can, and with
/// them every page that they show: so a request must name this machine as its host. A page of
/// another site whose name was made to point here does not (DNS rebinding).
/// With a token: who brings it, once in the URL and then as a cookie.
class Access {
 public:
  /// @throws std::invalid_argument when the address can be reached from elsewhere, and there is no
  ///   token
  Access(const Address& address, std::string token);

  bool needs_token() const { return !token_.empty(); }
  /// Takes the same time whatever the token is that is given.
  bool is_token(std::string_view given) const;
  /// The header `Cookie` has the token.
  bool has_cookie(std::string_view cookies) const;
  std::string cookie() const;  ///< for the header `Set-Cookie`

  /// The header `Host` names this machine; with a token every name will do.
  bool is_host(std::string_view host) const;

 private:
  std::string host_;
  std::string token_;
};

/// The first line of the file.
/// @throws std::runtime_error when it cannot be read, or has fewer than 16 characters or others
///   than letters, digits, - and _
std::string read_token(const std::filesystem::path& file);

}  // namespace kintsugi::viewer
