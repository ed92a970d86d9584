// The kernels compiled with -mavx512f -mavx512bw -mavx512dq -mavx512vl.

#include "mapper/core/kernels/kernels.hpp"
#include "mapper/core/simd/allocation_kernel.hpp"
#include "mapper/core/simd/block_sides_kernel.hpp"
#include "mapper/core/simd/integration_kernel.hpp"
#include "mapper/core/simd/linearization_kernel.hpp"
#include "mapper/core/simd/pack_avx512.hpp"
#include "mapper/core/simd/photometry_kernel.hpp"
#include "mapper/core/simd/raycast_kernel.hpp"
#include "mapper/core/simd/surface_kernel.hpp"

namespace kintsugi::mapper {

const Kernels kAvx512Kernels = {
    .find_missing_blocks = find_missing_blocks<Avx512Pack>,
    .find_block_sides = find_block_sides<Avx512Pack>,
    .integrate_block = integrate_block<Avx512Pack>,
    .linearize_rows = linearize_rows<Avx512Pack>,
    .sum_photometry_rows = sum_photometry_rows<Avx512Pack>,
    .smooth_depth_row = SurfaceRows<Avx512Pack>::smooth_depth,
    .halve_depth_row = SurfaceRows<Avx512Pack>::halve_depth,
    .normals_row = SurfaceRows<Avx512Pack>::normals,
    .halve_surface_row = SurfaceRows<Avx512Pack>::halve_surface,
    .count_in_box = SurfaceRows<Avx512Pack>::count_in_box,
    .raycast_tile = raycast_tile<Avx512Pack>,
};

}  // namespace kintsugi::mapper
