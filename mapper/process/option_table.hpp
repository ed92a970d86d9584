#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <variant>
#include <vector>

namespace kintsugi::mapper {

struct Options;

/// Whether --resume demands the value with which the session was begun.
enum class OnResume {
  kMustMatch,  ///< the slices depend on it
  kMayDiffer,
};

/// Bounds of a number, inclusive.
struct Bounds {
  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();
};

/// A member of Options that a flag sets.
using OptionValue = std::variant<bool*, int*, std::int64_t*, double*, std::string*>;

/// An option of kintsugi-mapper: a row of the table from which the flags, the check of bounds and
/// the check on --resume are made.
class MapperOption {
 public:
  /// @param help without unit and bounds, which help() appends
  /// @param unit empty: none
  /// @param bounds checked by check_bounds(); bounds of members that belong to SourceConfig or
  ///   MapperPipeline::Config are checked there
  MapperOption(std::string flag, OptionValue value, OnResume on_resume, std::string help,
               std::string unit = "", Bounds bounds = {});

  const std::string& flag() const { return flag_; }
  OptionValue value() const { return value_; }
  OnResume on_resume() const { return on_resume_; }
  std::string help() const;
  std::string value_text() const;

  /// @throws std::invalid_argument naming flag, value and bounds; NaN is always refused
  void check_bounds() const;

 private:
  std::string flag_;
  OptionValue value_;
  OnResume on_resume_;
  std::string help_;
  std::string unit_;
  Bounds bounds_;
};

struct OptionGroup {
  std::string title;  ///< in --help
  std::vector<MapperOption> options;
};

/// Every option of kintsugi-mapper that sets a member of Options. The values point into `options`.
std::vector<OptionGroup> option_table(Options& options);

}  // namespace kintsugi::mapper
