#pragma once
// Each operation of a pack on 16 lanes in memory, so that a test can call those of every
// instruction set without being compiled for it.

#include <cstdint>

namespace kintsugi::mapper::testing {

using FloatLanes = float[16];
using IntLanes = std::int32_t[16];

struct PackInput {
  FloatLanes a;
  FloatLanes b;
  IntLanes i;
  IntLanes j;
  IntLanes index;                 ///< into the tables; out of their range where `mask` is false
  std::uint32_t mask = 0;         ///< bit for each lane
  int count = 0;                  ///< 0 to 16
  const float* floats = nullptr;  ///< a table
  const std::int32_t* words = nullptr;
  float* edge = nullptr;  ///< null, or `count` numbers that are to be doubled
};

/// One array of lanes, or the bits of one mask, for each operation.
struct PackOutput {
  FloatLanes add, subtract, multiply, divide, min, max, sqrt, abs, floor, to_float, select, gather;
  FloatLanes load_partial, store_masked, iota, even_lanes, odd_lanes;
  IntLanes int_add, int_subtract, int_multiply, int_and, int_or, int_min, int_max, to_int;
  IntLanes left_5, right_5, right_signed_5, left_0, left_31, int_select, int_gather, int_iota;
  IntLanes int_load_partial, int_store_masked;
  std::uint32_t less, less_equal, greater, greater_equal, equal, not_equal;
  std::uint32_t int_less, int_greater, int_equal, int_not_equal;
  std::uint32_t mask_and, mask_or, mask_not, mask_first;
  int mask_count;
  bool mask_any, mask_all, mask_none;
  float reduced;
};

using RunPackOperations = void (*)(const PackInput& input, PackOutput& output);

void run_pack_operations_portable(const PackInput& input, PackOutput& output);
void run_pack_operations_avx2(const PackInput& input, PackOutput& output);
void run_pack_operations_avx512(const PackInput& input, PackOutput& output);

/// What the three are instantiated from.
template <typename Pack>
void run_pack_operations(const PackInput& in, PackOutput& out) {
  using Float = typename Pack::Float;
  using Int = typename Pack::Int;
  using Mask = typename Pack::Mask;
  const Float a = Float::load(in.a);
  const Float b = Float::load(in.b);
  const Int i = Int::load(in.i);
  const Int j = Int::load(in.j);
  const Int index = Int::load(in.index);
  IntLanes mask_words;
  for (int lane = 0; lane < 16; ++lane) {
    mask_words[lane] = static_cast<std::int32_t>((in.mask >> lane) & 1U);
  }
  const Mask mask = Int::load(mask_words) == Int(1);
  const Mask less = a < b;

  (a + b).store(out.add);
  (a - b).store(out.subtract);
  (a * b).store(out.multiply);
  (a / b).store(out.divide);
  min(a, b).store(out.min);
  max(a, b).store(out.max);
  sqrt(a).store(out.sqrt);
  abs(a).store(out.abs);
  floor(a).store(out.floor);
  to_float(i).store(out.to_float);
  select(mask, a, b).store(out.select);
  gather(in.floats, index, mask).store(out.gather);
  Float::load(in.a, in.count).store(out.load_partial);
  b.store(out.store_masked);
  a.store(out.store_masked, mask);
  Float::iota().store(out.iota);
  even_lanes(a, b).store(out.even_lanes);
  odd_lanes(a, b).store(out.odd_lanes);

  (i + j).store(out.int_add);
  (i - j).store(out.int_subtract);
  (i * j).store(out.int_multiply);
  (i & j).store(out.int_and);
  (i | j).store(out.int_or);
  min(i, j).store(out.int_min);
  max(i, j).store(out.int_max);
  to_int(a).store(out.to_int);
  shift_left<5>(i).store(out.left_5);
  shift_right<5>(i).store(out.right_5);
  shift_right_signed<5>(i).store(out.right_signed_5);
  shift_left<0>(i).store(out.left_0);
  shift_left<31>(i).store(out.left_31);
  select(mask, i, j).store(out.int_select);
  gather(in.words, index, mask).store(out.int_gather);
  Int::iota().store(out.int_iota);
  Int::load(in.i, in.count).store(out.int_load_partial);
  j.store(out.int_store_masked);
  i.store(out.int_store_masked, mask);

  out.less = less.bits();
  out.less_equal = (a <= b).bits();
  out.greater = (a > b).bits();
  out.greater_equal = (a >= b).bits();
  out.equal = (a == b).bits();
  out.not_equal = (a != b).bits();
  out.int_less = (i < j).bits();
  out.int_greater = (i > j).bits();
  out.int_equal = (i == j).bits();
  out.int_not_equal = (i != j).bits();
  out.mask_and = (mask & less).bits();
  out.mask_or = (mask | less).bits();
  out.mask_not = (~mask).bits();
  out.mask_first = Mask::first(in.count).bits();
  out.mask_count = count(mask);
  out.mask_any = any(mask);
  out.mask_all = all(mask);
  out.mask_none = none(mask);
  out.reduced = reduce_add(a);
  if (in.edge != nullptr) {
    const Float numbers = Float::load(in.edge, in.count);
    (numbers + numbers).store(in.edge, Mask::first(in.count));
  }
}

}  // namespace kintsugi::mapper::testing
