#include "segmenter/objects/recognition/pose_search.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "segmenter/objects/recognition/pose_refinement.hpp"

namespace kintsugi::segmenter {

namespace {

// Enough for stable shares: the standard deviation of a share of 100 samples is at most 5 %.
constexpr std::size_t kVotersSeen = 60;
constexpr std::size_t kVotersOfModel = 150;
constexpr std::size_t kRefined = 8;    // hypotheses that are refined
constexpr std::size_t kSamples = 150;  // points by which hypotheses are compared
// The rim of a model moves by one cell from one turn to the next.
constexpr float kCellsInRadius = 8.0F;

/// Votes for translations of a model that has a given rotation.
class TranslationVotes {
 public:
  TranslationVotes(const Eigen::Vector3f& low, const Eigen::Vector3f& high, float cell_m)
      : low_(low),
        cell_m_(cell_m),
        size_(((high - low) / cell_m).array().ceil().max(1.0F).matrix().cast<int>()),
        votes_(static_cast<std::size_t>(size_.x()) * size_.y() * size_.z(), 0) {}

  void clear() { std::fill(votes_.begin(), votes_.end(), 0); }

  void add(const Eigen::Vector3f& t) {
    const Eigen::Vector3i cell = ((t - low_) / cell_m_).cast<int>();
    if ((cell.array() < 0).any() || (cell.array() >= size_.array()).any()) return;
    ++votes_[(static_cast<std::size_t>(cell.z()) * size_.y() + cell.y()) * size_.x() + cell.x()];
  }

  /// The cell with most votes, and how many it has.
  std::pair<Eigen::Vector3f, int> best() const {
    const auto most = std::max_element(votes_.begin(), votes_.end());
    auto rest = static_cast<int>(most - votes_.begin());
    Eigen::Vector3i cell;
    cell.x() = rest % size_.x();
    rest /= size_.x();
    cell.y() = rest % size_.y();
    cell.z() = rest / size_.y();
    return {low_ + (cell.cast<float>().array() + 0.5F).matrix() * cell_m_, *most};
  }

 private:
  Eigen::Vector3f low_;
  float cell_m_;
  Eigen::Vector3i size_;
  std::vector<std::uint16_t> votes_;
};

struct Vote {
  Pose X_WO;
  int votes = 0;
};

/// A seen and a model point that may be the same: like colours, and normals that a turn about the
/// vertical can bring together.
struct Pair {
  Eigen::Vector3f position_O;
  Eigen::Vector3f normal_O;
  Eigen::Vector3f position_U;  ///< U: W turned so that its z is up
  Eigen::Vector3f normal_U;
};

std::vector<Pair> pairs_of(const Surface& voters_O, const Surface& voters_U) {
  std::vector<Pair> pairs;
  pairs.reserve(voters_O.size() * voters_U.size() / 4);
  for (const SurfacePoint& o : voters_O) {
    const float horizontal_O = std::hypot(o.normal.x(), o.normal.y());
    for (const SurfacePoint& u : voters_U) {
      const float largest_cosine =
          o.normal.z() * u.normal.z() + horizontal_O * std::hypot(u.normal.x(), u.normal.y());
      if (largest_cosine < kSameNormal) continue;
      // Twice as far as colours of one thing may be: what the light changes is not known yet.
      if (o.has_color && u.has_color &&
          (o.lab - u.lab).squaredNorm() > 4 * kSameColor * kSameColor) {
        continue;
      }
      pairs.push_back({o.position, o.normal, u.position, u.normal});
    }
  }
  return pairs;
}

std::vector<Vote> votes_for_turns(const PreparedModel& model, const Surface& seen_W,
                                  const Eigen::Vector3d& up_W) {
  Pose X_UW = Pose::Identity();
  X_UW.linear() =
      Eigen::Quaterniond::FromTwoVectors(up_W, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Surface voters_U = transformed(every_few(seen_W, kVotersSeen), X_UW);
  const std::vector<Pair> pairs = pairs_of(every_few(model.surface_O, kVotersOfModel), voters_U);
  const float cell_m = std::max(2 * model.spacing_m, model.radius_m / kCellsInRadius);
  const int turns = std::max(
      8, static_cast<int>(std::ceil(2 * std::numbers::pi_v<float> * model.radius_m / cell_m)));
  Eigen::AlignedBox3f box;
  for (const SurfacePoint& point : voters_U) box.extend(point.position);
  // O's origin is inside the object, so at most its diameter away from each of its points.
  const Eigen::Vector3f margin = Eigen::Vector3f::Constant(2 * model.radius_m);
  TranslationVotes accumulator(box.min() - margin, box.max() + margin, cell_m);
  std::vector<Vote> votes;
  votes.reserve(static_cast<std::size_t>(turns));
  for (int turn = 0; turn < turns; ++turn) {
    const Eigen::Matrix3d R_UO =
        Eigen::AngleAxisd(2 * std::numbers::pi * turn / turns, Eigen::Vector3d::UnitZ())
            .toRotationMatrix();
    const Eigen::Matrix3f R = R_UO.cast<float>();
    accumulator.clear();
    for (const Pair& pair : pairs) {
      if ((R * pair.normal_O).dot(pair.normal_U) < kSameNormal) continue;
      accumulator.add(pair.position_U - R * pair.position_O);
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

std::vector<PoseHypothesis> refined(const std::vector<Pose>& poses, const PreparedModel& model,
                                    const Surface& seen_W, std::size_t count) {
  const Surface samples_W = every_few(seen_W, kSamples);
  std::vector<PoseHypothesis> hypotheses;
  hypotheses.reserve(poses.size());
  for (const Pose& X_WO : poses) hypotheses.push_back(refined_pose(model, samples_W, X_WO));
  return best_of(std::move(hypotheses), model, count);
}

}  // namespace

std::vector<PoseHypothesis> upright_poses(const PreparedModel& model, const Surface& seen_W,
                                          const Eigen::Vector3d& up_W, std::size_t count) {
  if (model.surface_O.empty() || seen_W.empty()) return {};
  const std::vector<Vote> votes = votes_for_turns(model, seen_W, up_W);
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < std::min(kRefined, votes.size()); ++i) {
    poses.push_back(votes[i].X_WO);
  }
  return refined(poses, model, seen_W, count);
}

}  // namespace kintsugi::segmenter
