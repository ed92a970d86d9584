#pragma once
// The inner loops that run in vector registers, compiled once for each instruction set from the
// templates in simd/. All sets give the same bytes.

#include "mapper/core/kernels/allocation.hpp"
#include "mapper/core/kernels/block_sides.hpp"
#include "mapper/core/kernels/integration.hpp"
#include "mapper/core/kernels/linearization.hpp"
#include "mapper/core/kernels/photometry.hpp"
#include "mapper/core/kernels/raycast.hpp"
#include "mapper/core/kernels/surface.hpp"

namespace kintsugi::mapper {

enum class InstructionSet;

struct Kernels {
  FindMissingBlocks find_missing_blocks = nullptr;
  FindBlockSides find_block_sides = nullptr;
  IntegrateBlock integrate_block = nullptr;
  LinearizeRows linearize_rows = nullptr;
  SumPhotometryRows sum_photometry_rows = nullptr;
  SmoothDepthRow smooth_depth_row = nullptr;
  HalveDepthRow halve_depth_row = nullptr;
  NormalsRow normals_row = nullptr;
  HalveSurfaceRow halve_surface_row = nullptr;
  CountInBox count_in_box = nullptr;
  RaycastTileFunction raycast_tile = nullptr;
};

/// @throws std::invalid_argument where is_supported(instruction_set) is false
const Kernels& kernels_for(InstructionSet instruction_set);

/// The kernels for best_instruction_set(), which is determined once.
const Kernels& best_kernels();

// Defined in simd/kernels_*.cpp; those for x86 exist only where KINTSUGI_X86_KERNELS is defined.
extern const Kernels kPortableKernels;
extern const Kernels kAvx2Kernels;
extern const Kernels kAvx512Kernels;

}  // namespace kintsugi::mapper
