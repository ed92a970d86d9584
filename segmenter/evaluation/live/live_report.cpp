#include "segmenter/evaluation/live/live_report.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lcmtypes/base/json_text.hpp"
#include "segmenter/evaluation/report/table.hpp"

namespace kintsugi::segmenter {
namespace {

using Json = nlohmann::ordered_json;  // keys in the order a person reads them
using Share = std::optional<double>;

Share ratio(double part, double whole) { return whole > 0.0 ? Share(part / whole) : std::nullopt; }
Share ratio(std::int64_t part, std::int64_t whole) {
  return ratio(static_cast<double>(part), static_cast<double>(whole));
}
std::string percent(const Share& share) {
  return share ? fmt::format("{:.1f} %", 100.0 * *share) : "-";
}
std::string number(const Share& value, int decimals, const char* unit = "") {
  return value ? decimal(value, decimals) + unit : "-";
}
Json json(const Share& value) { return value ? Json(*value) : Json(nullptr); }

/// Measures of a run that are not in LiveReport themselves.
struct Rates {
  explicit Rates(const LiveReport& r)
      : changes_per_region_minute(ratio(static_cast<double>(r.num_changes),
                                        r.duration_s / 60 * static_cast<double>(r.num_regions))),
        handovers_per_segment_minute(
            ratio(static_cast<double>(r.num_handovers),
                  r.duration_s / 60 * static_cast<double>(r.num_segments))),
        unchanged(ratio(r.num_unchanged, r.num_regions)),
        times_sent(ratio(r.points_sent, r.num_points)) {}

  Share changes_per_region_minute;
  Share handovers_per_segment_minute;
  Share unchanged;
  Share times_sent;
};

Json json(const QueryCounts& counts) {
  return {{"asked", counts.num_asked},
          {"answered", counts.num_answered},
          {"wrong", counts.num_wrong},
          {"behind_10cm", counts.num_behind}};
}

}  // namespace

std::string to_markdown(const LiveLogReport& result, const LiveConfig& config) {
  const LiveReport& r = result.report;
  const Rates rates(r);
  std::string out = "| what | value |\n|---|---|\n";
  const auto row = [&out](const std::string& what, const std::string& value) {
    out += "| " + what + " | " + value + " |\n";
  };
  row(fmt::format("views after the first {:g} s (lost)", config.skip_s),
      fmt::format("{} ({})", r.num_views, r.num_lost));
  row("centre pixel is in a segment", percent(ratio(r.num_centre_covered, r.num_centre)));
  row("centre pixel has its right segment", percent(ratio(r.num_centre_right, r.num_centre)));
  row(fmt::format("visible surface with a segment within {:g} cm, mean", 100 * config.radius_m),
      percent(r.covered_mean));
  row("the same, in the worst tenth of the views at most", percent(r.covered_worst_tenth));
  row("from surface that was seen long enough to its label, median",
      number(r.delay_median_s, 2, " s"));
  row("the same, 99 % of the surface", number(r.delay_p99_s, 2, " s"));
  row("queries by pixel: answered", percent(ratio(r.pixel.num_answered, r.pixel.num_asked)));
  row("queries by pixel: wrong answers", percent(ratio(r.pixel.num_wrong, r.pixel.num_answered)));
  row("queries by ray: answered", percent(ratio(r.ray.num_answered, r.ray.num_asked)));
  row("queries by ray: wrong answers (more than 10 cm behind)",
      percent(ratio(r.ray.num_wrong, r.ray.num_answered)) + " (" +
          percent(ratio(r.ray.num_behind, r.ray.num_answered)) + ")");
  row("surface whose label never changed after its first second", percent(rates.unchanged));
  row("changes of label, of a piece of surface in a minute",
      number(rates.changes_per_region_minute, 3));
  row("handovers from segment to segment, of a segment in a minute",
      number(rates.handovers_per_segment_minute, 2));
  row("points sent, of each point of the final map", number(rates.times_sent, 2));
  row("revisions of slices sent", grouped(r.revisions_sent));
  return out;
}

std::string to_json(const LiveLogReport& result) {
  const LiveReport& r = result.report;
  const Rates rates(r);
  const Json root{{"log", result.source},
                  {"session", r.session},
                  {"is_whole", result.is_whole},
                  {"remarks", result.remarks},
                  {"duration_s", r.duration_s},
                  {"views", r.num_views},
                  {"views_lost", r.num_lost},
                  {"views_with_centre", r.num_centre},
                  {"centre_covered", json(ratio(r.num_centre_covered, r.num_centre))},
                  {"centre_right", json(ratio(r.num_centre_right, r.num_centre))},
                  {"covered_mean", json(r.covered_mean)},
                  {"covered_worst_tenth", json(r.covered_worst_tenth)},
                  {"regions", r.num_regions},
                  {"regions_with_delay", r.num_delays},
                  {"delay_median_s", json(r.delay_median_s)},
                  {"delay_p99_s", json(r.delay_p99_s)},
                  {"pixel", json(r.pixel)},
                  {"ray", json(r.ray)},
                  {"segments", r.num_segments},
                  {"label_changes", r.num_changes},
                  {"label_changes_by_merge", r.num_changes_by_merge},
                  {"label_changes_per_region_minute", json(rates.changes_per_region_minute)},
                  {"handovers", r.num_handovers},
                  {"handovers_per_segment_minute", json(rates.handovers_per_segment_minute)},
                  {"unchanged", json(rates.unchanged)},
                  {"revisions_sent", r.revisions_sent},
                  {"points_sent", r.points_sent},
                  {"points", r.num_points},
                  {"times_sent", json(rates.times_sent)}};
  return json_text(root, 2) + "\n";
}

}  // namespace kintsugi::segmenter
