#pragma once
// Corrections of the map, as every receiver applies them.

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi {

/// Points of a patch from its frame P to W: R p + t in double precision, rounded to float; normals
/// R n likewise. The identity leaves the bits as they are.
std::vector<CloudPoint> moved(std::span<const CloudPoint> points_P, const PatchPose& X_WP);

/// A pose of a patch, the number of the correction as of which it holds, and the part of the map
/// that the patch is in there.
struct PatchPlace {
  PatchPose X_WP;
  std::int32_t correction = 0;  ///< 0: none
  std::int32_t part = 0;        ///< CloudSlice::part

  bool operator==(const PatchPlace&) const = default;
};

/// A patch, and where a correction puts it.
struct PlacedPatch {
  std::int32_t id = 0;
  PatchPlace place;

  bool operator==(const PlacedPatch&) const = default;
};

/// The newest place that corrections have given each patch, and the rule which pose counts: of the
/// corrections that name a patch and of the header of its newest revision, the one with the highest
/// number of corrections. So the place of a patch depends neither on the order of arrival nor on
/// what was lost before.
class PatchMotions {
 public:
  /// Takes the motions of `correction`; slices of other kinds have none. Returns those patches for
  /// which this is newer than what earlier calls gave: the ones that may be moved.
  std::vector<PlacedPatch> learn(const CloudSlice& correction);
  /// Takes a place that places() once had.
  void learn(std::int32_t patch_id, const PatchPlace& place);

  /// Where the points of a slice are: of a patch what its header says, or a newer correction; other
  /// slices are in W and stay in their part.
  [[nodiscard]] PatchPlace place_of(const CloudSlice& slice) const;

  /// Of each patch that a correction has named, by id.
  [[nodiscard]] const std::map<std::int32_t, PatchPlace>& places() const { return places_; }

 private:
  std::map<std::int32_t, PatchPlace> places_;
};

/// Of slices that were read together: moves the points of each patch to where all corrections among
/// them put it, and into that part of the map. Their frames P are W then.
void apply_corrections(std::span<CloudSlice* const> slices);

}  // namespace kintsugi
