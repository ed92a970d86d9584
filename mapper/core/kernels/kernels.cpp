#include "mapper/core/kernels/kernels.hpp"

#include <string>

#include "lcmtypes/base/argument_check.hpp"
#include "mapper/core/kernels/instruction_set.hpp"

namespace kintsugi::mapper {

const Kernels& kernels_for(InstructionSet instruction_set) {
  require(is_supported(instruction_set), "instruction_set is " +
                                             std::string(name_of(instruction_set)) +
                                             ", which this processor or this build does not have");
#ifdef KINTSUGI_X86_KERNELS
  if (instruction_set == InstructionSet::kAvx2) return kAvx2Kernels;
  if (instruction_set == InstructionSet::kAvx512) return kAvx512Kernels;
#endif
  return kPortableKernels;
}

const Kernels& best_kernels() {
  static const Kernels& best = kernels_for(best_instruction_set());
  return best;
}

}  // namespace kintsugi::mapper
