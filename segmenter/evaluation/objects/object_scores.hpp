#pragma once
// What was said of objects, and what of it is true: for changes and for detections.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "segmenter/evaluation/objects/pose_error.hpp"

namespace kintsugi::segmenter {

/// An object that should have been found.
struct TrueOutcome {
  std::string key;
  std::string kind;
  std::int64_t points = 0;  ///< of the instance in the true cloud; moved: where they are fewer
  bool is_found = false;
  bool is_found_as_kind = false;      ///< a moved object as moved, not as gone and new
  std::optional<PoseError> error{};   ///< of a motion or pose that was told
  std::optional<double> surface_m{};  ///< mean distance of the model's points from the true ones
  std::uint32_t instance = 0;         ///< in the true cloud, of a detection
  std::string name;                   ///< in the library, of a detection
  std::optional<Pose> X_WO{};         ///< where the model of that name truly is
  std::string reason;                 ///< why it was not found, as far as is known
};

/// A change or a detection that was told.
struct ClaimOutcome {
  std::int64_t id = 0;
  std::string kind;         ///< of a change; name of a detection
  std::int64_t points = 0;  ///< as told
  bool is_right = false;
  std::string key;                ///< the true object it belongs to; "" : to none
  std::string reason;             ///< why it is not right
  std::optional<double> score{};  ///< of a detection, as told
  std::optional<std::int64_t> utime{};
};

struct ObjectScores {
  std::vector<TrueOutcome> truth;
  std::vector<ClaimOutcome> claims;
};

/// By the points of the true object; a wrong claim: by its own.
struct SizeClass {
  const char* name;
  std::int64_t min_points;
  std::int64_t end_points;  ///< the first that is too many
};
inline constexpr std::array<SizeClass, 3> kSizeClasses = {
    {{"50 to 199", 50, 200}, {"200 to 499", 200, 500}, {"500 and more", 500, INT64_MAX}}};

struct Tally {
  std::int64_t num_true = 0;
  std::int64_t num_found = 0;
  std::int64_t num_told = 0;
  std::int64_t num_right = 0;

  std::optional<double> recall() const;     ///< none: nothing to find
  std::optional<double> precision() const;  ///< none: nothing told
};

/// @param kind "" for all; of a wrong claim the kind that was told counts
Tally tally(const ObjectScores& scores, const SizeClass& size, const std::string& kind = "");

}  // namespace kintsugi::segmenter
