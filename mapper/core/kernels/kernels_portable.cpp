// The kernels for any processor.

#include "mapper/core/kernels/allocation_kernel.hpp"
#include "mapper/core/kernels/integration_kernel.hpp"
#include "mapper/core/kernels/kernels.hpp"
#include "mapper/core/kernels/linearization_kernel.hpp"
#include "mapper/core/kernels/pack_portable.hpp"
#include "mapper/core/kernels/raycast_kernel.hpp"
#include "mapper/core/kernels/surface_kernel.hpp"

namespace kintsugi::mapper {

const Kernels kPortableKernels = {
    .find_missing_blocks = find_missing_blocks<PortablePack>,
    .integrate_block = integrate_block<PortablePack>,
    .linearize_rows = linearize_rows<PortablePack>,
    .halve_depth_row = SurfaceRows<PortablePack>::halve_depth,
    .normals_row = SurfaceRows<PortablePack>::normals,
    .halve_surface_row = SurfaceRows<PortablePack>::halve_surface,
    .count_in_box = SurfaceRows<PortablePack>::count_in_box,
    .raycast_tile = raycast_tile<PortablePack>,
};

}  // namespace kintsugi::mapper
