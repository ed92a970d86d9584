#pragma once
// A pack: sixteen numbers ("lanes") at a time, here for any processor. This file defines what each
// operation means; pack_avx2.hpp and pack_avx512.hpp have the same names and give the same bits.
//
// A kernel is written once, as a template over a pack, and instantiated in one source file for each
// instruction set (kernels_*.cpp). It may use a pack and the plain structs of its arguments and
// nothing else: of an inline function that several sources compile the linker keeps one copy for
// all of them, and that could be the one with instructions that this processor does not have. No
// operation is fused with another; division and square root are exact (IEEE 754, round to nearest).
// So every pack gives the same bytes.

#include <cstdint>

namespace kintsugi::mapper {
namespace portable {

inline constexpr int kNumLanes = 16;

/// One bool for each lane.
struct Mask {
  bool lanes[kNumLanes];

  /// True in the first `count` lanes, 0 to 16.
  static Mask first(int count) {
    Mask result;
    for (int i = 0; i < kNumLanes; ++i) result.lanes[i] = i < count;
    return result;
  }
  /// Bit i is lane i.
  std::uint32_t bits() const {
    std::uint32_t result = 0;
    for (int i = 0; i < kNumLanes; ++i) result |= static_cast<std::uint32_t>(lanes[i]) << i;
    return result;
  }
};

/// A 32-bit word in each lane; arithmetic is that of signed numbers and wraps around.
struct Int {
  std::int32_t lanes[kNumLanes];

  Int() = default;  ///< uninitialised
  // NOLINTNEXTLINE(google-explicit-constructor): a number among lanes is the number in every lane
  Int(std::int32_t value) {
    for (std::int32_t& lane : lanes) lane = value;
  }
  static Int iota() {  ///< 0, 1, ... 15
    Int result;
    for (int i = 0; i < kNumLanes; ++i) result.lanes[i] = i;
    return result;
  }

  /// From 16 words, of any alignment.
  static Int load(const std::int32_t* words) {
    Int result;
    for (int i = 0; i < kNumLanes; ++i) result.lanes[i] = words[i];
    return result;
  }
  static Int load(const std::uint32_t* words) {
    return load(reinterpret_cast<const std::int32_t*>(words));
  }
  /// From `count` words, 0 to 16; the other lanes are 0 and no further word is read.
  static Int load(const std::int32_t* words, int count) {
    Int result(0);
    for (int i = 0; i < count; ++i) result.lanes[i] = words[i];
    return result;
  }
  static Int load(const std::uint32_t* words, int count) {
    return load(reinterpret_cast<const std::int32_t*>(words), count);
  }
  void store(std::int32_t* words) const {
    for (int i = 0; i < kNumLanes; ++i) words[i] = lanes[i];
  }
  void store(std::uint32_t* words) const { store(reinterpret_cast<std::int32_t*>(words)); }
  /// Only where the mask is true; other words are neither read nor written.
  void store(std::int32_t* words, const Mask& mask) const {
    for (int i = 0; i < kNumLanes; ++i) {
      if (mask.lanes[i]) words[i] = lanes[i];
    }
  }
  void store(std::uint32_t* words, const Mask& mask) const {
    store(reinterpret_cast<std::int32_t*>(words), mask);
  }
};

/// A float in each lane.
struct Float {
  float lanes[kNumLanes];

  Float() = default;  ///< uninitialised
  // NOLINTNEXTLINE(google-explicit-constructor): a number among lanes is the number in every lane
  Float(float value) {
    for (float& lane : lanes) lane = value;
  }
  static Float iota() {  ///< 0, 1, ... 15
    Float result;
    for (int i = 0; i < kNumLanes; ++i) result.lanes[i] = static_cast<float>(i);
    return result;
  }

  /// From 16 numbers, of any alignment.
  static Float load(const float* numbers) {
    Float result;
    for (int i = 0; i < kNumLanes; ++i) result.lanes[i] = numbers[i];
    return result;
  }
  /// From `count` numbers, 0 to 16; the other lanes are 0 and no further number is read.
  static Float load(const float* numbers, int count) {
    Float result(0.0F);
    for (int i = 0; i < count; ++i) result.lanes[i] = numbers[i];
    return result;
  }
  void store(float* numbers) const {
    for (int i = 0; i < kNumLanes; ++i) numbers[i] = lanes[i];
  }
  /// Only where the mask is true; other numbers are neither read nor written.
  void store(float* numbers, const Mask& mask) const {
    for (int i = 0; i < kNumLanes; ++i) {
      if (mask.lanes[i]) numbers[i] = lanes[i];
    }
  }
};

// Helpers for the operations below.
template <typename Result, typename Function>
Result for_each_lane(Function function) {
  Result result;
  for (int i = 0; i < kNumLanes; ++i) result.lanes[i] = function(i);
  return result;
}
inline std::uint32_t word(const Int& a, int i) { return static_cast<std::uint32_t>(a.lanes[i]); }
inline std::int32_t number(std::uint32_t word) { return static_cast<std::int32_t>(word); }

// Masks.
inline Mask operator&(const Mask& a, const Mask& b) {
  return for_each_lane<Mask>([&](int i) { return a.lanes[i] && b.lanes[i]; });
}
inline Mask operator|(const Mask& a, const Mask& b) {
  return for_each_lane<Mask>([&](int i) { return a.lanes[i] || b.lanes[i]; });
}
inline Mask operator~(const Mask& a) {
  return for_each_lane<Mask>([&](int i) { return !a.lanes[i]; });
}
inline bool any(const Mask& mask) { return mask.bits() != 0; }
inline bool all(const Mask& mask) { return mask.bits() == 0xFFFF; }
inline bool none(const Mask& mask) { return mask.bits() == 0; }
/// How many lanes are true.
inline int count(const Mask& mask) { return __builtin_popcount(mask.bits()); }

// Floats. Comparisons with NaN are false, except !=, which is true.
inline Float operator+(const Float& a, const Float& b) {
  return for_each_lane<Float>([&](int i) { return a.lanes[i] + b.lanes[i]; });
}
inline Float operator-(const Float& a, const Float& b) {
  return for_each_lane<Float>([&](int i) { return a.lanes[i] - b.lanes[i]; });
}
inline Float operator*(const Float& a, const Float& b) {
  return for_each_lane<Float>([&](int i) { return a.lanes[i] * b.lanes[i]; });
}
inline Float operator/(const Float& a, const Float& b) {
  return for_each_lane<Float>([&](int i) { return a.lanes[i] / b.lanes[i]; });
}
inline Mask operator<(const Float& a, const Float& b) {
  return for_each_lane<Mask>([&](int i) { return a.lanes[i] < b.lanes[i]; });
}
inline Mask operator<=(const Float& a, const Float& b) {
  return for_each_lane<Mask>([&](int i) { return a.lanes[i] <= b.lanes[i]; });
}
inline Mask operator>(const Float& a, const Float& b) { return b < a; }
inline Mask operator>=(const Float& a, const Float& b) { return b <= a; }
inline Mask operator==(const Float& a, const Float& b) {
  return for_each_lane<Mask>([&](int i) { return a.lanes[i] == b.lanes[i]; });
}
inline Mask operator!=(const Float& a, const Float& b) { return ~(a == b); }
/// `a < b ? a : b`: the second where one is NaN.
inline Float min(const Float& a, const Float& b) {
  return for_each_lane<Float>(
      [&](int i) { return a.lanes[i] < b.lanes[i] ? a.lanes[i] : b.lanes[i]; });
}
/// `a > b ? a : b`: the second where one is NaN.
inline Float max(const Float& a, const Float& b) {
  return for_each_lane<Float>(
      [&](int i) { return a.lanes[i] > b.lanes[i] ? a.lanes[i] : b.lanes[i]; });
}
inline Float sqrt(const Float& a) {
  return for_each_lane<Float>([&](int i) { return __builtin_sqrtf(a.lanes[i]); });
}
inline Float abs(const Float& a) {
  return for_each_lane<Float>([&](int i) { return __builtin_fabsf(a.lanes[i]); });
}
/// Towards minus infinity; NaN and infinities stay.
inline Float floor(const Float& a) {
  return for_each_lane<Float>([&](int i) { return __builtin_floorf(a.lanes[i]); });
}
/// Lanes 0, 2, ... 14 of the first, then those of the second.
inline Float even_lanes(const Float& a, const Float& b) {
  return for_each_lane<Float>([&](int i) { return i < 8 ? a.lanes[i + i] : b.lanes[i + i - 16]; });
}
/// Lanes 1, 3, ... 15 of the first, then those of the second.
inline Float odd_lanes(const Float& a, const Float& b) {
  return for_each_lane<Float>(
      [&](int i) { return i < 8 ? a.lanes[i + i + 1] : b.lanes[i + i - 15]; });
}
/// The sum in this order: lanes 8 apart, of these sums those 4 apart, then 2, then 1.
inline float reduce_add(const Float& a) {
  Float sums = a;
  for (int apart = kNumLanes / 2; apart > 0; apart /= 2) {
    for (int i = 0; i < apart; ++i) sums.lanes[i] += sums.lanes[i + apart];
  }
  return sums.lanes[0];
}

// Words.
inline Int operator+(const Int& a, const Int& b) {
  return for_each_lane<Int>([&](int i) { return number(word(a, i) + word(b, i)); });
}
inline Int operator-(const Int& a, const Int& b) {
  return for_each_lane<Int>([&](int i) { return number(word(a, i) - word(b, i)); });
}
inline Int operator*(const Int& a, const Int& b) {
  return for_each_lane<Int>([&](int i) { return number(word(a, i) * word(b, i)); });
}
inline Int operator&(const Int& a, const Int& b) {
  return for_each_lane<Int>([&](int i) { return a.lanes[i] & b.lanes[i]; });
}
inline Int operator|(const Int& a, const Int& b) {
  return for_each_lane<Int>([&](int i) { return a.lanes[i] | b.lanes[i]; });
}
inline Mask operator==(const Int& a, const Int& b) {
  return for_each_lane<Mask>([&](int i) { return a.lanes[i] == b.lanes[i]; });
}
inline Mask operator!=(const Int& a, const Int& b) { return ~(a == b); }
inline Mask operator<(const Int& a, const Int& b) {
  return for_each_lane<Mask>([&](int i) { return a.lanes[i] < b.lanes[i]; });
}
inline Mask operator>(const Int& a, const Int& b) { return b < a; }
inline Int min(const Int& a, const Int& b) {
  return for_each_lane<Int>(
      [&](int i) { return a.lanes[i] < b.lanes[i] ? a.lanes[i] : b.lanes[i]; });
}
inline Int max(const Int& a, const Int& b) {
  return for_each_lane<Int>(
      [&](int i) { return a.lanes[i] > b.lanes[i] ? a.lanes[i] : b.lanes[i]; });
}
/// By 0 to 31 bits, the same in every lane.
template <int kBits>
Int shift_left(const Int& a) {
  return for_each_lane<Int>([&](int i) { return number(word(a, i) << kBits); });
}
/// Fills with zeros.
template <int kBits>
Int shift_right(const Int& a) {
  return for_each_lane<Int>([&](int i) { return number(word(a, i) >> kBits); });
}
/// Fills with copies of the sign.
template <int kBits>
Int shift_right_signed(const Int& a) {
  return for_each_lane<Int>([&](int i) { return a.lanes[i] >> kBits; });
}

// Conversions, selection and gathering.
/// Rounds to nearest, ties to even.
inline Float to_float(const Int& a) {
  return for_each_lane<Float>([&](int i) { return static_cast<float>(a.lanes[i]); });
}
/// Truncates; -2^31 for NaN and for numbers that do not fit.
inline Int to_int(const Float& a) {
  constexpr float kEnd = 2147483648.0F;
  return for_each_lane<Int>([&](int i) {
    const bool fits = a.lanes[i] >= -kEnd && a.lanes[i] < kEnd;
    return fits ? static_cast<std::int32_t>(a.lanes[i]) : INT32_MIN;
  });
}
/// `mask ? yes : no`.
inline Float select(const Mask& mask, const Float& yes, const Float& no) {
  return for_each_lane<Float>([&](int i) { return mask.lanes[i] ? yes.lanes[i] : no.lanes[i]; });
}
inline Int select(const Mask& mask, const Int& yes, const Int& no) {
  return for_each_lane<Int>([&](int i) { return mask.lanes[i] ? yes.lanes[i] : no.lanes[i]; });
}
/// base[index] where the mask is true; elsewhere 0, without reading, whatever the index.
inline Float gather(const float* base, const Int& index, const Mask& mask) {
  return for_each_lane<Float>([&](int i) { return mask.lanes[i] ? base[index.lanes[i]] : 0.0F; });
}
inline Int gather(const std::int32_t* base, const Int& index, const Mask& mask) {
  return for_each_lane<Int>([&](int i) { return mask.lanes[i] ? base[index.lanes[i]] : 0; });
}
inline Int gather(const std::uint32_t* base, const Int& index, const Mask& mask) {
  return gather(reinterpret_cast<const std::int32_t*>(base), index, mask);
}

}  // namespace portable

struct PortablePack {
  using Float = portable::Float;
  using Int = portable::Int;
  using Mask = portable::Mask;
  static constexpr int kNumLanes = portable::kNumLanes;
};

}  // namespace kintsugi::mapper
