#include "mapper/core/loop_closure/keyframe_graph.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>

#include "lcmtypes/base/argument_check.hpp"
#include "mapper/core/registration/motion_size.hpp"

namespace kintsugi::mapper {
namespace {

/// Registrations have errors that are alike for all pixels, and so not in their information: of the
/// surfaces that voxels describe.
constexpr double kSurfaceError_vox = 0.25;

/// A further error, independent in each direction, m and rad.
Matrix6d with_error(const Matrix6d& information, double sigma) {
  // (S^-1 + sigma^2 I)^-1, also where the information is not of full rank
  const Matrix6d sum =
      (Matrix6d::Identity() + sigma * sigma * information).partialPivLu().solve(information);
  return 0.5 * (sum + sum.transpose());  // symmetric but for rounding
}

}  // namespace

void KeyframeGraph::Config::validate() const {
  check_range("near_m", near_m, 0.0, 1e6);
  check_range("max_drift_share", max_drift_share, 0.0, 1.0);
  check_range("voxel_m", voxel_m, 1e-4, 1.0);
  optimizer.validate();
}

KeyframeGraph::KeyframeGraph(const Config& config) : config_((config.validate(), config)) {}

void KeyframeGraph::add(const Pose& X_UK, std::optional<int> from, double way_m,
                        std::optional<UnseenWay> unseen) {
  Pose X_WU = Pose::Identity();
  int part = static_cast<int>(parts_.size());
  if (from) {
    check_number(*from);
    X_WU = X_WK_[*from] * nodes_[*from].X_UK.inverse(Eigen::Isometry);
    part = nodes_[*from].part;
  } else {
    if (unseen) check_number(unseen->before);
    parts_.push_back({.first = size(), .unseen = unseen, .joined = part});
  }
  nodes_.push_back({X_UK, part});
  ways_.add(from, way_m);
  X_WK_.push_back(X_WU * X_UK);
}

void KeyframeGraph::add_tracked(int from, int to, const Matrix6d& information_T) {
  check_number(from);
  check_number(to);
  if (from == to) throw std::invalid_argument("KeyframeGraph: a motion needs two keyframes");
  const Pose X_FT = nodes_[from].X_UK.inverse(Eigen::Isometry) * nodes_[to].X_UK;
  // Both keyframes were registered with the volume.
  tracked_.push_back({from, to, X_FT,
                      with_error(0.5 * information_T, kSurfaceError_vox * config_.voxel_m), false});
}

void KeyframeGraph::check_number(int number) const {
  if (number >= 0 && number < size()) return;
  throw std::invalid_argument("KeyframeGraph: there is no keyframe " + std::to_string(number));
}

int KeyframeGraph::offer(const Loop& loop) {
  if (part_of(loop.later) != part_of(loop.earlier)) {
    if (is_reachable(loop)) pending_.push_back(loop);
    return 0;
  }
  if (!is_plausible(loop)) return 0;
  const auto agrees = [&](const Loop& other) { return agree(loop, other); };
  int num_confirmed = 0;
  const auto found = std::stable_partition(pending_.begin(), pending_.end(),
                                           [&](const Loop& other) { return !agrees(other); });
  num_confirmed += static_cast<int>(pending_.end() - found);
  const bool is_confirmed =
      num_confirmed > 0 || std::any_of(confirmed_.begin(), confirmed_.end(), agrees);
  confirmed_.insert(confirmed_.end(), found, pending_.end());
  pending_.erase(found, pending_.end());
  (is_confirmed ? confirmed_ : pending_).push_back(loop);
  return num_confirmed + (is_confirmed ? 1 : 0);
}

bool KeyframeGraph::renew(const SharedView& view) {
  const auto [later, earlier] = later_and_earlier(view.tracked_near, view.found_by);
  // Keyframes that are near each other were tracked in one surface, and move with it.
  const Pose X_TuC = nodes_[view.tracked_near].X_UK * view.X_TC;
  const Pose X_FuC = nodes_[view.found_by].X_UK * view.X_FC;
  const Pose X_FuTu = X_FuC * X_TuC.inverse(Eigen::Isometry);
  const Pose X_EuLu = earlier == view.found_by ? X_FuTu : X_FuTu.inverse(Eigen::Isometry);
  const auto as_measured = [&](int a, int b) -> Pose {
    return nodes_[a].X_UK.inverse(Eigen::Isometry) * X_EuLu * nodes_[b].X_UK;
  };
  bool any = false;
  bool is_there = false;
  for (Loop& loop : confirmed_) {
    if (ways_.way_m(later, loop.later) > config_.near_m) continue;
    if (ways_.way_m(earlier, loop.earlier) > config_.near_m) continue;
    loop.X_EL = as_measured(loop.earlier, loop.later);
    any = true;
    is_there = is_there || (loop.later == later && loop.earlier == earlier);
  }
  if (!any || is_there) return any;
  const Matrix6d to_C =
      adjoint((later == view.found_by ? view.X_FC : view.X_TC).inverse(Eigen::Isometry));
  confirmed_.push_back({.later = later,
                        .earlier = earlier,
                        .X_EL = as_measured(earlier, later),
                        .information_L = to_C.transpose() * view.information_C * to_C,
                        .sigma_m = view.sigma_m});
  return true;
}

bool KeyframeGraph::is_plausible(const Loop& loop) const {
  const Pose X_EL = X_WK_[loop.earlier].inverse(Eigen::Isometry) * X_WK_[loop.later];
  const double drift_m = motion_size(loop.X_EL.inverse(Eigen::Isometry) * X_EL);
  return drift_m <= config_.max_drift_share * way_m(loop.later, loop.earlier) + config_.voxel_m;
}

/// On which tracking may have drifted between two keyframes: from one part to another over the
/// loops that join them. Infinite where none do.
double KeyframeGraph::way_m(int a, int b) const {
  std::vector<std::pair<int, int>> joins;
  joins.reserve(confirmed_.size());
  for (const Loop& loop : confirmed_) joins.emplace_back(loop.later, loop.earlier);
  return ways_.way_m(a, b, joins);
}

std::pair<int, int> KeyframeGraph::later_and_earlier(int a, int b) const {
  const bool a_is_later = std::pair(nodes_[a].part, a) > std::pair(nodes_[b].part, b);
  return a_is_later ? std::pair(a, b) : std::pair(b, a);
}

std::vector<Loop> KeyframeGraph::agreeing_to_join(const Loop& loop) const {
  if (part_of(loop.later) == part_of(loop.earlier) || !is_reachable(loop)) return {};
  std::vector<Loop> agreeing = {loop};
  std::set<int> supporters = {loop.later};
  std::set<int> rivals;
  for (const Loop& other : pending_) {
    if (agree(loop, other)) {
      agreeing.push_back(other);
      supporters.insert(other.later);
    } else if (are_rivals(loop, other)) {
      rivals.insert(other.later);
    }
  }
  return supporters.size() > 2 * rivals.size() ? agreeing : std::vector<Loop>();
}

void KeyframeGraph::join(const std::vector<Loop>& loops) {
  move_part(*std::ranges::min_element(loops, {}, &Loop::sigma_m));
  confirmed_.insert(confirmed_.end(), loops.begin(), loops.end());
  std::erase_if(pending_, [&](const Loop& pending) {
    return std::ranges::any_of(loops, [&](const Loop& loop) {
      return loop.later == pending.later && loop.earlier == pending.earlier;
    });
  });
}

/// Whether the camera can have gone from where it was before a part to where the loop puts the
/// beginning of that part.
bool KeyframeGraph::is_reachable(const Loop& loop) const {
  const Part& part = parts_[nodes_[loop.later].part];
  if (!part.unseen) return true;  // another camera's
  const int before = part.unseen->before;
  if (part_of(before) != part_of(loop.earlier)) return true;  // not known
  const Pose X_EB = X_WK_[loop.earlier].inverse(Eigen::Isometry) * X_WK_[before];
  const Pose X_LF = X_WK_[loop.later].inverse(Eigen::Isometry) * X_WK_[part.first];
  const double distance_m = (loop.X_EL * X_LF.translation() - X_EB.translation()).norm();
  const double tracked_m = way_m(loop.earlier, before) + way_m(part.first, loop.later);
  return distance_m <=
         part.unseen->distance_m + config_.max_drift_share * tracked_m + config_.voxel_m;
}

bool KeyframeGraph::are_rivals(const Loop& a, const Loop& b) const {
  if (part_of(a.later) != part_of(b.later) || part_of(a.earlier) != part_of(b.earlier)) {
    return false;
  }
  const Pose X_LaLb = X_WK_[a.later].inverse(Eigen::Isometry) * X_WK_[b.later];
  const Pose X_EaEb = X_WK_[a.earlier].inverse(Eigen::Isometry) * X_WK_[b.earlier];
  const Pose X_LaLb_loops = a.X_EL.inverse(Eigen::Isometry) * X_EaEb * b.X_EL;
  const double tracked_m = way_m(a.later, b.later) + way_m(a.earlier, b.earlier);
  return motion_size(X_LaLb.inverse(Eigen::Isometry) * X_LaLb_loops) >
         uncertainty_m(a, b, X_LaLb_loops) + config_.max_drift_share * tracked_m;
}

/// Moves the later of the two parts to where the loop puts it.
void KeyframeGraph::move_part(const Loop& loop) {
  const int later = part_of(loop.later);
  const int earlier = part_of(loop.earlier);
  const int moving = std::max(later, earlier);
  const Pose X_WE = X_WK_[loop.earlier];
  const Pose X_WL = X_WK_[loop.later];
  const Pose motion_W =
      moving == later
          ? Pose(X_WE * loop.X_EL * X_WL.inverse(Eigen::Isometry))
          : Pose(X_WL * loop.X_EL.inverse(Eigen::Isometry) * X_WE.inverse(Eigen::Isometry));
  for (int i = 0; i < size(); ++i) {
    if (part_of(i) == moving) X_WK_[i] = motion_W * X_WK_[i];
  }
  for (Part& part : parts_) {
    if (part.joined == moving) part.joined = std::min(later, earlier);
  }
}

bool KeyframeGraph::agree(const Loop& a, const Loop& b) const {
  if (a.later == b.later) return false;  // one view may look like another place as a whole
  if (ways_.way_m(a.later, b.later) > config_.near_m) return false;
  if (ways_.way_m(a.earlier, b.earlier) > config_.near_m) return false;
  const Pose X_LaLb_tracked = nodes_[a.later].X_UK.inverse(Eigen::Isometry) * nodes_[b.later].X_UK;
  const Pose X_EaEb = nodes_[a.earlier].X_UK.inverse(Eigen::Isometry) * nodes_[b.earlier].X_UK;
  const Pose X_LaLb = a.X_EL.inverse(Eigen::Isometry) * X_EaEb * b.X_EL;
  return motion_size(X_LaLb_tracked.inverse(Eigen::Isometry) * X_LaLb) <=
         uncertainty_m(a, b, X_LaLb);
}

/// Of the way from one later keyframe to the other over both loops, metres (and radians).
double KeyframeGraph::uncertainty_m(const Loop& a, const Loop& b, const Pose& X_LaLb) const {
  // The uncertainty of a rotation moves what is as far away as both keyframes are from each other.
  const double lever = 1.0 + X_LaLb.translation().norm();
  const double sigma_m = lever * std::hypot(a.sigma_m, b.sigma_m);
  return config_.optimizer.contradicted_sigmas * sigma_m + config_.voxel_m;
}

double KeyframeGraph::optimize() {
  while (true) {
    const OptimizedPoses optimized = kintsugi::mapper::optimize(pose_graph(), config_.optimizer);
    if (optimized.contradicted.empty()) {
      double largest_motion_m = 0.0;
      for (std::size_t i = 0; i < X_WK_.size(); ++i) {
        const Eigen::Vector3d motion = optimized.X_WN[i].translation() - X_WK_[i].translation();
        largest_motion_m = std::max(largest_motion_m, motion.norm());
      }
      X_WK_ = optimized.X_WN;
      return largest_motion_m;
    }
    const int worst = *std::max_element(
        optimized.contradicted.begin(), optimized.contradicted.end(),
        [&](int i, int j) { return optimized.error_sigmas[i] < optimized.error_sigmas[j]; });
    confirmed_.erase(confirmed_.begin() + (worst - static_cast<std::ptrdiff_t>(tracked_.size())));
    ++num_contradicted_;
  }
}

std::vector<int> KeyframeGraph::parts() const {
  std::vector<int> parts;
  parts.reserve(nodes_.size());
  for (int i = 0; i < size(); ++i) parts.push_back(part_of(i));
  return parts;
}

PoseGraph KeyframeGraph::pose_graph() const {
  PoseGraph graph{.X_WN = X_WK_, .edges = tracked_, .fixed = {}};
  for (int part = 0; part < static_cast<int>(parts_.size()); ++part) {
    if (parts_[part].joined == part) graph.fixed.push_back(parts_[part].first);
  }
  for (const Loop& loop : confirmed_) {
    // Two surfaces were compared.
    graph.edges.push_back(
        {loop.earlier, loop.later, loop.X_EL,
         with_error(loop.information_L, 2.0 * kSurfaceError_vox * config_.voxel_m), true});
  }
  return graph;
}

}  // namespace kintsugi::mapper
