#include "mapper/core/loop_closure/loop_closer.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/base/stopwatch.hpp"
#include "lcmtypes/base/thread_priority.hpp"
#include "mapper/core/loop_closure/common_view.hpp"

namespace kintsugi::mapper {

void LoopCloser::Config::validate() const {
  verifier.validate();
  graph.validate();
  join.validate();
  check_range("delay_s", delay_s, 0.0, 3600.0);
  check_range("max_by_position", max_by_position, 0, 1000);
  check_range("max_matches", max_matches, 1, 1000);
  check_range("min_common_share", min_common_share, 0.0, 1.0);
}

LoopCloser::LoopCloser(const Config& config)
    : config_((config.validate(), config)),
      verifier_(config.verifier),
      join_rule_(config.join, verifier_),
      graph_(config.graph),
      thread_([this] { run(); }) {}

LoopCloser::~LoopCloser() {
  {
    const std::scoped_lock lock(mutex_);
    stop_ = true;
  }
  work_.notify_all();
  thread_.join();
}

void LoopCloser::add(NewKeyframe added, std::int64_t utime) {
  append({std::move(added), utime + std::llround(1e6 * config_.delay_s)});
}

void LoopCloser::add(SharedView view, std::int64_t utime) {
  append({std::move(view), utime + std::llround(1e6 * config_.delay_s)});
}

void LoopCloser::append(Job job) {
  const std::scoped_lock lock(mutex_);
  queue_.push_back(std::move(job));
  work_.notify_one();
}

std::optional<MapCorrection> LoopCloser::take_due(std::int64_t utime) {
  std::unique_lock lock(mutex_);
  done_.wait(lock, [&] { return failure_ || queue_.empty() || queue_.front().due_utime > utime; });
  if (failure_) std::rethrow_exception(failure_);
  std::optional<MapCorrection> newest;
  while (!finished_.empty() && finished_.front().first <= utime) {
    newest = std::move(finished_.front().second);
    finished_.pop_front();
  }
  return newest;
}

std::optional<MapCorrection> LoopCloser::drain() { return take_due(INT64_MAX); }

double LoopCloser::busy_ms() const {
  const std::scoped_lock lock(mutex_);
  return busy_ms_;
}

std::size_t LoopCloser::num_queued() const {
  const std::scoped_lock lock(mutex_);
  return queue_.size();
}

void LoopCloser::run() {
  lower_priority_of_thread();
  std::unique_lock lock(mutex_);
  while (true) {
    work_.wait(lock, [this] { return stop_ || !queue_.empty(); });
    if (stop_) return;
    const Job& job = queue_.front();  // stays valid: other threads only append
    lock.unlock();
    const Stopwatch stopwatch;
    std::exception_ptr failure;
    std::optional<MapCorrection> correction;
    try {
      if (std::visit([this](const auto& added) { return work_on(added); }, job.added)) {
        correction = this->correction();
      }
    } catch (...) {
      failure = std::current_exception();
    }
    const double elapsed_ms = stopwatch.elapsed_ms();
    lock.lock();
    busy_ms_ += elapsed_ms;
    failure_ = failure;
    if (correction) finished_.emplace_back(job.due_utime, *std::move(correction));
    queue_.pop_front();
    done_.notify_all();
    if (failure_) return;
  }
}

/// Returns whether loops count that did not before; of a view, whether it has changed any.
bool LoopCloser::work_on(const NewKeyframe& added) {
  keyframes_.push_back(added.keyframe);
  graph_.add(added.keyframe->X_WC, added.from, added.way_m, added.unseen);
  add_tracked(added);
  int num_confirmed = 0;
  std::vector<Loop> joining;  // once for a keyframe, as the rule compares many
  for (const Loop& loop : matches_of(added)) {
    num_confirmed += graph_.offer(loop);
    std::vector<Loop> agreeing = graph_.agreeing_to_join(loop);
    if (agreeing.size() > joining.size()) joining = std::move(agreeing);
  }
  num_confirmed += join(joining, added.noise);
  return num_confirmed > 0;
}

MapCorrection LoopCloser::correction() {
  const double largest_motion_m = graph_.optimize();
  return MapCorrection{.X_WK = graph_.poses_W(),
                       .parts = graph_.parts(),
                       .loops = graph_.loops(),
                       .num_contradicted = graph_.num_contradicted(),
                       .largest_motion_m = largest_motion_m};
}

/// Returns how many loops are confirmed.
int LoopCloser::join(const std::vector<Loop>& loops, const DepthNoise& noise) {
  if (loops.empty() || !join_rule_.holds(loops, graph_, keyframes_, noise)) return 0;
  graph_.join(loops);
  return static_cast<int>(loops.size());
}

void LoopCloser::add_tracked(const NewKeyframe& added) {
  std::optional<int> oldest;
  std::optional<int> nearest;
  double most = 0.0;
  for (int i = 0; i < added.number; ++i) {
    if (added.is_released[i]) continue;
    const Pose X_IN = graph_.X_UK(i).inverse(Eigen::Isometry) * graph_.X_UK(added.number);
    const double share = common_share(added.number, i, X_IN);
    if (share < config_.min_common_share) continue;
    if (!oldest) oldest = i;
    if (share > most) nearest = i;
    most = std::max(most, share);
  }
  std::vector<int> from;
  for (const std::optional<int>& number : {added.from, oldest, nearest}) {
    if (number && std::ranges::find(from, *number) == from.end()) from.push_back(*number);
  }
  for (const int number : from) graph_.add_tracked(number, added.number, added.information);
}

std::vector<Loop> LoopCloser::matches_of(const NewKeyframe& added) const {
  std::vector<Loop> loops;
  for (const int candidate : candidates_for(added)) {
    const auto [later, earlier] = graph_.later_and_earlier(added.number, candidate);
    const Pose X_EL_believed = graph_.X_WK(earlier).inverse(Eigen::Isometry) * graph_.X_WK(later);
    const bool sees_same =
        common_share(later, earlier, X_EL_believed) >= config_.verifier.evidence.min_overlap_share;
    const auto match = verifier_.match(*keyframes_[later], *keyframes_[earlier],
                                       sees_same ? X_EL_believed : Pose::Identity(), added.noise);
    if (match) {
      loops.push_back({later, earlier, match->X_EL, match->information_L, match->sigma_m});
    }
  }
  std::ranges::stable_sort(loops, {}, &Loop::sigma_m);
  int num_in_part = 0;
  std::erase_if(loops, [&](const Loop& loop) {
    const bool is_in_part = graph_.part_of(loop.earlier) == graph_.part_of(loop.later);
    return is_in_part && ++num_in_part > config_.max_matches;
  });
  return loops;
}

std::vector<int> LoopCloser::candidates_for(const NewKeyframe& added) const {
  std::vector<int> candidates = added.similar;
  std::vector<std::pair<double, int>> by_position;
  for (int i = 0; i < added.number; ++i) {
    if (!added.is_released[i]) continue;
    const Pose X_IN = graph_.X_WK(i).inverse(Eigen::Isometry) * graph_.X_WK(added.number);
    const double share = common_share(added.number, i, X_IN);
    if (share >= config_.verifier.evidence.min_overlap_share) by_position.emplace_back(-share, i);
  }
  std::ranges::sort(by_position);
  if (by_position.size() > static_cast<std::size_t>(config_.max_by_position)) {
    by_position.resize(config_.max_by_position);
  }
  for (const auto& [share, number] : by_position) {
    if (std::ranges::find(candidates, number) == candidates.end()) candidates.push_back(number);
  }
  return candidates;
}

double LoopCloser::common_share(int later, int earlier, const Pose& X_EL) const {
  return kintsugi::mapper::common_share(*keyframes_[later], *keyframes_[earlier], X_EL);
}

}  // namespace kintsugi::mapper
