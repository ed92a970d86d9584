// Upper limits of this machine, with one and two threads, by CPU time: arithmetic, sequential reads
// and gathers. Fusion and raycast can be compared with them.
//
//   build/release/bench/bench_machine

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "mapper/core/kernels/instruction_set.hpp"
#include "tests/bench/machine_limits.hpp"

namespace kintsugi::mapper::bench {
namespace {

const MachineLimits& limits_of(InstructionSet instruction_set) {
#ifdef KINTSUGI_X86_KERNELS
  if (instruction_set == InstructionSet::kAvx2) return kAvx2Limits;
  if (instruction_set == InstructionSet::kAvx512) return kAvx512Limits;
#endif
  static_cast<void>(instruction_set);
  return kPortableLimits;
}

void for_each_path(benchmark::internal::Benchmark* benchmark, const std::vector<std::int64_t>& kb) {
  for (const InstructionSet instruction_set : kInstructionSets) {
    if (!is_supported(instruction_set)) continue;
    for (const std::int64_t size : kb) {
      benchmark->Args({static_cast<int>(instruction_set), size});
    }
  }
  benchmark->ArgNames({"instruction_set", "kB"})->Threads(1)->Threads(2);
}

const MachineLimits& limits_of(benchmark::State& state) {
  const auto instruction_set = static_cast<InstructionSet>(state.range(0));
  state.SetLabel(std::string(name_of(instruction_set)));
  return limits_of(instruction_set);
}

std::size_t words_of(const benchmark::State& state) {
  return static_cast<std::size_t>(state.range(1)) * 256;
}

void calculate(benchmark::State& state) {
  constexpr std::size_t kRounds = 10'000;
  const MachineLimits& limits = limits_of(state);
  for (auto _ : state) benchmark::DoNotOptimize(limits.calculate(kRounds));
  state.counters["operations"] = benchmark::Counter(2.0 * 16 * MachineLimits::kNumChains * kRounds,
                                                    benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(calculate)->Apply([](auto* benchmark) { for_each_path(benchmark, {0}); });

void read(benchmark::State& state) {
  const MachineLimits& limits = limits_of(state);
  const std::vector<float> numbers(words_of(state), 1.0F);
  for (auto _ : state) benchmark::DoNotOptimize(limits.read(numbers.data(), numbers.size()));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(4 * numbers.size()));
}
// Sizes that fit into the first, second and third cache, and one that does not.
BENCHMARK(read)->Apply([](auto* benchmark) { for_each_path(benchmark, {16, 512, 8192, 262144}); });

void read_scattered(benchmark::State& state) {
  constexpr std::size_t kGathers = 100'000;
  const MachineLimits& limits = limits_of(state);
  const std::vector<std::int32_t> words(words_of(state), 1);
  for (auto _ : state) {
    benchmark::DoNotOptimize(limits.read_scattered(words.data(), words.size(), kGathers));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kGathers));
}
BENCHMARK(read_scattered)->Apply([](auto* benchmark) {
  for_each_path(benchmark, {16, 512, 8192, 262144});
});

}  // namespace
}  // namespace kintsugi::mapper::bench
