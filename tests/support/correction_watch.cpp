// correction_watch: waits on the bus for a correction of the map. Ends when it comes, or kills a
// process at a random moment before the segmenter has acknowledged it.

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>

#include "lcmtypes/base/stop_signal.hpp"
#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/channels.hpp"
#include "lcmtypes/codec/codec.hpp"
#include "tests/support/bus_program.hpp"

namespace kintsugi::testing {
namespace {

using Clock = std::chrono::steady_clock;
using Milliseconds = std::chrono::duration<double, std::milli>;
using std::chrono::milliseconds;

constexpr milliseconds kNoticeSignals{100};

struct Options {
  std::string url;
  std::int32_t correction = 1;
  std::string pid_file;
  double window_ms = 100.0;
  std::uint32_t seed = 1;
  std::string ready_file;
  std::string report;
};

void add_flags(CLI::App& app, Options& options) {
  app.add_option("--lcm-url", options.url, "The bus; empty: LCM's default");
  app.add_option("--correction", options.correction, "The number of the first one that counts")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--kill", options.pid_file,
                 "Kills the process whose number is in this file; empty: ends at the correction");
  app.add_option("--window", options.window_ms,
                 "The moment is at most so many milliseconds after the correction. The time that "
                 "the segmenter took for an earlier one replaces it")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--seed", options.seed, "Decides the moment")->capture_default_str();
  app.add_option("--ready", options.ready_file, "Makes this file when it listens");
  app.add_option("--report", options.report, "Writes at the end what it did (JSON)");
}

class CorrectionWatch {
 public:
  explicit CorrectionWatch(const Options& options)
      : options_(options), bus_(options.url), random_(options.seed), window_ms_(options.window_ms) {
    bus_.subscribe(channels::kCloudSlice, [this](ByteView message) { hear_slice(message); });
    bus_.subscribe(channels::kSegmentUpdate, [this](ByteView message) { hear_update(message); });
  }

  void run() {
    if (!options_.ready_file.empty()) std::ofstream(options_.ready_file) << "listening\n";
    while (!stop_requested() && !done_ && !(finished_ && !moment_)) {
      bus_.handle(wait_ms());
      if (moment_ && Clock::now() >= *moment_) act();
    }
    if (!done_) throw std::runtime_error("no correction came that was not acknowledged at once");
    give_report({{"correction", number_},
                 {"after_ms", after_ms_},
                 {"acknowledged_before", num_acknowledged_}},
                options_.report);
  }

 private:
  milliseconds wait_ms() const {
    if (!moment_) return kNoticeSignals;
    const auto left = std::chrono::ceil<milliseconds>(*moment_ - Clock::now());
    return std::clamp(left, milliseconds(0), kNoticeSignals);
  }

  /// The first chunk that comes of a correction, be it sent again, begins it.
  void hear_slice(ByteView message) {
    const CloudSlice slice = decode_chunk<CloudSlice>(message).header;
    if (slice.kind == SliceKind::kFinal) finished_ = true;  // no correction follows
    if (slice.kind != SliceKind::kCorrection || slice.correction <= number_) return;
    number_ = slice.correction;
    slice_id_ = slice.id;
    heard_ = Clock::now();
    moment_.reset();
    if (number_ < options_.correction) return;
    const double share =
        options_.pid_file.empty() ? 0.0 : std::uniform_real_distribution<double>()(random_);
    moment_ =
        heard_ + std::chrono::duration_cast<Clock::duration>(Milliseconds(share * window_ms_));
  }

  /// Its update is the acknowledgement. One that is missed tells how long the next may last.
  void hear_update(ByteView message) {
    const SegmentUpdate update = decode_chunk<SegmentUpdate>(message).header;
    if (number_ == 0 || update.slice_id != slice_id_ || acknowledged_ == number_) return;
    acknowledged_ = number_;
    const double took_ms = Milliseconds(Clock::now() - heard_).count();
    window_ms_ = moment_ ? 0.5 * took_ms : took_ms;
    if (moment_) ++num_acknowledged_;
    moment_.reset();
  }

  void act() {
    // What came meanwhile may be the acknowledgement.
    while (moment_ && bus_.handle(milliseconds(0))) {
    }
    if (!moment_) return;
    if (!options_.pid_file.empty()) kill_process();
    after_ms_ = Milliseconds(Clock::now() - heard_).count();
    done_ = true;
  }

  void kill_process() const {
    pid_t pid = 0;
    if (!(std::ifstream(options_.pid_file) >> pid) || pid <= 1) {
      throw std::runtime_error("no number of a process in " + options_.pid_file);
    }
    if (kill(pid, SIGKILL) != 0) {
      throw std::runtime_error("cannot kill " + std::to_string(pid) + ": " + std::strerror(errno));
    }
  }

  const Options options_;
  Bus bus_;
  std::mt19937 random_;
  double window_ms_;
  std::int32_t number_ = 0;  // of the newest correction
  std::int32_t slice_id_ = 0;
  std::int32_t acknowledged_ = 0;  // number of the newest one that is
  Clock::time_point heard_;
  std::optional<Clock::time_point> moment_;
  int num_acknowledged_ = 0;  // before their moment
  double after_ms_ = 0.0;
  bool finished_ = false;
  bool done_ = false;
};

void watch(const Options& options) { CorrectionWatch(options).run(); }

}  // namespace
}  // namespace kintsugi::testing

int main(int argc, char** argv) {
  using namespace kintsugi::testing;
  return run_bus_program<Options>(
      argc, argv, "Waits for a correction of the map, and kills a process before it has an effect.",
      add_flags, watch);
}
