#include "mapper/core/guests/guests.hpp"

#include <iterator>
#include <utility>

namespace kintsugi::mapper {

void Guests::add(KeyframeMessage keyframe) {
  const Guest begun{keyframe.map_name, GuestMap(resolution_m_)};
  guests_.try_emplace(keyframe.session, begun).first->second.map.add(std::move(keyframe));
}

void Guests::add(CloudSlice slice) {
  const auto guest = guests_.find(slice.session);
  if (guest != guests_.end()) guest->second.map.add(std::move(slice));
}

std::vector<GuestPatch> Guests::take_in(LoopClosure& loops, std::int64_t utime,
                                        std::size_t max_waiting) {
  std::vector<GuestPatch> patches;
  for (auto& [session, guest] : guests_) {
    std::vector<GuestPatch> of_guest = guest.map.take_in(loops, utime, max_waiting);
    std::move(of_guest.begin(), of_guest.end(), std::back_inserter(patches));
  }
  num_patches_ += static_cast<std::int64_t>(patches.size());
  return patches;
}

std::vector<GuestReport> Guests::reports() const {
  std::vector<GuestReport> reports;
  reports.reserve(guests_.size());
  for (const auto& [session, guest] : guests_) {
    reports.push_back({session, guest.map_name, guest.map.num_keyframes(), guest.map.problem()});
  }
  return reports;
}

}  // namespace kintsugi::mapper
