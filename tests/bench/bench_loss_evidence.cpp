// Quality measures of registrations that found the right pose and of those that did not: quantiles
// of each quantity that the loss rule uses. Frames of a recording, whole and cropped, are
// registered with the map of the frames before them, starting at the true pose and at others.
//
//   bench_loss_evidence --device folder://7scenes_1000 --frames 300

#include <algorithm>
#include <exception>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "mapper/core/frame/surface_pyramid.hpp"
#include "tests/bench/recovery_measures.hpp"

namespace kintsugi::mapper::bench {
namespace {

struct Options {
  std::string device;
  int frames = 0;
  int step = 10;
  std::string csv;
};

struct Trial {
  bool from_there = false;  ///< the model is raycast from the start pose, not from the pose of
                            ///< the previous frame
  Damage damage = Damage::kNone;
  double start_error_m = 0.0;
  double error_m = 0.0;
  RegistrationQuality quality;
};

constexpr double kRight_m = 0.01;

/// A tracker that accepts every registration.
Tracker::Config credulous() {
  Tracker::Config config;
  config.loss.min_covered_share = 0.0;
  config.loss.max_covered_drop = 1.0;
  config.loss.following = {.max_sigma_vox = 1e6};
  return config;
}

class Experiment {
 public:
  Experiment(const Recording& recording, const std::vector<std::optional<Pose>>& X_WC)
      : recording_(recording), X_WC_(X_WC), volume_({}), integrator_({}), raycaster_({}) {}

  std::vector<Trial> run(int step) {
    for (int i = 0; i < recording_.num_frames(); ++i) {
      if (!X_WC_[i]) continue;
      const RgbdFrame frame = recording_.frame(i);
      if (i >= 2 * step && i % step == 0 && X_WC_[i - 1]) try_frame(i, frame);
      volume_.shift_to(X_WC_[i]->translation());
      integrator_.integrate(frame, *X_WC_[i], volume_);
    }
    return std::move(trials_);
  }

 private:
  void try_frame(int i, const RgbdFrame& frame) {
    const Model seen_before = model_at(*X_WC_[i - 1], frame);
    for (const Damage damage : {Damage::kNone, Damage::kCutOff}) {
      const RgbdFrame played = spoil(frame, {i, frame.utime, damage});
      const TrackingInput input{
          frame.utime, pyramid_from_depth(played.depth_m, frame.intrinsics, 1, 3, 6.0F), {}};
      for (const double distance_m : {0.0, 0.05, 0.15, 0.3, 0.6, 1.2}) {
        const Pose X_WC_start = *X_WC_[i] * random_motion(distance_m);
        try_registration(i, input, damage, X_WC_start, seen_before, false);
        try_registration(i, input, damage, X_WC_start, model_at(X_WC_start, frame), true);
      }
    }
  }

  void try_registration(int i, const TrackingInput& input, Damage damage, const Pose& X_WC_start,
                        const Model& model, bool from_there) {
    Tracker tracker(credulous());
    tracker.start_at(X_WC_start, input, 1.0);
    const TrackingResult result = tracker.track(input, model);
    trials_.push_back({from_there, damage, pose_error_m(X_WC_start, *X_WC_[i]),
                       pose_error_m(result.X_WC, *X_WC_[i]), result.quality});
  }

  Model model_at(const Pose& X_WV, const RgbdFrame& frame) const {
    return {pyramid_from_surface(raycaster_.raycast(volume_, X_WV, half_size(frame.intrinsics)), 3),
            X_WV};
  }

  /// A translation of this length in a random direction, and a rotation of one radian a metre about
  /// a random axis.
  Pose random_motion(double distance_m) {
    Vector6d xi;
    xi << random_direction() * distance_m, random_direction() * distance_m;
    return se3_retract(xi);
  }
  Eigen::Vector3d random_direction() {
    Eigen::Vector3d direction;
    do {
      for (double& x : direction) x = 2.0 * random_() / static_cast<double>(random_.max()) - 1.0;
    } while (direction.norm() > 1.0);
    return direction.normalized();
  }

  const Recording& recording_;
  const std::vector<std::optional<Pose>>& X_WC_;
  TsdfVolume volume_;
  Integrator integrator_;
  Raycaster raycaster_;
  std::mt19937 random_{1};
  std::vector<Trial> trials_;
};

void print_quantiles(const std::string& name, std::vector<double> values) {
  std::cout << "| " << name << " | " << values.size();
  std::sort(values.begin(), values.end());
  for (const double q : {0.0, 0.01, 0.05, 0.5, 0.95, 0.99, 1.0}) {
    if (values.empty()) {
      std::cout << " | -";
    } else {
      std::cout << " | " << values[static_cast<std::size_t>(q * (values.size() - 1.0))];
    }
  }
  std::cout << " |\n";
}

void print(const std::vector<Trial>& trials) {
  using Quantity = double (*)(const RegistrationQuality&);
  const std::vector<std::pair<std::string, Quantity>> quantities = {
      {"overlap share", [](const RegistrationQuality& q) { return q.overlap_share; }},
      {"inliers / overlap", [](const RegistrationQuality& q) { return q.inlier_share; }},
      {"behind / overlap", [](const RegistrationQuality& q) { return q.behind_share; }},
      {"in front / overlap", [](const RegistrationQuality& q) { return q.in_front_share; }},
      {"rms, mm", [](const RegistrationQuality& q) { return 1e3 * q.rms_m; }},
      {"rms, sigmas", [](const RegistrationQuality& q) { return q.rms_sigmas; }},
      {"sigma, mm", [](const RegistrationQuality& q) { return 1e3 * q.sigma_m; }},
  };
  std::cout << std::fixed << std::setprecision(3)
            << "| quantity | trials | least | 1 % | 5 % | median | 95 % | 99 % | most |\n"
               "|---|---|---|---|---|---|---|---|---|\n";
  for (const Damage damage : {Damage::kNone, Damage::kCutOff}) {
    for (const bool right : {true, false}) {
      for (const auto& [name, quantity] : quantities) {
        std::vector<double> values;
        for (const Trial& trial : trials) {
          const bool counts = right ? trial.error_m < kRight_m : trial.error_m > kWrong_m;
          if (trial.damage == damage && trial.quality.solved && counts) {
            values.push_back(quantity(trial.quality));
          }
        }
        print_quantiles((damage == Damage::kNone ? "whole, " : "cut off, ") +
                            std::string(right ? "right: " : "wrong: ") + name,
                        values);
      }
    }
  }
}

void write_csv(const std::vector<Trial>& trials, const std::string& file) {
  std::ofstream csv(file);
  csv << "from_there,damage,start_error_m,error_m,solved,covered,overlap,inliers,behind,in_front,"
         "rms_m,rms_sigmas,sigma_m,noise_m\n";
  for (const Trial& trial : trials) {
    const RegistrationQuality& q = trial.quality;
    csv << trial.from_there << ',' << static_cast<int>(trial.damage) << ',' << trial.start_error_m
        << ',' << trial.error_m << ',' << q.solved << ',' << q.covered_share << ','
        << q.overlap_share << ',' << q.inlier_share << ',' << q.behind_share << ','
        << q.in_front_share << ',' << q.rms_m << ',' << q.rms_sigmas << ',' << q.sigma_m << ','
        << q.noise_m << '\n';
  }
}

Options parse_command_line(int argc, char** argv) {
  Options options;
  CLI::App app("Quality measures of right and wrong registrations");
  app.add_option("--device", options.device, "folder://PATH or synthetic://NAME?...")->required();
  app.add_option("--frames", options.frames, "number of frames to read; 0: all");
  app.add_option("--step", options.step, "register every Nth frame")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--csv", options.csv, "write a line for each registration");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::exit(app.exit(error));
  }
  return options;
}

void run(const Options& options) {
  const Recording recording(options.device, options.frames);
  const auto X_WC = undisturbed_path(recording, true, {});
  const std::vector<Trial> trials = Experiment(recording, X_WC).run(options.step);
  print(trials);
  if (!options.csv.empty()) write_csv(trials, options.csv);
}

}  // namespace
}  // namespace kintsugi::mapper::bench

int main(int argc, char** argv) {
  using namespace kintsugi::mapper::bench;
  const Options options = parse_command_line(argc, argv);
  try {
    run(options);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "bench_loss_evidence: " << error.what() << '\n';
    return 1;
  }
}
