#include "mapper/core/simd/pack_portable.hpp"
#include "tests/mapper/core/simd/pack_operations.hpp"

namespace kintsugi::mapper::testing {

void run_pack_operations_portable(const PackInput& input, PackOutput& output) {
  run_pack_operations<PortablePack>(input, output);
}

}  // namespace kintsugi::mapper::testing
