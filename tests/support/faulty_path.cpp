#include "tests/support/faulty_path.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace kintsugi::testing {
namespace {

void require(bool condition, const char* field, double value, const char* bound) {
  if (condition) return;
  throw std::invalid_argument(std::string("FaultyPath: ") + field + " is " + std::to_string(value) +
                              ", expected " + bound);
}

const FaultyPath::Config& validated(const FaultyPath::Config& config) {
  config.validate();
  return config;
}

}  // namespace

void FaultyPath::Config::validate() const {
  const auto is_share = [](double value) { return value >= 0.0 && value <= 1.0; };
  require(is_share(drop), "drop", drop, "0 to 1");
  require(is_share(duplicate), "duplicate", duplicate, "0 to 1");
  require(is_share(hold_back), "hold_back", hold_back, "0 to 1");
  require(held_s >= 0.0, "held_s", held_s, ">= 0");
  require(delay_s >= 0.0, "delay_s", delay_s, ">= 0");
}

FaultyPath::FaultyPath(const Config& config) : config_(validated(config)), random_(config.seed) {}

double FaultyPath::delay_s() {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const double held_s = share(random_) * config_.held_s;
  return config_.delay_s + (share(random_) < config_.hold_back ? held_s : 0.0);
}

void FaultyPath::put(Bytes datagram, double now_s) {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  // All random numbers are drawn for every datagram, so that changing one share does not change
  // what the others select.
  const bool dropped = share(random_) < config_.drop;
  const bool duplicated = share(random_) < config_.duplicate;
  const double due_s = now_s + delay_s();
  const double due_again_s = now_s + delay_s();
  const std::int64_t number = counts_.in++;
  if (dropped) {
    ++counts_.dropped;
    return;
  }
  if (duplicated) {
    ++counts_.duplicated;
    under_way_.push({due_again_s, number, datagram});
  }
  under_way_.push({due_s, number, std::move(datagram)});
}

std::optional<Bytes> FaultyPath::take(double now_s) {
  if (under_way_.empty() || under_way_.top().due_s > now_s) return {};
  UnderWay next = under_way_.top();
  under_way_.pop();
  ++counts_.out;
  if (next.number < newest_out_) ++counts_.overtaken;
  newest_out_ = std::max(newest_out_, next.number);
  return std::move(next.datagram);
}

std::optional<double> FaultyPath::next_due_s() const {
  if (under_way_.empty()) return {};
  return under_way_.top().due_s;
}

}  // namespace kintsugi::testing
