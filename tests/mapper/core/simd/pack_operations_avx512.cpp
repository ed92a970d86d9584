#include "mapper/core/simd/pack_avx512.hpp"
#include "tests/mapper/core/simd/pack_operations.hpp"

namespace kintsugi::mapper::testing {

void run_pack_operations_avx512(const PackInput& input, PackOutput& output) {
  run_pack_operations<Avx512Pack>(input, output);
}

}  // namespace kintsugi::mapper::testing
