#include "mapper/core/simd/pack_avx512.hpp"
#include "tests/bench/machine_limits.hpp"

namespace kintsugi::mapper::bench {

const MachineLimits kAvx512Limits = {
    .calculate = MachineLoops<Avx512Pack>::calculate,
    .read = MachineLoops<Avx512Pack>::read,
    .read_scattered = MachineLoops<Avx512Pack>::read_scattered,
};

}  // namespace kintsugi::mapper::bench
