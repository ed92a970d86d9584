#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace kintsugi::segmenter::bench {

/// A sample of a quantity, such as the times of many runs in ms.
class Sample {
 public:
  void add(double value) { values_.push_back(value); }
  [[nodiscard]] std::size_t size() const { return values_.size(); }
  [[nodiscard]] const std::vector<double>& values() const { return values_; }
  /// 0 if the sample is empty.
  [[nodiscard]] double average() const;
  /// The smallest value that at least a share `q` of the values does not exceed.
  [[nodiscard]] double quantile(double q) const;
  [[nodiscard]] double max() const { return quantile(1.0); }

 private:
  std::vector<double> values_;
};

/// Wall time, and CPU time of all threads, since construction.
class Stopwatch {
 public:
  Stopwatch();
  [[nodiscard]] double wall_ms() const;
  [[nodiscard]] double cpu_ms() const;

 private:
  double wall_start_ms_;
  double cpu_start_ms_;
};

/// Resident memory of this process, bytes; 0 if unknown.
std::size_t resident_bytes();

/// With about three digits: "0.050", "12.3", "1,234".
std::string number(double value);
/// With all digits: "1,234".
std::string count(std::size_t value);

/// Prints a row of a Markdown table.
void print_row(const std::vector<std::string>& cells);
/// Prints the header of a Markdown table.
void print_head(const std::vector<std::string>& cells);

}  // namespace kintsugi::segmenter::bench
