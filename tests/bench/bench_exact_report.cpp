#include "tests/bench/bench_exact_report.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <numeric>
#include <sstream>

#include <unistd.h>

namespace kintsugi::segmenter::bench {
namespace {

double clock_ms(clockid_t clock) {
  std::timespec time{};
  ::clock_gettime(clock, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

}  // namespace

double Sample::average() const {
  if (values_.empty()) return 0.0;
  return std::accumulate(values_.begin(), values_.end(), 0.0) / static_cast<double>(size());
}

double Sample::quantile(double q) const {
  if (values_.empty()) return 0.0;
  std::vector<double> sorted = values_;
  std::ranges::sort(sorted);
  const auto rank = static_cast<std::size_t>(std::ceil(q * static_cast<double>(size())));
  return sorted[std::max<std::size_t>(rank, 1) - 1];
}

Stopwatch::Stopwatch()
    : wall_start_ms_(clock_ms(CLOCK_MONOTONIC)),
      cpu_start_ms_(clock_ms(CLOCK_PROCESS_CPUTIME_ID)) {}

double Stopwatch::wall_ms() const { return clock_ms(CLOCK_MONOTONIC) - wall_start_ms_; }

double Stopwatch::cpu_ms() const { return clock_ms(CLOCK_PROCESS_CPUTIME_ID) - cpu_start_ms_; }

std::size_t resident_bytes() {
  std::ifstream in("/proc/self/statm");
  std::size_t total_pages = 0;
  std::size_t resident_pages = 0;
  in >> total_pages >> resident_pages;
  return resident_pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

std::string number(double value) {
  if (value >= 99.5) return count(static_cast<std::size_t>(std::lround(value)));
  std::ostringstream out;
  const int decimals = value >= 9.95 ? 1 : value >= 0.995 ? 2 : 3;
  out << std::fixed << std::setprecision(decimals) << value;
  return out.str();
}

std::string count(std::size_t value) {
  std::string text = std::to_string(value);
  for (std::size_t end = text.size(); end > 3; end -= 3) text.insert(end - 3, 1, ',');
  return text;
}

void print_row(const std::vector<std::string>& cells) {
  for (const std::string& cell : cells) std::cout << "| " << cell << ' ';
  std::cout << '|' << std::endl;
}

void print_head(const std::vector<std::string>& cells) {
  std::cout << '\n';
  print_row(cells);
  for (std::size_t k = 0; k < cells.size(); ++k) std::cout << "|---";
  std::cout << '|' << std::endl;
}

}  // namespace kintsugi::segmenter::bench
