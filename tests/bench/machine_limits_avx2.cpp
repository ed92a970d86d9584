#include "mapper/core/simd/pack_avx2.hpp"
#include "tests/bench/machine_limits.hpp"

namespace kintsugi::mapper::bench {

const MachineLimits kAvx2Limits = {
    .calculate = MachineLoops<Avx2Pack>::calculate,
    .read = MachineLoops<Avx2Pack>::read,
    .read_scattered = MachineLoops<Avx2Pack>::read_scattered,
};

}  // namespace kintsugi::mapper::bench
