#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "segmenter/core/engine/engine.hpp"

namespace kintsugi::segmenter::fuzz {

/// Holds an engine to its word after each update: both partitions (with fragments joined, and
/// before that) and every theta to the bit are those of batch, and components() and changed() tell
/// what engine.hpp promises.
class EngineCheck {
 public:
  EngineCheck(const SegmentationEngine& engine, const PointCloud& cloud, const EngineConfig& config)
      : engine_(engine), cloud_(cloud), config_(config) {}

  /// @param change what the engine was just told
  /// @param live the points in the map, ascending
  /// @return the first thing that is wrong, in words; nothing when all is right
  std::optional<std::string> operator()(const CloudChange& change,
                                        std::span<const PointIndex> live);

  /// The partitions and the thetas alone.
  [[nodiscard]] std::optional<std::string> partition(std::span<const PointIndex> live) const;

 private:
  [[nodiscard]] std::optional<std::string> check_names(std::span<const PointIndex> live) const;
  std::optional<std::string> check_changed(const CloudChange& change,
                                           std::span<const PointIndex> live);

  const SegmentationEngine& engine_;
  const PointCloud& cloud_;
  EngineConfig config_;
  std::vector<ComponentId> mirror_;  ///< components(), kept by changed() alone
};

}  // namespace kintsugi::segmenter::fuzz
