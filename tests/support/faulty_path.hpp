#pragma once
// What a bad network does to datagrams, by a seed and without a clock.

#include <cstdint>
#include <optional>
#include <queue>
#include <random>
#include <vector>

#include "lcmtypes/codec/codec.hpp"

namespace kintsugi::testing {

/// One direction of a bad network: a datagram that goes in comes out not at all, once or twice,
/// late, or after others that went in later. What becomes of the n-th datagram depends on the seed
/// and n alone.
class FaultyPath {
 public:
  struct Config {
    double drop = 0.0;       ///< share that never comes out, 0 to 1
    double duplicate = 0.0;  ///< of the rest, the share that comes out twice, 0 to 1
    double hold_back = 0.0;  ///< of what comes out, the share that others overtake, 0 to 1
    double held_s = 0.02;    ///< how much later that comes, at most; >= 0
    double delay_s = 0.0;    ///< how much later everything comes; >= 0
    std::uint64_t seed = 1;

    /// Throws std::invalid_argument naming field, value and bound.
    void validate() const;
  };

  struct Counts {
    std::int64_t in = 0;
    std::int64_t dropped = 0;
    std::int64_t duplicated = 0;
    std::int64_t overtaken = 0;  ///< came out after one that went in later
    std::int64_t out = 0;
  };

  explicit FaultyPath(const Config& config);

  /// Times are seconds of any clock that does not go back.
  void put(Bytes datagram, double now_s);
  /// The next one that is due.
  std::optional<Bytes> take(double now_s);
  /// When the next one comes out; nothing: none is under way.
  std::optional<double> next_due_s() const;

  const Counts& counts() const { return counts_; }

 private:
  struct UnderWay {
    double due_s = 0.0;
    std::int64_t number = 0;  // in the order of going in
    Bytes datagram;

    /// Of those that are due together, the first that went in comes out first.
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
