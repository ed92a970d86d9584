#include "mapper/process/fusion_pace.hpp"

namespace kintsugi::mapper {
namespace {

/// One may come while a frame is mapped in time.
constexpr std::size_t kMaxWaitingInTime = 1;

}  // namespace

bool FusionPace::fuses(std::size_t num_waiting) {
  const bool in_time = num_waiting <= kMaxWaitingInTime;
  if (in_time || num_left_out_ >= num_waiting) {
    num_left_out_ = 0;
    return true;
  }
  ++num_left_out_;
  return false;
}

}  // namespace kintsugi::mapper
