#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace kintsugi::segmenter::bench {

/// Times of many runs of one thing, ms (or whatever they are).
class Sample {
 public:
  void add(double value) { values_.push_back(value); }
  [[nodiscard]] std::size_t size() const { return values_.size(); }
  [[nodiscard]] const std::vector<double>& values() const { return values_; }
  /// 0 when there are none.
  [[nodiscard]] double average() const;
  /// The smallest value that a share `q` of all do not exceed.
  [[nodiscard]] double quantile(double q) const;
  [[nodiscard]] double max() const { return quantile(1.0); }

 private:
  std::vector<double> values_;
};

/// Wall and CPU time (of all threads) since it was made.
class Stopwatch {
 public:
  Stopwatch();
  [[nodiscard]] double wall_ms() const;
  [[nodiscard]] double cpu_ms() const;

 private:
  double wall_start_ms_;
  double cpu_start_ms_;
};

/// Memory of this process in use, bytes; 0 where the system does not tell.
std::size_t resident_bytes();

/// Three digits or more: "0.050", "12.3", "1,234".
std::string number(double value);
/// All digits: "1,234".
std::string count(std::size_t value);

/// Prints a row of a Markdown table.
void print_row(const std::vector<std::string>& cells);
/// Prints its first two rows.
void print_head(const std::vector<std::string>& cells);

}  // namespace kintsugi::segmenter::bench
