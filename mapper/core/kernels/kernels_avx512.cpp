// The kernels compiled with -mavx512f -mavx512bw -mavx512dq -mavx512vl.

#include "mapper/core/kernels/integration_kernel.hpp"
#include "mapper/core/kernels/kernels.hpp"
#include "mapper/core/kernels/pack_avx512.hpp"

namespace kintsugi::mapper {

const Kernels kAvx512Kernels = {
    .integrate_block = integrate_block<Avx512Pack>,
};

}  // namespace kintsugi::mapper
