#pragma once
// Simulates a bad network for datagrams; reproducible from a seed, without a clock.

#include <cstdint>
#include <optional>
#include <queue>
#include <random>
#include <vector>

#include "lcmtypes/codec/codec.hpp"

namespace kintsugi::testing {

/// One direction of a bad network: it drops, duplicates, delays and reorders datagrams. What
/// happens to the n-th datagram depends only on the seed and n.
class FaultyPath {
 public:
  struct Config {
    double drop = 0.0;       ///< share that is dropped, 0 to 1
    double duplicate = 0.0;  ///< of the rest, the share that is duplicated, 0 to 1
    double hold_back = 0.0;  ///< of what is delivered, the share that is held back, 0 to 1
    double held_s = 0.02;    ///< most by which that is held back; >= 0
    double delay_s = 0.0;    ///< delay of every datagram; >= 0
    std::uint64_t seed = 1;

    /// Throws std::invalid_argument naming field, value and bound.
    void validate() const;
  };

  struct Counts {
    std::int64_t in = 0;
    std::int64_t dropped = 0;
    std::int64_t duplicated = 0;
    std::int64_t overtaken = 0;  ///< delivered after one that was sent later
    std::int64_t out = 0;
  };

  explicit FaultyPath(const Config& config);

  /// Times are seconds of any clock that does not go back.
  void put(Bytes datagram, double now_s);
  /// The next datagram that is due.
  std::optional<Bytes> take(double now_s);
  /// When the next datagram is due; nothing: none is on its way.
  std::optional<double> next_due_s() const;

  const Counts& counts() const { return counts_; }

 private:
  struct UnderWay {
    double due_s = 0.0;
    std::int64_t number = 0;  // in the order of sending
    Bytes datagram;

    /// Datagrams that are due together are delivered in the order of sending.
    bool operator<(const UnderWay& other) const {
      return due_s != other.due_s ? due_s > other.due_s : number > other.number;
    }
  };

  double delay_s();

  const Config config_;
  std::mt19937_64 random_;
  std::priority_queue<UnderWay> under_way_;
  std::int64_t newest_out_ = -1;
  Counts counts_;
};

}  // namespace kintsugi::testing
