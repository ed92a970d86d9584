// The kernels compiled with -mavx2.

#include "mapper/core/kernels/kernels.hpp"
#include "mapper/core/simd/allocation_kernel.hpp"
#include "mapper/core/simd/block_sides_kernel.hpp"
#include "mapper/core/simd/integration_kernel.hpp"
#include "mapper/core/simd/linearization_kernel.hpp"
#include "mapper/core/simd/pack_avx2.hpp"
#include "mapper/core/simd/photometry_kernel.hpp"
#include "mapper/core/simd/raycast_kernel.hpp"
#include "mapper/core/simd/surface_kernel.hpp"

namespace kintsugi::mapper {

const Kernels kAvx2Kernels = {
    .find_missing_blocks = find_missing_blocks<Avx2Pack>,
    .find_block_sides = find_block_sides<Avx2Pack>,
    .integrate_block = integrate_block<Avx2Pack>,
    .linearize_rows = linearize_rows<Avx2Pack>,
    .sum_photometry_rows = sum_photometry_rows<Avx2Pack>,
    .smooth_depth_row = SurfaceRows<Avx2Pack>::smooth_depth,
    .halve_depth_row = SurfaceRows<Avx2Pack>::halve_depth,
    .normals_row = SurfaceRows<Avx2Pack>::normals,
    .halve_surface_row = SurfaceRows<Avx2Pack>::halve_surface,
    .count_in_box = SurfaceRows<Avx2Pack>::count_in_box,
    .raycast_tile = raycast_tile<Avx2Pack>,
};

}  // namespace kintsugi::mapper
