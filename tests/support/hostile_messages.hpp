#pragma once
// Invalid messages for robustness tests, reproducible from a seed.

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "lcmtypes/codec/codec.hpp"

namespace kintsugi::testing {

/// In turn random bytes, random bytes behind the fingerprint of the channel's type, and a valid
/// message with a few bytes changed, removed, inserted or repeated; on every channel in turn. None
/// is valid, so a receiver has to drop every one.
class HostileMessages {
 public:
  enum class Kind { kRandom, kRandomBehindFingerprint, kMutated };
  static constexpr std::array kKinds{Kind::kRandom, Kind::kRandomBehindFingerprint, Kind::kMutated};

  struct Message {
    std::string channel;
    Kind kind = Kind::kRandom;
    Bytes data;
  };

  /// Starts with an example of each type of message. Random messages have at most `max_bytes`.
  explicit HostileMessages(std::uint64_t seed, std::size_t max_bytes = 60'000);

  /// Adds a valid message to those that are mutated; of many, the oldest is removed. Messages on
  /// channels other than ours are ignored.
  void learn(const std::string& channel, ByteView data);

  Message next();

 private:
  std::size_t below(std::size_t bound);
  std::size_t random_size();
  Bytes random_bytes(std::size_t size);
  Bytes mutated(const Bytes& valid);
  void mutate_once(Bytes& data);

  const std::size_t max_bytes_;
  std::mt19937_64 random_;
  std::map<std::string, std::vector<Bytes>> valid_;  // by channel, never empty
  std::map<std::string, std::size_t> learned_;       // how many by channel
  std::map<std::string, std::vector<Bytes>>::const_iterator channel_;
  std::size_t kind_ = 0;
};

}  // namespace kintsugi::testing
