#pragma once
// Upper limits of a processor for vectors of an instruction set, for comparison with the kernels.

#include <cstddef>
#include <cstdint>

namespace kintsugi::mapper::bench {

/// Loops that do one kind of work only. Each returns a value that depends on all of the work, so
/// that the compiler cannot remove it.
struct MachineLimits {
  static constexpr int kNumChains = 12;  ///< enough to hide the latency of an operation

  /// `count` rounds of kNumChains independent chains of one multiplication and one addition, in 16
  /// lanes.
  float (*calculate)(std::size_t count);
  /// The sum of `count` numbers; a multiple of 64.
  float (*read)(const float* numbers, std::size_t count);
  /// The sum of `count` gathers of 16 words. The words of a gather are neighbours, as for rays of
  /// neighbouring pixels; successive gathers are at random places in `size` words (a power of two
  /// of at least 1024).
  std::int32_t (*read_scattered)(const std::int32_t* words, std::size_t size, std::size_t count);
};

extern const MachineLimits kPortableLimits;
extern const MachineLimits kAvx2Limits;
extern const MachineLimits kAvx512Limits;

/// The implementation for one instruction set.
template <typename Pack>
struct MachineLoops {
  using Float = typename Pack::Float;
  using Int = typename Pack::Int;
  using Mask = typename Pack::Mask;

  static float calculate(std::size_t count) {
    constexpr int kNumChains = MachineLimits::kNumChains;
    Float chains[kNumChains];
    for (int i = 0; i < kNumChains; ++i) chains[i] = Float(static_cast<float>(i));
    const Float factor(0.999F);
    const Float term(0.001F);
    for (std::size_t round = 0; round < count; ++round) {
      for (Float& chain : chains) chain = chain * factor + term;
    }
    Float sum(0.0F);
    for (const Float& chain : chains) sum = sum + chain;
    return reduce_add(sum);
  }

  static float read(const float* numbers, std::size_t count) {
    Float sums[4] = {Float(0.0F), Float(0.0F), Float(0.0F), Float(0.0F)};
    for (std::size_t i = 0; i < count; i += 64) {
      for (std::size_t k = 0; k < 4; ++k) sums[k] = sums[k] + Float::load(numbers + i + 16 * k);
    }
    return reduce_add((sums[0] + sums[1]) + (sums[2] + sums[3]));
  }

  static std::int32_t read_scattered(const std::int32_t* words, std::size_t size,
                                     std::size_t count) {
    // 4 x 4 words, in rows of 8 as those of a block of voxels.
    const Int near = (Int::iota() & Int(3)) + shift_left<1>(Int::iota() & Int(12));
    const Mask all = Mask::first(Pack::kNumLanes);
    const auto mask = static_cast<std::uint32_t>(size - 1) & ~63U;
    std::uint32_t random = 1;
    Int sum(0);
    for (std::size_t i = 0; i < count; ++i) {
      random = random * 1664525U + 1013904223U;
      const auto place = static_cast<std::int32_t>((random >> 4) & mask);
      sum = sum + gather(words, Int(place) + near, all);
    }
    std::int32_t lanes[Pack::kNumLanes];
    sum.store(lanes);
    return lanes[0] + lanes[15];
  }
};

}  // namespace kintsugi::mapper::bench
