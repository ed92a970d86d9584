#pragma once
// One wall that several robots have seen is one surface of their map.

#include <Eigen/Core>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/messages.hpp"
#include "lcmtypes/patch_pose.hpp"
#include "mapper/core/volume/same_surface_rule.hpp"

namespace kintsugi::mapper {

/// Finds which points of patches are surface that another robot has seen better: this camera or a
/// guest.
///
/// The patch is better whose points were observed twice as often, in the mean: of those that have
/// the same power of two, that of the lower session. This camera's session counts as 0, since it
/// may observe its surface further. A point is covered where a better patch has its place: a point
/// whose normal agrees, from which it is not farther along that normal than the same surface may
/// be, nor farther to its side than the points of a surface are from each other. So what is left
/// depends on the newest points and places of all patches alone, and not on the order in which they
/// came; patches of one robot do not cover each other.
///
/// Keeps the points of all patches, 32 bytes each: those that are covered may have to come back.
class CommonSurface {
 public:
  struct Config {
    SameSurface same;  ///< its weight threshold is not used: points have that
    double resolution_m = 0.01;
    bool keeps_own = false;  ///< patches of this camera are better than all others
  };
  static constexpr std::int64_t kOwnSession = 0;
  struct Name {
    std::int64_t session = kOwnSession;  ///< of the robot whose camera saw it
    std::int32_t id = 0;                 ///< in this map
    auto operator<=>(const Name&) const = default;
  };

  explicit CommonSurface(const Config& config);

  /// The newest points of a patch. Without points there is no patch.
  void set(const Name& name, std::vector<CloudPoint> points_P, const PatchPose& X_WP);
  /// The new place of a patch, if there is one. In a correction of the map most patches move.
  void move(const Name& name, const PatchPose& X_WP);

  /// A patch without what others have better.
  struct Rest {
    Name name;
    std::vector<CloudPoint> points_P;
  };

  /// What is left of a patch.
  std::vector<CloudPoint> take(const Name& name);

  /// What is left of those patches of which this has changed since it was taken. Looks at so many
  /// of them at most, the next ones the next time, and leaves out little changes: noise alone makes
  /// points come and go, and a standard deviation of their number is its root.
  std::vector<Rest> take_changed(std::size_t max_patches);

  /// The same of all, and of the least change.
  std::vector<Rest> take_all_changed();

 private:
  struct Patch {
    Pose X_WP = Pose::Identity();
    std::vector<CloudPoint> points_P;
    Eigen::Vector3d center_P = Eigen::Vector3d::Zero();
    double radius_m = 0.0;         ///< of a ball around the points
    int observations_log2 = 0;     ///< of a point, in the mean
    std::vector<bool> is_covered;  ///< of each point, when it was taken
  };
  using Names = std::set<Name>;

  Patch* find(const Name& name);
  void forget_what_touches(const Patch& patch, std::int64_t session);
  bool touch(const Patch& a, const Patch& b) const;
  std::vector<bool> covered(const Patch& patch, std::int64_t session) const;
  Names& waiting();
  std::vector<Rest> take_changed(const Names& names, bool also_little);
  static std::vector<CloudPoint> rest(Patch& patch, std::vector<bool> is_covered);

  const bool keeps_own_;
  const double along_m_;       ///< the normal
  const double across_m_;      ///< to its side
  const double reach_m_;       ///< at most, of both
  const double least_cosine_;  ///< of the angle between normals
  std::map<std::int64_t, std::map<std::int32_t, Patch>> sessions_;
  bool has_moved_ = false;  ///< what covers any of them may have changed
  Names waiting_;           ///< the same of these
  Names differing_;         ///< a little from what was taken
  Name last_;               ///< that was looked at
};

}  // namespace kintsugi::mapper
