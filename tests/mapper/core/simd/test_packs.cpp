// Every operation of every pack against scalar code, bit by bit.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include "mapper/core/kernels/instruction_set.hpp"
#include "tests/mapper/core/simd/pack_operations.hpp"

namespace kintsugi::mapper {
namespace {

using testing::FloatLanes;
using testing::IntLanes;
using testing::PackInput;
using testing::PackOutput;

constexpr int kLanes = 16;

testing::RunPackOperations operations_of(InstructionSet instruction_set) {
#ifdef KINTSUGI_X86_KERNELS
  if (instruction_set == InstructionSet::kAvx2) return testing::run_pack_operations_avx2;
  if (instruction_set == InstructionSet::kAvx512) return testing::run_pack_operations_avx512;
#endif
  static_cast<void>(instruction_set);
  return testing::run_pack_operations_portable;
}

/// Two pages of which the second may not be touched: what ends at end() can be read, not a byte
/// more.
class GuardedPage {
 public:
  GuardedPage() {
    const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
    size_ = 2 * page;
    start_ = ::mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    end_ = static_cast<std::byte*>(start_) + page;
    ::mprotect(end_, page, PROT_NONE);
  }
  ~GuardedPage() { ::munmap(start_, size_); }
  GuardedPage(const GuardedPage&) = delete;
  GuardedPage& operator=(const GuardedPage&) = delete;
  std::byte* end() const { return end_; }

 private:
  void* start_ = nullptr;
  std::byte* end_ = nullptr;
  std::size_t size_ = 0;
};

constexpr int kTableSize = 1000;

struct Case {
  PackInput input{};
  std::vector<float> floats = std::vector<float>(kTableSize);
  std::vector<std::int32_t> words = std::vector<std::int32_t>(kTableSize);
};

/// Ordinary numbers, and those at which instructions differ: signed zeros, NaN, infinities,
/// subnormals, halves and what no word holds.
Case make_case(std::mt19937& random) {
  using Limits = std::numeric_limits<float>;
  static const float special[] = {0.0F,
                                  -0.0F,
                                  Limits::quiet_NaN(),
                                  Limits::infinity(),
                                  -Limits::infinity(),
                                  Limits::denorm_min(),
                                  0.5F,
                                  -0.5F,
                                  2147483648.0F,
                                  -2147483648.0F,
                                  2147483520.0F,
                                  -2147483904.0F,
                                  8388609.0F,
                                  -3e38F,
                                  3e38F,
                                  1e-40F};
  static const std::int32_t special_words[] = {0, 1, -1, INT32_MAX, INT32_MIN, 0xFFFF, 16777217};
  std::normal_distribution<float> normal(0.0F, 100.0F);
  const auto draw_float = [&] {
    return random() % 3 == 0 ? special[random() % std::size(special)] : normal(random);
  };
  const auto draw_word = [&] {
    return random() % 3 == 0 ? special_words[random() % std::size(special_words)]
                             : static_cast<std::int32_t>(random());
  };
  Case result;
  std::generate(result.floats.begin(), result.floats.end(), draw_float);
  std::generate(result.words.begin(), result.words.end(), draw_word);
  PackInput& in = result.input;
  in.floats = result.floats.data();
  in.words = result.words.data();
  in.mask = random() % 4 == 0 ? (random() % 2) * 0xFFFFU : random() & 0xFFFFU;
  in.count = static_cast<int>(random() % (kLanes + 1));
  for (int i = 0; i < kLanes; ++i) {
    in.a[i] = draw_float();
    in.b[i] = random() % 5 == 0 ? in.a[i] : draw_float();
    in.i[i] = draw_word();
    in.j[i] = random() % 5 == 0 ? in.i[i] : draw_word();
    const bool is_read = ((in.mask >> i) & 1U) != 0;
    in.index[i] = is_read ? static_cast<std::int32_t>(random() % kTableSize) : INT32_MIN;
  }
  return result;
}

/// Equal bits; of NaN neither the sign nor the payload is promised.
void expect_lanes(const FloatLanes& actual, const char* name,
                  const std::function<float(int)>& expected) {
  for (int i = 0; i < kLanes; ++i) {
    const float wanted = expected(i);
    if (std::isnan(wanted) && std::isnan(actual[i])) continue;
    ASSERT_EQ(std::bit_cast<std::uint32_t>(actual[i]), std::bit_cast<std::uint32_t>(wanted))
        << name << " of lane " << i << ": " << actual[i] << ", expected " << wanted;
  }
}

void expect_lanes(const IntLanes& actual, const char* name,
                  const std::function<std::int64_t(int)>& expected) {
  for (int i = 0; i < kLanes; ++i) {
    ASSERT_EQ(actual[i], static_cast<std::int32_t>(expected(i))) << name << " of lane " << i;
  }
}

void expect_mask(std::uint32_t actual, const char* name, const std::function<bool(int)>& expected) {
  for (int i = 0; i < 32; ++i) {
    ASSERT_EQ((actual >> i) & 1U, i < kLanes && expected(i) ? 1U : 0U) << name << " of lane " << i;
  }
}

std::int32_t truncated(float value) {
  return std::isnan(value) || value < -0x1p31F || value >= 0x1p31F
             ? INT32_MIN
             : static_cast<std::int32_t>(value);
}

float tree_sum(const FloatLanes& lanes) {
  std::vector<float> sums(lanes, lanes + kLanes);
  while (sums.size() > 1) {
    const std::size_t half = sums.size() / 2;
    for (std::size_t i = 0; i < half; ++i) sums[i] += sums[i + half];
    sums.resize(half);
  }
  return sums.front();
}

class Packs : public ::testing::TestWithParam<InstructionSet> {
 protected:
  void SetUp() override {
    if (!is_supported(GetParam())) GTEST_SKIP() << "not on this processor";
  }
  template <typename Check>
  void for_random_cases(Check check) {
    std::mt19937 random(4);
    for (int round = 0; round < 3000; ++round) {
      const Case c = make_case(random);
      PackOutput out;
      operations_of(GetParam())(c.input, out);
      check(c.input, out);
      if (HasFatalFailure()) FAIL() << "in round " << round;
    }
  }
};

TEST_P(Packs, CalculateWithNumbers) {
  for_random_cases([](const PackInput& in, const PackOutput& out) {
    const auto& a = in.a;
    const auto& b = in.b;
    expect_lanes(out.add, "a + b", [&](int i) { return a[i] + b[i]; });
    expect_lanes(out.subtract, "a - b", [&](int i) { return a[i] - b[i]; });
    expect_lanes(out.multiply, "a * b", [&](int i) { return a[i] * b[i]; });
    expect_lanes(out.divide, "a / b", [&](int i) { return a[i] / b[i]; });
    expect_lanes(out.min, "min", [&](int i) { return a[i] < b[i] ? a[i] : b[i]; });
    expect_lanes(out.max, "max", [&](int i) { return a[i] > b[i] ? a[i] : b[i]; });
    expect_lanes(out.sqrt, "sqrt", [&](int i) { return std::sqrt(a[i]); });
    expect_lanes(out.abs, "abs", [&](int i) { return std::abs(a[i]); });
    expect_lanes(out.floor, "floor", [&](int i) { return std::floor(a[i]); });
    expect_lanes(out.to_float, "to_float", [&](int i) { return static_cast<float>(in.i[i]); });
    expect_lanes(out.iota, "iota", [&](int i) { return static_cast<float>(i); });
    const float sum = tree_sum(a);
    EXPECT_TRUE((std::isnan(sum) && std::isnan(out.reduced)) || sum == out.reduced);
  });
}

TEST_P(Packs, CalculateWithWords) {
  for_random_cases([](const PackInput& in, const PackOutput& out) {
    const auto wide = [](std::int32_t word) { return static_cast<std::int64_t>(word); };
    const auto& a = in.i;
    const auto& b = in.j;
    expect_lanes(out.int_add, "a + b", [&](int i) { return wide(a[i]) + b[i]; });
    expect_lanes(out.int_subtract, "a - b", [&](int i) { return wide(a[i]) - b[i]; });
    expect_lanes(out.int_multiply, "a * b", [&](int i) { return wide(a[i]) * b[i]; });
    expect_lanes(out.int_and, "a & b", [&](int i) { return a[i] & b[i]; });
    expect_lanes(out.int_or, "a | b", [&](int i) { return a[i] | b[i]; });
    expect_lanes(out.int_min, "min", [&](int i) { return std::min(a[i], b[i]); });
    expect_lanes(out.int_max, "max", [&](int i) { return std::max(a[i], b[i]); });
    expect_lanes(out.to_int, "to_int", [&](int i) { return truncated(in.a[i]); });
    expect_lanes(out.left_0, "<< 0", [&](int i) { return a[i]; });
    expect_lanes(out.left_5, "<< 5", [&](int i) { return wide(a[i]) * 32; });
    expect_lanes(out.left_31, "<< 31", [&](int i) { return wide(a[i] & 1) << 31; });
    expect_lanes(out.right_5, ">> 5", [&](int i) { return (a[i] & 0xFFFFFFFFLL) >> 5; });
    expect_lanes(out.right_signed_5, "signed >> 5", [&](int i) { return wide(a[i]) >> 5; });
    expect_lanes(out.int_iota, "iota", [](int i) { return i; });
  });
}

TEST_P(Packs, CompareAndSelect) {
  for_random_cases([](const PackInput& in, const PackOutput& out) {
    const auto& a = in.a;
    const auto& b = in.b;
    const auto mask = [&](int i) { return ((in.mask >> i) & 1U) != 0; };
    expect_mask(out.less, "a < b", [&](int i) { return a[i] < b[i]; });
    expect_mask(out.less_equal, "a <= b", [&](int i) { return a[i] <= b[i]; });
    expect_mask(out.greater, "a > b", [&](int i) { return a[i] > b[i]; });
    expect_mask(out.greater_equal, "a >= b", [&](int i) { return a[i] >= b[i]; });
    expect_mask(out.equal, "a == b", [&](int i) { return a[i] == b[i]; });
    expect_mask(out.not_equal, "a != b", [&](int i) { return a[i] != b[i]; });
    expect_mask(out.int_less, "i < j", [&](int i) { return in.i[i] < in.j[i]; });
    expect_mask(out.int_greater, "i > j", [&](int i) { return in.i[i] > in.j[i]; });
    expect_mask(out.int_equal, "i == j", [&](int i) { return in.i[i] == in.j[i]; });
    expect_mask(out.int_not_equal, "i != j", [&](int i) { return in.i[i] != in.j[i]; });
    expect_mask(out.mask_and, "and", [&](int i) { return mask(i) && a[i] < b[i]; });
    expect_mask(out.mask_or, "or", [&](int i) { return mask(i) || a[i] < b[i]; });
    expect_mask(out.mask_not, "not", [&](int i) { return !mask(i); });
    expect_mask(out.mask_first, "first", [&](int i) { return i < in.count; });
    EXPECT_EQ(out.mask_count, std::popcount(in.mask));
    EXPECT_EQ(out.mask_any, in.mask != 0);
    EXPECT_EQ(out.mask_all, in.mask == 0xFFFF);
    EXPECT_EQ(out.mask_none, in.mask == 0);
    expect_lanes(out.select, "select", [&](int i) { return mask(i) ? a[i] : b[i]; });
    expect_lanes(out.int_select, "select", [&](int i) { return mask(i) ? in.i[i] : in.j[i]; });
  });
}

TEST_P(Packs, SplitPairs) {
  for_random_cases([](const PackInput& in, const PackOutput& out) {
    const auto both = [&](int i) { return i < kLanes ? in.a[i] : in.b[i - kLanes]; };
    expect_lanes(out.even_lanes, "even_lanes", [&](int i) { return both(2 * i); });
    expect_lanes(out.odd_lanes, "odd_lanes", [&](int i) { return both(2 * i + 1); });
  });
}

TEST_P(Packs, ReadAndWriteMemory) {
  for_random_cases([](const PackInput& in, const PackOutput& out) {
    const auto mask = [&](int i) { return ((in.mask >> i) & 1U) != 0; };
    expect_lanes(out.gather, "gather",
                 [&](int i) { return mask(i) ? in.floats[in.index[i]] : 0.0F; });
    expect_lanes(out.int_gather, "gather",
                 [&](int i) { return mask(i) ? in.words[in.index[i]] : 0; });
    expect_lanes(out.load_partial, "load", [&](int i) { return i < in.count ? in.a[i] : 0.0F; });
    expect_lanes(out.int_load_partial, "load", [&](int i) { return i < in.count ? in.i[i] : 0; });
    expect_lanes(out.store_masked, "store", [&](int i) { return mask(i) ? in.a[i] : in.b[i]; });
    expect_lanes(out.int_store_masked, "store", [&](int i) { return mask(i) ? in.i[i] : in.j[i]; });
  });
}

TEST_P(Packs, TouchNoMemoryBeyondACountOrAMask) {
  const GuardedPage page;
  std::mt19937 random(5);
  Case c = make_case(random);
  for (int count = 0; count <= kLanes; ++count) {
    float* numbers = reinterpret_cast<float*>(page.end()) - count;
    for (int i = 0; i < count; ++i) numbers[i] = static_cast<float>(i + 1);
    c.input.count = count;
    c.input.edge = numbers;
    PackOutput out;
    operations_of(GetParam())(c.input, out);
    for (int i = 0; i < count; ++i) EXPECT_EQ(numbers[i], 2.0F * static_cast<float>(i + 1));
  }
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, Packs, ::testing::ValuesIn(kInstructionSets),
                         [](const auto& info) { return std::string(name_of(info.param)); });

}  // namespace
}  // namespace kintsugi::mapper
