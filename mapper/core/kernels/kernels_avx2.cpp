// The kernels compiled with -mavx2.

#include "mapper/core/kernels/integration_kernel.hpp"
#include "mapper/core/kernels/kernels.hpp"
#include "mapper/core/kernels/pack_avx2.hpp"

namespace kintsugi::mapper {

const Kernels kAvx2Kernels = {
    .integrate_block = integrate_block<Avx2Pack>,
};

}  // namespace kintsugi::mapper
