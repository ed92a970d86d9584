#pragma once
// The secret that the programs on one bus share.

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <memory>

#include "lcmtypes/codec/codec.hpp"

namespace kintsugi {

/// Authenticates messages with BLAKE2b (RFC 7693), keyed. Objects do not change: threads may share
/// one.
class BusKey {
 public:
  static constexpr std::size_t kBytes = 32;
  static constexpr std::size_t kTagBytes = 16;
  using Secret = std::array<std::uint8_t, kBytes>;
  using Tag = std::array<std::uint8_t, kTagBytes>;

  explicit BusKey(const Secret& secret);
  ~BusKey();
  BusKey(const BusKey&) = delete;
  BusKey& operator=(const BusKey&) = delete;

  /// Reads a file of exactly kBytes bytes, which only its owner may read or write.
  /// @throws std::runtime_error naming the file, what is wrong with it and what to do
  static std::shared_ptr<const BusKey> read(const std::filesystem::path& path);

  /// BLAKE2b with this key and a hash of kTagBytes bytes, of the pieces one behind the other.
  Tag tag(std::initializer_list<ByteView> pieces) const;

 private:
  Secret secret_;
};

/// Creates a file with a new random key, which only its owner may read or write (mode 0600).
/// @throws std::system_error when the file exists or cannot be written; then none remains
void write_new_bus_key(const std::filesystem::path& path);

}  // namespace kintsugi
