#pragma once
// Bytes as text, as other programs print hashes.

#include <cstdint>
#include <string>

namespace kintsugi::testing {

/// Two lower-case digits a byte.
template <class Bytes>
std::string hexadecimal(const Bytes& bytes) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const std::uint8_t byte : bytes) text += {kDigits[byte / 16], kDigits[byte % 16]};
  return text;
}

}  // namespace kintsugi::testing
