#include "segmenter/objects/recognition/pose_search.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "segmenter/objects/model/shortest_rotation.hpp"
#include "segmenter/objects/recognition/pose_refinement.hpp"

namespace kintsugi::segmenter {

namespace {

// Enough for stable shares: the standard deviation of a share of 100 samples is at most 5 %.
constexpr std::size_t kVotersSeen = 60;
constexpr std::size_t kVotersOfModel = 150;
constexpr std::size_t kRefined = 8;    // hypotheses that are refined
constexpr float kLeastRough = 0.4F;    // agreement of those that are refined further
constexpr std::size_t kSamples = 150;  // points by which hypotheses are compared
// Below, noise of the normal is most of its direction around the vertical: sine of 60 degrees.
constexpr float kUpright = 0.87F;
// Of the direction around the vertical: normals of a rough or worn face vary as much.
constexpr float kTurnTolerance_rad = 0.26F;  // 15 degrees
// The rim of a model moves by one cell from one turn to the next.
constexpr float kCellsInRadius = 8.0F;

/// Votes for translations of a model that has a given rotation.
class TranslationVotes {
 public:
  TranslationVotes(const Eigen::AlignedBox3f& box, float cell_m)
      : low_(box.min()),
        cell_m_(cell_m),
        size_((box.sizes() / cell_m).array().ceil().max(1.0F).matrix().cast<int>()),
        votes_(static_cast<std::size_t>(size_.x()) * size_.y() * size_.z(), 0) {}

  void clear() {
    std::fill(votes_.begin(), votes_.end(), 0);
    best_ = 0;
    most_ = 0;
  }

  void add(const Eigen::Vector3f& t) {
    const Eigen::Vector3f cell = (t - low_) / cell_m_;
    if (cell.minCoeff() < 0.0F) return;
    const Eigen::Vector3i at = cell.cast<int>();
    if ((at.array() >= size_.array()).any()) return;
    const std::size_t i =
        (static_cast<std::size_t>(at.z()) * size_.y() + at.y()) * size_.x() + at.x();
    const int votes = ++votes_[i];
    if (votes > most_ || (votes == most_ && i < best_)) {
      most_ = votes;
      best_ = i;
    }
  }

  /// The cell with most votes, the first one of several, and how many it has.
  [[nodiscard]] std::pair<Eigen::Vector3f, int> best() const {
    auto rest = static_cast<int>(best_);
    Eigen::Vector3i cell;
    cell.x() = rest % size_.x();
    rest /= size_.x();
    cell.y() = rest % size_.y();
    cell.z() = rest / size_.y();
    return {low_ + (cell.cast<float>().array() + 0.5F).matrix() * cell_m_, most_};
  }

 private:
  Eigen::Vector3f low_;
  float cell_m_;
  Eigen::Vector3i size_;
  std::vector<std::uint16_t> votes_;
  std::size_t best_ = 0;  // cell with most votes
  int most_ = 0;
};

struct Vote {
  Pose X_WO;
  int votes = 0;
};

/// A seen and a model point that may be the same: like colours, and normals that a turn about the
/// vertical can bring together.
struct Pair {
  Eigen::Vector3f position_O;
  Eigen::Vector3f position_U;  ///< U: W turned so that its z is up
};

bool may_be_same(const SurfacePoint& o, const SurfacePoint& u) {
  const float horizontal =
      std::hypot(o.normal.x(), o.normal.y()) * std::hypot(u.normal.x(), u.normal.y());
  if (o.normal.z() * u.normal.z() + horizontal < kSameNormal) return false;
  // Twice as far as colours of one thing may be: what the light changes is not known yet.
  return !o.has_color || !u.has_color ||
         (o.lab - u.lab).squaredNorm() <= 4 * kSameColor * kSameColor;
}

/// The pairs that speak for each turn: normals that are not upright tell it.
struct PairsOfTurns {
  std::vector<std::vector<Pair>> by_turn;
  std::vector<Pair> of_all_turns;
};

PairsOfTurns pairs_of_turns(const Surface& voters_O, const Surface& voters_U, int turns) {
  PairsOfTurns result{.by_turn = std::vector<std::vector<Pair>>(static_cast<std::size_t>(turns)),
                      .of_all_turns = {}};
  const float turn_rad = 2 * std::numbers::pi_v<float> / static_cast<float>(turns);
  const auto azimuth = [](const SurfacePoint& point) {
    return std::atan2(point.normal.y(), point.normal.x());
  };
  const auto is_upright = [](const SurfacePoint& point) {
    return std::abs(point.normal.z()) > kUpright;
  };
  std::vector<float> azimuths_U;
  azimuths_U.reserve(voters_U.size());
  for (const SurfacePoint& u : voters_U) azimuths_U.push_back(azimuth(u));
  const int around = static_cast<int>(std::ceil(kTurnTolerance_rad / turn_rad));
  for (const SurfacePoint& o : voters_O) {
    const float azimuth_O = azimuth(o);
    for (std::size_t i = 0; i < voters_U.size(); ++i) {
      const SurfacePoint& u = voters_U[i];
      if (!may_be_same(o, u)) continue;
      const Pair pair{o.position, u.position};
      if (is_upright(o) || is_upright(u)) {
        result.of_all_turns.push_back(pair);
        continue;
      }
      const int middle =
          static_cast<int>(std::lround((azimuths_U[i] - azimuth_O) / turn_rad)) + 2 * turns;
      for (int turn = middle - around; turn <= middle + around; ++turn) {
        result.by_turn[static_cast<std::size_t>(turn % turns)].push_back(pair);
      }
    }
  }
  return result;
}

/// Where O's origin may be in U if the object has half of the points or more.
Eigen::AlignedBox3f origins_of(const Surface& surface_O, const Surface& voters_U, float cell_m) {
  Eigen::Vector3f low_U;
  Eigen::Vector3f high_U;
  std::vector<float> values(voters_U.size());
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = voters_U[i].position[axis];
    std::sort(values.begin(), values.end());
    low_U[axis] = values[values.size() / 4];
    high_U[axis] = values[values.size() - 1 - values.size() / 4];
  }
  float radius_m = 0.0F;  // about the vertical through O's origin
  float bottom_m = 0.0F;
  float top_m = 0.0F;
  for (const SurfacePoint& point : surface_O) {
    radius_m = std::max(radius_m, point.position.head<2>().norm());
    bottom_m = std::min(bottom_m, point.position.z());
    top_m = std::max(top_m, point.position.z());
  }
  const Eigen::Vector3f slack = Eigen::Vector3f::Constant(2 * cell_m);
  const Eigen::Vector3f first = high_U - Eigen::Vector3f(radius_m, radius_m, top_m) - slack;
  const Eigen::Vector3f last = low_U + Eigen::Vector3f(radius_m, radius_m, -bottom_m) + slack;
  return {first.cwiseMin(last), first.cwiseMax(last)};
}

std::vector<Vote> votes_for_turns(const PreparedModel& model, const Surface& seen_W,
                                  const Eigen::Vector3d& up_W) {
  Pose X_UW = Pose::Identity();
  X_UW.linear() = shortest_rotation(up_W, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Surface voters_U = transformed(every_few(seen_W, kVotersSeen), X_UW);
  const Surface voters_O = every_few(model.surface_O, kVotersOfModel);
  const float cell_m = std::max(2 * model.spacing_m, model.radius_m / kCellsInRadius);
  const int turns = std::max(
      8, static_cast<int>(std::ceil(2 * std::numbers::pi_v<float> * model.radius_m / cell_m)));
  TranslationVotes accumulator(origins_of(voters_O, voters_U, cell_m), cell_m);
  std::vector<Vote> votes;
  votes.reserve(static_cast<std::size_t>(turns));
  int turn = 0;
  const PairsOfTurns all_pairs = pairs_of_turns(voters_O, voters_U, turns);
  for (const std::vector<Pair>& pairs : all_pairs.by_turn) {
    const Eigen::Matrix3d R_UO =
        Eigen::AngleAxisd(2 * std::numbers::pi * turn++ / turns, Eigen::Vector3d::UnitZ())
            .toRotationMatrix();
    const Eigen::Matrix3f R = R_UO.cast<float>();
    accumulator.clear();
    for (const std::vector<Pair>* const some : {&pairs, &all_pairs.of_all_turns}) {
      for (const Pair& pair : *some) accumulator.add(pair.position_U - R * pair.position_O);
    }
    const auto [t_U, count] = accumulator.best();
    if (count == 0) continue;
    Pose X_UO = Pose::Identity();
    X_UO.linear() = R_UO;
    X_UO.translation() = t_U.cast<double>();
    votes.push_back({X_UW.inverse() * X_UO, count});
  }
  std::stable_sort(votes.begin(), votes.end(),
                   [](const Vote& a, const Vote& b) { return a.votes > b.votes; });
  return votes;
}

/// Alike: no point of the object is more than two spacings from where it is in the other pose.
bool are_alike(const Pose& a, const Pose& b, const PreparedModel& model) {
  const double shift = (a.translation() - b.translation()).norm();
  const double turn = Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
  return shift + turn * model.radius_m < 2.0 * model.spacing_m;
}

std::vector<PoseHypothesis> best_of(std::vector<PoseHypothesis> hypotheses,
                                    const PreparedModel& model, std::size_t count) {
  std::stable_sort(
      hypotheses.begin(), hypotheses.end(),
      [](const PoseHypothesis& a, const PoseHypothesis& b) { return a.agreement > b.agreement; });
  std::vector<PoseHypothesis> best;
  best.reserve(count);
  for (const PoseHypothesis& hypothesis : hypotheses) {
    const bool is_new = std::none_of(best.begin(), best.end(), [&](const PoseHypothesis& other) {
      return are_alike(hypothesis.X_WO, other.X_WO, model);
    });
    if (is_new) best.push_back(hypothesis);
    if (best.size() == count) break;
  }
  return best;
}

}  // namespace

std::vector<PoseHypothesis> upright_poses(const PreparedModel& model, const Surface& seen_W,
                                          const Eigen::Vector3d& up_W, std::size_t count) {
  if (model.surface_O.empty() || seen_W.empty()) return {};
  const std::vector<Vote> votes = votes_for_turns(model, seen_W, up_W);
  const Surface samples_W = every_few(seen_W, kSamples);
  const std::size_t tried = std::min(kRefined, votes.size());
  std::vector<PoseHypothesis> rough;
  rough.reserve(tried);
  for (std::size_t i = 0; i < tried; ++i) {
    rough.push_back(roughly_refined_pose(model, samples_W, votes[i].X_WO));
  }
  std::erase_if(rough, [](const PoseHypothesis& pose) { return pose.agreement < kLeastRough; });
  std::vector<PoseHypothesis> poses = best_of(std::move(rough), model, count);
  for (PoseHypothesis& pose : poses) pose = finely_refined_pose(model, samples_W, pose.X_WO);
  return best_of(std::move(poses), model, count);
}

}  // namespace kintsugi::segmenter
