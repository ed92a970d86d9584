#pragma once
// Sixteen numbers at a time in one register of AVX-512; see pack_portable.hpp for what each
// operation means. Only for sources compiled with -mavx512f -mavx512bw -mavx512dq -mavx512vl.

#include <cstdint>

#if defined(__GNUC__) && !defined(__clang__)
// GCC's own header reads an undefined register on purpose (its bug 105593).
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include <immintrin.h>

namespace kintsugi::mapper {
namespace avx512 {

inline constexpr int kNumLanes = 16;

struct Mask {
  __mmask16 lanes;

  static Mask first(int count) { return {static_cast<__mmask16>((1U << count) - 1U)}; }
  std::uint32_t bits() const { return lanes; }
};

struct Int {
  __m512i lanes;

  Int() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): what the operations below return
  Int(__m512i value) : lanes(value) {}
  // NOLINTNEXTLINE(google-explicit-constructor): a number among lanes is the number in every lane
  Int(std::int32_t value) : lanes(_mm512_set1_epi32(value)) {}
  static Int iota() {
    return _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  }

  static Int load(const std::int32_t* words) { return _mm512_loadu_si512(words); }
  static Int load(const std::uint32_t* words) { return _mm512_loadu_si512(words); }
  static Int load(const std::int32_t* words, int count) {
    return _mm512_maskz_loadu_epi32(Mask::first(count).lanes, words);
  }
  static Int load(const std::uint32_t* words, int count) {
    return _mm512_maskz_loadu_epi32(Mask::first(count).lanes, words);
  }
  void store(std::int32_t* words) const { _mm512_storeu_si512(words, lanes); }
  void store(std::uint32_t* words) const { _mm512_storeu_si512(words, lanes); }
  void store(std::int32_t* words, const Mask& mask) const {
    _mm512_mask_storeu_epi32(words, mask.lanes, lanes);
  }
  void store(std::uint32_t* words, const Mask& mask) const {
    _mm512_mask_storeu_epi32(words, mask.lanes, lanes);
  }
};

struct Float {
  __m512 lanes;

  Float() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): what the operations below return
  Float(__m512 value) : lanes(value) {}
  // NOLINTNEXTLINE(google-explicit-constructor): a number among lanes is the number in every lane
  Float(float value) : lanes(_mm512_set1_ps(value)) {}
  static Float iota() {
    return _mm512_setr_ps(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  }

  static Float load(const float* numbers) { return _mm512_loadu_ps(numbers); }
  static Float load(const float* numbers, int count) {
    return _mm512_maskz_loadu_ps(Mask::first(count).lanes, numbers);
  }
  void store(float* numbers) const { _mm512_storeu_ps(numbers, lanes); }
  void store(float* numbers, const Mask& mask) const {
    _mm512_mask_storeu_ps(numbers, mask.lanes, lanes);
  }
};

// Masks.
inline Mask operator&(const Mask& a, const Mask& b) { return {_kand_mask16(a.lanes, b.lanes)}; }
inline Mask operator|(const Mask& a, const Mask& b) { return {_kor_mask16(a.lanes, b.lanes)}; }
inline Mask operator~(const Mask& a) { return {_knot_mask16(a.lanes)}; }
inline bool any(const Mask& mask) { return mask.lanes != 0; }
inline bool all(const Mask& mask) { return mask.lanes == 0xFFFF; }
inline bool none(const Mask& mask) { return mask.lanes == 0; }
inline int count(const Mask& mask) { return __builtin_popcount(mask.bits()); }

// Floats.
inline Float operator+(const Float& a, const Float& b) { return _mm512_add_ps(a.lanes, b.lanes); }
inline Float operator-(const Float& a, const Float& b) { return _mm512_sub_ps(a.lanes, b.lanes); }
inline Float operator*(const Float& a, const Float& b) { return _mm512_mul_ps(a.lanes, b.lanes); }
inline Float operator/(const Float& a, const Float& b) { return _mm512_div_ps(a.lanes, b.lanes); }
template <int kPredicate>
Mask compare(const Float& a, const Float& b) {
  return {_mm512_cmp_ps_mask(a.lanes, b.lanes, kPredicate)};
}
inline Mask operator<(const Float& a, const Float& b) { return compare<_CMP_LT_OQ>(a, b); }
inline Mask operator<=(const Float& a, const Float& b) { return compare<_CMP_LE_OQ>(a, b); }
inline Mask operator>(const Float& a, const Float& b) { return compare<_CMP_GT_OQ>(a, b); }
inline Mask operator>=(const Float& a, const Float& b) { return compare<_CMP_GE_OQ>(a, b); }
inline Mask operator==(const Float& a, const Float& b) { return compare<_CMP_EQ_OQ>(a, b); }
inline Mask operator!=(const Float& a, const Float& b) { return compare<_CMP_NEQ_UQ>(a, b); }
inline Float min(const Float& a, const Float& b) { return _mm512_min_ps(a.lanes, b.lanes); }
inline Float max(const Float& a, const Float& b) { return _mm512_max_ps(a.lanes, b.lanes); }
inline Float sqrt(const Float& a) { return _mm512_sqrt_ps(a.lanes); }
inline Float abs(const Float& a) { return _mm512_abs_ps(a.lanes); }
inline Float floor(const Float& a) {
  return _mm512_roundscale_ps(a.lanes, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
}
inline Float even_lanes(const Float& a, const Float& b) {
  const __m512i from = _mm512_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
  return _mm512_permutex2var_ps(a.lanes, from, b.lanes);
}
inline Float odd_lanes(const Float& a, const Float& b) {
  const __m512i from = _mm512_setr_epi32(1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31);
  return _mm512_permutex2var_ps(a.lanes, from, b.lanes);
}
inline float reduce_add(const Float& a) {
  const __m256 eight =
      _mm256_add_ps(_mm512_castps512_ps256(a.lanes), _mm512_extractf32x8_ps(a.lanes, 1));
  const __m128 four = _mm_add_ps(_mm256_castps256_ps128(eight), _mm256_extractf128_ps(eight, 1));
  const __m128 two = _mm_add_ps(four, _mm_movehl_ps(four, four));
  return _mm_cvtss_f32(_mm_add_ss(two, _mm_shuffle_ps(two, two, 1)));
}

// Words.
inline Int operator+(const Int& a, const Int& b) { return _mm512_add_epi32(a.lanes, b.lanes); }
inline Int operator-(const Int& a, const Int& b) { return _mm512_sub_epi32(a.lanes, b.lanes); }
inline Int operator*(const Int& a, const Int& b) { return _mm512_mullo_epi32(a.lanes, b.lanes); }
inline Int operator&(const Int& a, const Int& b) { return _mm512_and_si512(a.lanes, b.lanes); }
inline Int operator|(const Int& a, const Int& b) { return _mm512_or_si512(a.lanes, b.lanes); }
inline Mask operator==(const Int& a, const Int& b) {
  return {_mm512_cmpeq_epi32_mask(a.lanes, b.lanes)};
}
inline Mask operator!=(const Int& a, const Int& b) {
  return {_mm512_cmpneq_epi32_mask(a.lanes, b.lanes)};
}
inline Mask operator<(const Int& a, const Int& b) {
  return {_mm512_cmplt_epi32_mask(a.lanes, b.lanes)};
}
inline Mask operator>(const Int& a, const Int& b) {
  return {_mm512_cmpgt_epi32_mask(a.lanes, b.lanes)};
}
inline Int min(const Int& a, const Int& b) { return _mm512_min_epi32(a.lanes, b.lanes); }
inline Int max(const Int& a, const Int& b) { return _mm512_max_epi32(a.lanes, b.lanes); }
template <int kBits>
Int shift_left(const Int& a) {
  return _mm512_slli_epi32(a.lanes, kBits);
}
template <int kBits>
Int shift_right(const Int& a) {
  return _mm512_srli_epi32(a.lanes, kBits);
}
template <int kBits>
Int shift_right_signed(const Int& a) {
  return _mm512_srai_epi32(a.lanes, kBits);
}

// Conversions, selection and gathering.
inline Float to_float(const Int& a) { return _mm512_cvtepi32_ps(a.lanes); }
inline Int to_int(const Float& a) { return _mm512_cvttps_epi32(a.lanes); }
inline Float select(const Mask& mask, const Float& yes, const Float& no) {
  return _mm512_mask_blend_ps(mask.lanes, no.lanes, yes.lanes);
}
inline Int select(const Mask& mask, const Int& yes, const Int& no) {
  return _mm512_mask_blend_epi32(mask.lanes, no.lanes, yes.lanes);
}
inline Float gather(const float* base, const Int& index, const Mask& mask) {
  return _mm512_mask_i32gather_ps(_mm512_setzero_ps(), mask.lanes, index.lanes, base, 4);
}
inline Int gather(const std::int32_t* base, const Int& index, const Mask& mask) {
  return _mm512_mask_i32gather_epi32(_mm512_setzero_si512(), mask.lanes, index.lanes, base, 4);
}
inline Int gather(const std::uint32_t* base, const Int& index, const Mask& mask) {
  return gather(reinterpret_cast<const std::int32_t*>(base), index, mask);
}

}  // namespace avx512

struct Avx512Pack {
  using Float = avx512::Float;
  using Int = avx512::Int;
  using Mask = avx512::Mask;
  static constexpr int kNumLanes = avx512::kNumLanes;
};

}  // namespace kintsugi::mapper
