#pragma once
// The inner loops that run in vector registers, one set of them for each instruction set. All give
// the same bytes; see pack_portable.hpp for how they are written.

#include "mapper/core/kernels/allocation.hpp"
#include "mapper/core/kernels/integration.hpp"
#include "mapper/core/kernels/linearization.hpp"
#include "mapper/core/kernels/raycast.hpp"
#include "mapper/core/kernels/surface.hpp"

namespace kintsugi::mapper {

enum class InstructionSet;

struct Kernels {
  FindMissingBlocks find_missing_blocks = nullptr;
  IntegrateBlock integrate_block = nullptr;
  LinearizeRows linearize_rows = nullptr;
  HalveDepthRow halve_depth_row = nullptr;
  NormalsRow normals_row = nullptr;
  HalveSurfaceRow halve_surface_row = nullptr;
  CountInBox count_in_box = nullptr;
  RaycastTileFunction raycast_tile = nullptr;
};

/// @throws std::invalid_argument where is_supported(instruction_set) is false
const Kernels& kernels_for(InstructionSet instruction_set);

/// Those for best_instruction_set(), which is asked once.
const Kernels& best_kernels();

// Each in the source compiled for it; those for x86 only where this build has them.
extern const Kernels kPortableKernels;
extern const Kernels kAvx2Kernels;
extern const Kernels kAvx512Kernels;

}  // namespace kintsugi::mapper
