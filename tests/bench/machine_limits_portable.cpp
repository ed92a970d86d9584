#include "mapper/core/simd/pack_portable.hpp"
#include "tests/bench/machine_limits.hpp"

namespace kintsugi::mapper::bench {

const MachineLimits kPortableLimits = {
    .calculate = MachineLoops<PortablePack>::calculate,
    .read = MachineLoops<PortablePack>::read,
    .read_scattered = MachineLoops<PortablePack>::read_scattered,
};

}  // namespace kintsugi::mapper::bench
