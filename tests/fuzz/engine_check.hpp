#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "segmenter/core/engine/engine.hpp"
#include "segmenter/core/parameters/engine_config.hpp"

namespace kintsugi::segmenter::fuzz {

/// Checks an engine after each update: both partitions (before and after fragments are joined) and
/// every theta must be those of batch, to the bit, and components() and changed() must be as
/// engine.hpp describes them.
class EngineCheck {
 public:
  EngineCheck(const SegmentationEngine& engine, const PointCloud& cloud, const EngineConfig& config)
      : engine_(engine), cloud_(cloud), config_(config) {}

  /// @param change the argument of the last update()
  /// @param live the points in the map, ascending
  /// @return the first error, in words; nothing when there is none
  std::optional<std::string> operator()(const CloudChange& change,
                                        std::span<const PointIndex> live);

  /// Checks only the partitions and the thetas.
  [[nodiscard]] std::optional<std::string> partition(std::span<const PointIndex> live) const;

 private:
  [[nodiscard]] std::optional<std::string> check_names(std::span<const PointIndex> live) const;
  std::optional<std::string> check_changed(const CloudChange& change,
                                           std::span<const PointIndex> live);

  const SegmentationEngine& engine_;
  const PointCloud& cloud_;
  EngineConfig config_;
  std::vector<ComponentId> mirror_;  ///< components(), updated only at the points in changed()
};

}  // namespace kintsugi::segmenter::fuzz
