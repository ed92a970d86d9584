// The kernels for any processor.

#include "mapper/core/kernels/integration_kernel.hpp"
#include "mapper/core/kernels/kernels.hpp"
#include "mapper/core/kernels/pack_portable.hpp"

namespace kintsugi::mapper {

const Kernels kPortableKernels = {
    .integrate_block = integrate_block<PortablePack>,
};

}  // namespace kintsugi::mapper
