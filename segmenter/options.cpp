#include "segmenter/options.hpp"

#include <map>

namespace kintsugi::segmenter {

void add_segmentation_options(CLI::App& app, SegmentMapConfig& config) {
  const std::map<std::string, NeighbourSearch> searches{{"grid", NeighbourSearch::kGrid},
                                                        {"flann", NeighbourSearch::kFlann}};
  EngineConfig& engine = config.engine;
  app.add_option(
         "--mode", config.mode,
         "exact: what batch gives, for the cost of what a slice changes; batch: Algorithm 1 "
         "over the whole map for each slice; voting: Algorithms 2-5, near to batch")
      ->capture_default_str();
  app.add_flag("--audit", engine.audit,
               "mode exact: compare it with batch after each slice, segments and their join "
               "thresholds to the bit, and end at the first difference; as slow as batch");
  app.add_option("--threshold", engine.threshold, "T: join threshold of a single point, > 0")
      ->capture_default_str();
  app.add_option("--scale", engine.scale, "k: bias towards large segments, > 0")
      ->capture_default_str();
  app.add_option("--beta", engine.beta, "of Eq. 4, in (0, 1); mode voting")->capture_default_str();
  app.add_option("--radius-factor", engine.radius_factor,
                 "neighbours are closer than this times the resolution, > 0")
      ->capture_default_str();
  app.add_option("--neighbours", engine.neighbour_search, "neighbour search: grid or flann")
      ->transform(CLI::CheckedTransformer(searches).description("{grid,flann}"))
      ->default_str("grid");
}

}  // namespace kintsugi::segmenter
