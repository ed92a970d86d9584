// The kernels for any processor.

#include "mapper/core/kernels/kernels.hpp"
#include "mapper/core/simd/allocation_kernel.hpp"
#include "mapper/core/simd/block_sides_kernel.hpp"
#include "mapper/core/simd/integration_kernel.hpp"
#include "mapper/core/simd/linearization_kernel.hpp"
#include "mapper/core/simd/pack_portable.hpp"
#include "mapper/core/simd/photometry_kernel.hpp"
#include "mapper/core/simd/raycast_kernel.hpp"
#include "mapper/core/simd/surface_kernel.hpp"

namespace kintsugi::mapper {

const Kernels kPortableKernels = {
    .find_missing_blocks = find_missing_blocks<PortablePack>,
    .find_block_sides = find_block_sides<PortablePack>,
    .integrate_block = integrate_block<PortablePack>,
    .linearize_rows = linearize_rows<PortablePack>,
    .sum_photometry_rows = sum_photometry_rows<PortablePack>,
    .smooth_depth_row = SurfaceRows<PortablePack>::smooth_depth,
    .halve_depth_row = SurfaceRows<PortablePack>::halve_depth,
    .normals_row = SurfaceRows<PortablePack>::normals,
    .halve_surface_row = SurfaceRows<PortablePack>::halve_surface,
    .count_in_box = SurfaceRows<PortablePack>::count_in_box,
    .raycast_tile = raycast_tile<PortablePack>,
};

}  // namespace kintsugi::mapper
