// What a power cut leaves of a folder: a program for scripts/faults.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include <nlohmann/json.hpp>

#include "tests/support/bus_program.hpp"
#include "tests/support/power_cut.hpp"

namespace kintsugi::testing {
namespace {

struct CutOptions {
  std::string journal;
  std::string before;
  std::string out;
  double moment = 1.0;
  std::uint32_t seed = 0;
};

void add_flags(CLI::App& app, CutOptions& options) {
  app.add_option("--journal", options.journal, "FORGETFUL_JOURNAL of the programs")->required();
  app.add_option("--before", options.before, "folder as it was before; none: empty");
  app.add_option("--out", options.out, "folder to write, in place of what is there")->required();
  app.add_option("--moment", options.moment, "which part of what was done comes before the cut");
  app.add_option("--seed", options.seed, "of what is left of what was not synced");
}

void run(const CutOptions& options) {
  const DiskJournal journal(options.journal);
  const std::span<const DiskEvent> events = journal.events();
  const auto num_events =
      static_cast<std::size_t>(options.moment * static_cast<double>(events.size()));
  cut_power(events.first(num_events), options.before, options.seed, options.out);
  give_report({{"events", events.size()}, {"before_cut", num_events}}, "");
}

}  // namespace
}  // namespace kintsugi::testing

int main(int argc, char** argv) {
  using namespace kintsugi::testing;
  return run_bus_program<CutOptions>(argc, argv, "What a power cut leaves of a folder", add_flags,
                                     run);
}
