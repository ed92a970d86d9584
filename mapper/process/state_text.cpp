#include "mapper/process/state_text.hpp"

namespace kintsugi::mapper {

std::string_view reason_text(const TrackingResult& tracking) {
  if (tracking.state != TrackingState::kLost) return "";
  // Without a reason it was not registered: poses are given, and there is none for this frame.
  return tracking.loss_reason ? to_string(*tracking.loss_reason) : "no given pose within 20 ms";
}

std::string_view first_reason_text(const TrackingResult& tracking) {
  return tracking.first_loss_reason ? to_string(*tracking.first_loss_reason) : "";
}

}  // namespace kintsugi::mapper
