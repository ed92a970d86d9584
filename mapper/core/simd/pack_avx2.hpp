#pragma once
// Sixteen numbers at a time in two registers of AVX2; see pack_portable.hpp for what each operation
// means. Only for sources compiled with -mavx2.

#include <cstdint>

#include <immintrin.h>

namespace kintsugi::mapper {
namespace avx2 {

inline constexpr int kNumLanes = 16;

/// Each lane all ones or all zeros; `low` is lanes 0 to 7.
struct Mask {
  __m256i low, high;

  static Mask first(int count) {
    const __m256i counts = _mm256_set1_epi32(count);
    return {_mm256_cmpgt_epi32(counts, _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7)),
            _mm256_cmpgt_epi32(counts, _mm256_setr_epi32(8, 9, 10, 11, 12, 13, 14, 15))};
  }
  std::uint32_t bits() const {
    const int low_bits = _mm256_movemask_ps(_mm256_castsi256_ps(low));
    const int high_bits = _mm256_movemask_ps(_mm256_castsi256_ps(high));
    return static_cast<std::uint32_t>(low_bits | (high_bits << 8));
  }
};

struct Int {
  __m256i low, high;

  Int() = default;
  Int(__m256i low_lanes, __m256i high_lanes) : low(low_lanes), high(high_lanes) {}
  // NOLINTNEXTLINE(google-explicit-constructor): a number among lanes is the number in every lane
  Int(std::int32_t value) : low(_mm256_set1_epi32(value)), high(low) {}
  static Int iota() {
    return {_mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7),
            _mm256_setr_epi32(8, 9, 10, 11, 12, 13, 14, 15)};
  }

  static Int load(const std::int32_t* words) {
    return {_mm256_loadu_si256(reinterpret_cast<const __m256i*>(words)),
            _mm256_loadu_si256(reinterpret_cast<const __m256i*>(words + 8))};
  }
  static Int load(const std::uint32_t* words) {
    return load(reinterpret_cast<const std::int32_t*>(words));
  }
  static Int load(const std::int32_t* words, int count) {
    const Mask mask = Mask::first(count);
    return {_mm256_maskload_epi32(words, mask.low), _mm256_maskload_epi32(words + 8, mask.high)};
  }
  static Int load(const std::uint32_t* words, int count) {
    return load(reinterpret_cast<const std::int32_t*>(words), count);
  }
  void store(std::int32_t* words) const {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(words), low);
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(words + 8), high);
  }
  void store(std::uint32_t* words) const { store(reinterpret_cast<std::int32_t*>(words)); }
  void store(std::int32_t* words, const Mask& mask) const {
    _mm256_maskstore_epi32(words, mask.low, low);
    _mm256_maskstore_epi32(words + 8, mask.high, high);
  }
  void store(std::uint32_t* words, const Mask& mask) const {
    store(reinterpret_cast<std::int32_t*>(words), mask);
  }
};

struct Float {
  __m256 low, high;

  Float() = default;
  Float(__m256 low_lanes, __m256 high_lanes) : low(low_lanes), high(high_lanes) {}
  // NOLINTNEXTLINE(google-explicit-constructor): a number among lanes is the number in every lane
  Float(float value) : low(_mm256_set1_ps(value)), high(low) {}
  static Float iota() {
    return {_mm256_setr_ps(0, 1, 2, 3, 4, 5, 6, 7), _mm256_setr_ps(8, 9, 10, 11, 12, 13, 14, 15)};
  }

  static Float load(const float* numbers) {
    return {_mm256_loadu_ps(numbers), _mm256_loadu_ps(numbers + 8)};
  }
  static Float load(const float* numbers, int count) {
    const Mask mask = Mask::first(count);
    return {_mm256_maskload_ps(numbers, mask.low), _mm256_maskload_ps(numbers + 8, mask.high)};
  }
  void store(float* numbers) const {
    _mm256_storeu_ps(numbers, low);
    _mm256_storeu_ps(numbers + 8, high);
  }
  void store(float* numbers, const Mask& mask) const {
    _mm256_maskstore_ps(numbers, mask.low, low);
    _mm256_maskstore_ps(numbers + 8, mask.high, high);
  }
};

// Masks.
inline Mask make_mask(__m256 low, __m256 high) {
  return {_mm256_castps_si256(low), _mm256_castps_si256(high)};
}
inline Mask operator&(const Mask& a, const Mask& b) {
  return {_mm256_and_si256(a.low, b.low), _mm256_and_si256(a.high, b.high)};
}
inline Mask operator|(const Mask& a, const Mask& b) {
  return {_mm256_or_si256(a.low, b.low), _mm256_or_si256(a.high, b.high)};
}
inline Mask operator~(const Mask& a) {
  const __m256i ones = _mm256_set1_epi32(-1);
  return {_mm256_xor_si256(a.low, ones), _mm256_xor_si256(a.high, ones)};
}
inline bool none(const Mask& mask) {
  const __m256i either = _mm256_or_si256(mask.low, mask.high);
  return _mm256_testz_si256(either, either) != 0;
}
inline bool any(const Mask& mask) { return !none(mask); }
inline bool all(const Mask& mask) { return none(~mask); }
inline int count(const Mask& mask) { return __builtin_popcount(mask.bits()); }

// Floats.
inline Float operator+(const Float& a, const Float& b) {
  return {_mm256_add_ps(a.low, b.low), _mm256_add_ps(a.high, b.high)};
}
inline Float operator-(const Float& a, const Float& b) {
  return {_mm256_sub_ps(a.low, b.low), _mm256_sub_ps(a.high, b.high)};
}
inline Float operator*(const Float& a, const Float& b) {
  return {_mm256_mul_ps(a.low, b.low), _mm256_mul_ps(a.high, b.high)};
}
inline Float operator/(const Float& a, const Float& b) {
  return {_mm256_div_ps(a.low, b.low), _mm256_div_ps(a.high, b.high)};
}
template <int kPredicate>
Mask compare(const Float& a, const Float& b) {
  return make_mask(_mm256_cmp_ps(a.low, b.low, kPredicate),
                   _mm256_cmp_ps(a.high, b.high, kPredicate));
}
inline Mask operator<(const Float& a, const Float& b) { return compare<_CMP_LT_OQ>(a, b); }
inline Mask operator<=(const Float& a, const Float& b) { return compare<_CMP_LE_OQ>(a, b); }
inline Mask operator>(const Float& a, const Float& b) { return compare<_CMP_GT_OQ>(a, b); }
inline Mask operator>=(const Float& a, const Float& b) { return compare<_CMP_GE_OQ>(a, b); }
inline Mask operator==(const Float& a, const Float& b) { return compare<_CMP_EQ_OQ>(a, b); }
inline Mask operator!=(const Float& a, const Float& b) { return compare<_CMP_NEQ_UQ>(a, b); }
inline Float min(const Float& a, const Float& b) {
  return {_mm256_min_ps(a.low, b.low), _mm256_min_ps(a.high, b.high)};
}
inline Float max(const Float& a, const Float& b) {
  return {_mm256_max_ps(a.low, b.low), _mm256_max_ps(a.high, b.high)};
}
inline Float sqrt(const Float& a) { return {_mm256_sqrt_ps(a.low), _mm256_sqrt_ps(a.high)}; }
inline Float abs(const Float& a) {
  const __m256 sign = _mm256_set1_ps(-0.0F);
  return {_mm256_andnot_ps(sign, a.low), _mm256_andnot_ps(sign, a.high)};
}
inline Float floor(const Float& a) { return {_mm256_floor_ps(a.low), _mm256_floor_ps(a.high)}; }
/// Every second lane of sixteen, from kFirst (0 or 1) on.
template <int kFirst>
__m256 every_second(__m256 low, __m256 high) {
  constexpr int kPick = kFirst == 0 ? 0x88 : 0xDD;
  const __m256 picked = _mm256_shuffle_ps(low, high, kPick);  // halves of both, interleaved
  return _mm256_castpd_ps(_mm256_permute4x64_pd(_mm256_castps_pd(picked), 0xD8));
}
inline Float even_lanes(const Float& a, const Float& b) {
  return {every_second<0>(a.low, a.high), every_second<0>(b.low, b.high)};
}
inline Float odd_lanes(const Float& a, const Float& b) {
  return {every_second<1>(a.low, a.high), every_second<1>(b.low, b.high)};
}
inline float reduce_add(const Float& a) {
  const __m256 eight = _mm256_add_ps(a.low, a.high);
  const __m128 four = _mm_add_ps(_mm256_castps256_ps128(eight), _mm256_extractf128_ps(eight, 1));
  const __m128 two = _mm_add_ps(four, _mm_movehl_ps(four, four));
  return _mm_cvtss_f32(_mm_add_ss(two, _mm_shuffle_ps(two, two, 1)));
}

// Words.
inline Int operator+(const Int& a, const Int& b) {
  return {_mm256_add_epi32(a.low, b.low), _mm256_add_epi32(a.high, b.high)};
}
inline Int operator-(const Int& a, const Int& b) {
  return {_mm256_sub_epi32(a.low, b.low), _mm256_sub_epi32(a.high, b.high)};
}
inline Int operator*(const Int& a, const Int& b) {
  return {_mm256_mullo_epi32(a.low, b.low), _mm256_mullo_epi32(a.high, b.high)};
}
inline Int operator&(const Int& a, const Int& b) {
  return {_mm256_and_si256(a.low, b.low), _mm256_and_si256(a.high, b.high)};
}
inline Int operator|(const Int& a, const Int& b) {
  return {_mm256_or_si256(a.low, b.low), _mm256_or_si256(a.high, b.high)};
}
inline Mask operator==(const Int& a, const Int& b) {
  return {_mm256_cmpeq_epi32(a.low, b.low), _mm256_cmpeq_epi32(a.high, b.high)};
}
inline Mask operator!=(const Int& a, const Int& b) { return ~(a == b); }
inline Mask operator>(const Int& a, const Int& b) {
  return {_mm256_cmpgt_epi32(a.low, b.low), _mm256_cmpgt_epi32(a.high, b.high)};
}
inline Mask operator<(const Int& a, const Int& b) { return b > a; }
inline Int min(const Int& a, const Int& b) {
  return {_mm256_min_epi32(a.low, b.low), _mm256_min_epi32(a.high, b.high)};
}
inline Int max(const Int& a, const Int& b) {
  return {_mm256_max_epi32(a.low, b.low), _mm256_max_epi32(a.high, b.high)};
}
template <int kBits>
Int shift_left(const Int& a) {
  return {_mm256_slli_epi32(a.low, kBits), _mm256_slli_epi32(a.high, kBits)};
}
template <int kBits>
Int shift_right(const Int& a) {
  return {_mm256_srli_epi32(a.low, kBits), _mm256_srli_epi32(a.high, kBits)};
}
template <int kBits>
Int shift_right_signed(const Int& a) {
  return {_mm256_srai_epi32(a.low, kBits), _mm256_srai_epi32(a.high, kBits)};
}

// Conversions, selection and gathering.
inline Float to_float(const Int& a) {
  return {_mm256_cvtepi32_ps(a.low), _mm256_cvtepi32_ps(a.high)};
}
inline Int to_int(const Float& a) {
  return {_mm256_cvttps_epi32(a.low), _mm256_cvttps_epi32(a.high)};
}
inline Float select(const Mask& mask, const Float& yes, const Float& no) {
  return {_mm256_blendv_ps(no.low, yes.low, _mm256_castsi256_ps(mask.low)),
          _mm256_blendv_ps(no.high, yes.high, _mm256_castsi256_ps(mask.high))};
}
inline Int select(const Mask& mask, const Int& yes, const Int& no) {
  return {_mm256_blendv_epi8(no.low, yes.low, mask.low),
          _mm256_blendv_epi8(no.high, yes.high, mask.high)};
}
inline Float gather(const float* base, const Int& index, const Mask& mask) {
  const __m256 zero = _mm256_setzero_ps();
  return {_mm256_mask_i32gather_ps(zero, base, index.low, _mm256_castsi256_ps(mask.low), 4),
          _mm256_mask_i32gather_ps(zero, base, index.high, _mm256_castsi256_ps(mask.high), 4)};
}
inline Int gather(const std::int32_t* base, const Int& index, const Mask& mask) {
  const __m256i zero = _mm256_setzero_si256();
  return {_mm256_mask_i32gather_epi32(zero, base, index.low, mask.low, 4),
          _mm256_mask_i32gather_epi32(zero, base, index.high, mask.high, 4)};
}
inline Int gather(const std::uint32_t* base, const Int& index, const Mask& mask) {
  return gather(reinterpret_cast<const std::int32_t*>(base), index, mask);
}

}  // namespace avx2

struct Avx2Pack {
  using Float = avx2::Float;
  using Int = avx2::Int;
  using Mask = avx2::Mask;
  static constexpr int kNumLanes = avx2::kNumLanes;
};

}  // namespace kintsugi::mapper
