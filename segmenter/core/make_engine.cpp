#include "segmenter/core/make_engine.hpp"

#include <array>
#include <string>
#include <utility>

#include "lcmtypes/base/choice_check.hpp"
#include "segmenter/core/batch/audited_engine.hpp"
#include "segmenter/core/batch/batch_engine.hpp"
#include "segmenter/core/exact/exact_engine.hpp"
#include "segmenter/core/fragments/fragment_engine.hpp"
#include "segmenter/core/voting/voting_engine.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr std::array<std::string_view, 3> kModes = {"exact", "batch", "voting"};

/// `engine`, with the fragment step on top of it if the config asks for it.
std::unique_ptr<SegmentationEngine> with_fragments(std::unique_ptr<IncrementalEngine> engine,
                                                   const PointCloud& cloud,
                                                   const EngineConfig& config) {
  if (config.fragment_limit() == 0) return engine;
  return std::make_unique<FragmentEngine>(std::move(engine), cloud, config);
}

}  // namespace

std::span<const std::string_view> engine_modes() { return kModes; }

void check_mode(std::string_view mode, const EngineConfig& config) {
  require_one_of("mode", mode, kModes);
  require(!config.audit || mode == "exact",
          "audit is on, and mode is '" + std::string(mode) +
              "', must be 'exact': only its result must equal batch");
  config.validate();
}

std::unique_ptr<SegmentationEngine> make_engine(std::string_view mode, const PointCloud& cloud,
                                                const EngineConfig& config) {
  check_mode(mode, config);
  if (mode == "batch") return std::make_unique<BatchEngine>(cloud, config);
  if (mode == "voting") {
    return with_fragments(std::make_unique<VotingEngine>(cloud, config), cloud, config);
  }
  auto exact = with_fragments(std::make_unique<ExactEngine>(cloud, config), cloud, config);
  if (!config.audit) return exact;
  return std::make_unique<AuditedEngine>(std::move(exact), cloud, config);
}

}  // namespace kintsugi::segmenter
