#include "mapper/core/simd/pack_avx2.hpp"
#include "tests/mapper/core/simd/pack_operations.hpp"

namespace kintsugi::mapper::testing {

void run_pack_operations_avx2(const PackInput& input, PackOutput& output) {
  run_pack_operations<Avx2Pack>(input, output);
}

}  // namespace kintsugi::mapper::testing
