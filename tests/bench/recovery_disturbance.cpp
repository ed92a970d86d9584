#include "tests/bench/recovery_disturbance.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <stdexcept>

namespace kintsugi::mapper::bench {
namespace {

constexpr std::int64_t kSecond_us = 1'000'000;
constexpr int kUnspoiltFrames = 10;  ///< the first frames make the map and are never damaged
constexpr double kSpoiltShare = 0.2;
constexpr double kCutOffWidth = 0.75;

/// Builds a plan frame by frame.
class Planner {
 public:
  Planner(int num_frames, std::int64_t period_us, std::uint32_t seed)
      : num_frames_(num_frames), period_us_(period_us), random_(seed) {}

  Plan every(int step) const {
    Plan plan;
    for (int i = 0; i < num_frames_; i += step) plan.push_back({i, i * period_us_});
    return plan;
  }

  Plan with_gaps(std::int64_t gap_us) const {
    const std::int64_t played_us = 3 * kSecond_us;
    Plan plan;
    for (int i = 0; i < num_frames_; ++i) {
      if (i * period_us_ % (played_us + gap_us) < played_us) plan.push_back({i, i * period_us_});
    }
    return plan;
  }

  Plan with_random(Damage damage) {
    Plan plan = every(1);
    for (int i = 0; i < num_frames_; ++i) {
      // Not by a standard distribution, because these differ between libraries.
      const bool spoilt = random_() < kSpoiltShare * static_cast<double>(std::mt19937::max());
      if (spoilt && i >= kUnspoiltFrames) plan[i].damage = damage;
    }
    return plan;
  }

  Plan covered() const {
    Plan plan = every(1);
    const int first = num_frames_ * 2 / 5;
    for (int i = first; i < num_frames_ && i < first + three_seconds(); ++i) {
      plan[i].damage = Damage::kWiped;
    }
    return plan;
  }

  Plan covered_and_back() const {
    Plan plan;
    for (int i = 0; i < num_frames_ / 2; i += 2) append(plan, i, Damage::kNone);
    for (int i = 0; i < three_seconds(); ++i) append(plan, num_frames_ / 2, Damage::kWiped);
    for (int i = num_frames_ / 4 | 1; i < num_frames_; i += 2) append(plan, i, Damage::kNone);
    return plan;
  }

  Plan jump() const {
    Plan plan;
    for (int i = 0; i < num_frames_ * 3 / 4; i += 2) append(plan, i, Damage::kNone);
    for (int i = num_frames_ / 10 | 1; i < num_frames_ / 2; i += 2) append(plan, i, Damage::kNone);
    return plan;
  }

 private:
  int three_seconds() const { return static_cast<int>(3 * kSecond_us / period_us_); }

  /// One period after the last one: twice the speed of the camera if every other frame is played.
  void append(Plan& plan, int frame, Damage damage) const {
    plan.push_back({frame, plan.empty() ? 0 : plan.back().utime + period_us_, damage});
  }

  int num_frames_;
  std::int64_t period_us_;
  std::mt19937 random_;
};

using Maker = Plan (*)(Planner&);

const std::vector<std::pair<std::string, Maker>>& makers() {
  static const std::vector<std::pair<std::string, Maker>> kMakers = {
      {"none", [](Planner& p) { return p.every(1); }},
      {"every-2", [](Planner& p) { return p.every(2); }},
      {"every-3", [](Planner& p) { return p.every(3); }},
      {"every-5", [](Planner& p) { return p.every(5); }},
      {"every-10", [](Planner& p) { return p.every(10); }},
      {"gap-1s", [](Planner& p) { return p.with_gaps(kSecond_us); }},
      {"gap-5s", [](Planner& p) { return p.with_gaps(5 * kSecond_us); }},
      {"wiped", [](Planner& p) { return p.with_random(Damage::kWiped); }},
      {"cut-off", [](Planner& p) { return p.with_random(Damage::kCutOff); }},
      {"covered", [](Planner& p) { return p.covered(); }},
      {"covered-back", [](Planner& p) { return p.covered_and_back(); }},
      {"jump", [](Planner& p) { return p.jump(); }},
  };
  return kMakers;
}

}  // namespace

const std::vector<std::string>& disturbance_names() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names;
    for (const auto& [name, maker] : makers()) names.push_back(name);
    return names;
  }();
  return kNames;
}

Plan plan_disturbance(const std::string& name, int num_frames, std::int64_t period_us,
                      std::uint32_t seed) {
  std::string known;
  for (const auto& [maker_name, maker] : makers()) {
    if (maker_name == name) {
      Planner planner(num_frames, period_us, seed);
      return maker(planner);
    }
    known += " " + maker_name;
  }
  throw std::invalid_argument("no disturbance \"" + name + "\"; there are:" + known);
}

RgbdFrame spoil(RgbdFrame frame, const PlannedFrame& planned) {
  frame.utime = planned.utime;
  if (planned.damage == Damage::kNone) return frame;
  const int width = planned.damage == Damage::kWiped
                        ? frame.depth_m.cols
                        : static_cast<int>(kCutOffWidth * frame.depth_m.cols);
  // The side alternates, so that the remaining part of the view does too.
  const int left = planned.frame % 2 == 0 ? 0 : frame.depth_m.cols - width;
  const cv::Rect wiped(left, 0, width, frame.depth_m.rows);
  frame.depth_m = frame.depth_m.clone();
  frame.depth_m(wiped).setTo(std::numeric_limits<float>::quiet_NaN());
  if (!frame.color_rgb.empty()) {
    frame.color_rgb = frame.color_rgb.clone();
    frame.color_rgb(wiped).setTo(cv::Vec3b(0, 0, 0));
  }
  return frame;
}

}  // namespace kintsugi::mapper::bench
