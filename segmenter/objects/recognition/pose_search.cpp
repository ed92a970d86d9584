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

  /// In cells: add() is called often with differences of the same few points.
  [[nodiscard]] Eigen::Vector3f cells(const Eigen::Vector3f& vector) const {
    return vector / cell_m_;
  }

  /// @param cell what cells() tells of the translation from the lower corner of the box
  void add(const Eigen::Vector3f& cell) {
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

  [[nodiscard]] const Eigen::Vector3f& low() const { return low_; }

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

/// A point of the model or of what is seen, with what its normal tells about turns about the
/// vertical.
struct Voter {
  explicit Voter(const SurfacePoint& point)
      : position(point.position),
        lab(point.lab),
        has_color(point.has_color),
        normal_up(point.normal.z()),
        normal_across(std::hypot(point.normal.x(), point.normal.y())),
        azimuth_rad(std::atan2(point.normal.y(), point.normal.x())) {}

  [[nodiscard]] bool is_upright() const { return std::abs(normal_up) > kUpright; }

  Eigen::Vector3f position;
  Eigen::Vector3f lab;
  bool has_color;
  float normal_up;
  float normal_across;
  float azimuth_rad;
};

using Voters = std::vector<Voter>;

/// Like colours, and normals that a turn about the vertical can bring together.
bool may_be_same(const Voter& o, const Voter& u) {
  if (o.normal_up * u.normal_up + o.normal_across * u.normal_across < kSameNormal) return false;
  // Twice as far as colours of one thing may be: what the light changes is not known yet.
  return !o.has_color || !u.has_color ||
         (o.lab - u.lab).squaredNorm() <= 4 * kSameColor * kSameColor;
}

/// A model and a seen point that may be the same.
struct Pair {
  std::uint16_t o = 0;
  std::uint16_t u = 0;
};
static_assert(kVotersOfModel < UINT16_MAX && kVotersSeen < UINT16_MAX);

using Pairs = std::vector<Pair>;

/// The pairs that speak for each turn: normals that are not upright tell it.
struct PairsOfTurns {
  std::vector<Pairs> by_turn;  ///< each pair once, at the turn that brings its normals together
  int around = 0;              ///< it speaks for so many turns to each side, too
  Pairs of_all_turns;
};

PairsOfTurns pairs_of_turns(const Voters& voters_O, const Voters& voters_U, int turns) {
  const float turn_rad = 2 * std::numbers::pi_v<float> / static_cast<float>(turns);
  PairsOfTurns result{.by_turn = std::vector<Pairs>(static_cast<std::size_t>(turns)),
                      .around = static_cast<int>(std::ceil(kTurnTolerance_rad / turn_rad)),
                      .of_all_turns = {}};
  for (std::size_t i = 0; i < voters_O.size(); ++i) {
    const Voter& o = voters_O[i];
    for (std::size_t k = 0; k < voters_U.size(); ++k) {
      const Voter& u = voters_U[k];
      if (!may_be_same(o, u)) continue;
      const Pair pair{static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(k)};
      if (o.is_upright() || u.is_upright()) {
        result.of_all_turns.push_back(pair);
        continue;
      }
      const int turn =
          static_cast<int>(std::lround((u.azimuth_rad - o.azimuth_rad) / turn_rad)) + 2 * turns;
      result.by_turn[static_cast<std::size_t>(turn % turns)].push_back(pair);
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
  const Surface seen_U = transformed(every_few(seen_W, kVotersSeen), X_UW);
  const Surface some_O = every_few(model.surface_O, kVotersOfModel);
  const float cell_m = std::max(2 * model.spacing_m, model.radius_m / kCellsInRadius);
  const int turns = std::max(
      8, static_cast<int>(std::ceil(2 * std::numbers::pi_v<float> * model.radius_m / cell_m)));
  TranslationVotes accumulator(origins_of(some_O, seen_U, cell_m), cell_m);
  const Voters voters_O(some_O.begin(), some_O.end());
  const Voters voters_U(seen_U.begin(), seen_U.end());
  const PairsOfTurns pairs = pairs_of_turns(voters_O, voters_U, turns);
  std::vector<Eigen::Vector3f> cells_U;
  cells_U.reserve(voters_U.size());
  for (const Voter& u : voters_U) {
    cells_U.push_back(accumulator.cells(u.position - accumulator.low()));
  }
  std::vector<Eigen::Vector3f> cells_O(voters_O.size());  // turned
  const auto vote_for = [&](const Pairs& some) {
    for (const Pair& pair : some) accumulator.add(cells_U[pair.u] - cells_O[pair.o]);
  };
  std::vector<Vote> votes;
  votes.reserve(static_cast<std::size_t>(turns));
  for (int turn = 0; turn < turns; ++turn) {
    const Eigen::Matrix3d R_UO =
        Eigen::AngleAxisd(2 * std::numbers::pi * turn / turns, Eigen::Vector3d::UnitZ())
            .toRotationMatrix();
    const Eigen::Matrix3f R = R_UO.cast<float>();
    std::ranges::transform(voters_O, cells_O.begin(),
                           [&](const Voter& o) { return accumulator.cells(R * o.position); });
    accumulator.clear();
    vote_for(pairs.of_all_turns);
    for (int other = turn - pairs.around; other <= turn + pairs.around; ++other) {
      vote_for(pairs.by_turn[static_cast<std::size_t>((other + 2 * turns) % turns)]);
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
