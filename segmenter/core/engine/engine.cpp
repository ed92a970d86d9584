#include "segmenter/core/engine/engine.hpp"

#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "segmenter/core/batch/audited_engine.hpp"
#include "segmenter/core/batch/batch_engine.hpp"
#include "segmenter/core/exact/exact_engine.hpp"
#include "segmenter/core/fragments/fragment_engine.hpp"
#include "segmenter/core/voting/voting_engine.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr std::array<std::string_view, 3> kModes = {"exact", "batch", "voting"};

[[noreturn]] void throw_invalid(const char* field, double value, const char* bound) {
  std::ostringstream message;
  message << field << " is " << value << ", must be " << bound;
  throw std::invalid_argument(message.str());
}

void require_positive(const char* field, double value) {
  if (!(value > 0.0) || !std::isfinite(value)) throw_invalid(field, value, "> 0 and finite");
}

void require_not_negative(const char* field, double value) {
  if (!(value >= 0.0) || !std::isfinite(value)) throw_invalid(field, value, ">= 0 and finite");
}

/// With the fragment layer on top, if there is one.
std::unique_ptr<SegmentationEngine> with_fragments(std::unique_ptr<IncrementalEngine> engine,
                                                   const PointCloud& cloud,
                                                   const EngineConfig& config) {
  if (config.fragment_limit() == 0) return engine;
  return std::make_unique<FragmentEngine>(std::move(engine), cloud, config);
}

}  // namespace

std::int64_t EngineConfig::fragment_limit() const {
  constexpr double kToldFor_m = 0.01;
  const double scale = kToldFor_m / resolution_m;
  return std::llround(min_points * scale * scale);
}

void EngineConfig::validate() const {
  require_positive("threshold", threshold);
  require_positive("scale", scale);
  require_not_negative("color_weight", color_weight);
  require_not_negative("min_points", min_points);
  if (!(beta > 0.0 && beta < 1.0)) throw_invalid("beta", beta, "in (0, 1)");
  require_positive("resolution_m", resolution_m);
  require_positive("radius_factor", radius_factor);
  if (!(rebuild_share >= 0.0)) throw_invalid("rebuild_share", rebuild_share, ">= 0");
  if (!(explore_share >= 0.0)) throw_invalid("explore_share", explore_share, ">= 0");
  if (explore_at_least < 0) {
    throw_invalid("explore_at_least", static_cast<double>(explore_at_least), ">= 0");
  }
  // A float32 whose square vanishes or overflows compares with no distance.
  const float squared_radius_m2 = radius_m() * radius_m();
  if (!std::isnormal(squared_radius_m2)) {
    throw_invalid("radius_factor * resolution_m", radius_factor * resolution_m,
                  "a radius whose square is a normal float32");
  }
}

std::span<const std::string_view> engine_modes() { return kModes; }

std::unique_ptr<SegmentationEngine> make_engine(std::string_view mode, const PointCloud& cloud,
                                                const EngineConfig& config) {
  config.validate();
  if (mode == "exact") {
    auto engine = with_fragments(std::make_unique<ExactEngine>(cloud, config), cloud, config);
    if (!config.audit) return engine;
    return std::make_unique<AuditedEngine>(std::move(engine), cloud, config);
  }
  if (config.audit) {
    throw std::invalid_argument("audit is on, and mode is \"" + std::string(mode) +
                                "\", must be \"exact\": no other mode is to equal batch");
  }
  if (mode == "batch") return std::make_unique<BatchEngine>(cloud, config);
  if (mode == "voting") {
    return with_fragments(std::make_unique<VotingEngine>(cloud, config), cloud, config);
  }
  std::string known;
  for (const std::string_view name : kModes) known.append(" ").append(name);
  throw std::invalid_argument("mode is \"" + std::string(mode) + "\", must be one of:" + known);
}

std::vector<PointIndex> canonical_labels(std::span<const ComponentId> components) {
  constexpr PointIndex kNone = UINT32_MAX;
  std::vector<PointIndex> smallest(components.size(), kNone);
  std::vector<PointIndex> labels(components.size(), kNoComponent);
  for (PointIndex i = 0; i < components.size(); ++i) {
    if (components[i] == kNoComponent) continue;
    PointIndex& label = smallest[components[i]];
    if (label == kNone) label = i;
    labels[i] = label;
  }
  return labels;
}

}  // namespace kintsugi::segmenter
