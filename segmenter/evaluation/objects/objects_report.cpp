#include "segmenter/evaluation/objects/objects_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "lcmtypes/base/json_text.hpp"
#include "segmenter/evaluation/report/figure.hpp"
#include "segmenter/evaluation/report/plot.hpp"
#include "segmenter/evaluation/report/text_file.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr std::int64_t kLarge = kSizeClasses.back().min_points;

std::vector<std::string> kinds_of(const ObjectScores& scores) {
  std::set<std::string> kinds;
  for (const TrueOutcome& object : scores.truth) kinds.insert(object.kind);
  std::vector<std::string> list = {""};
  if (kinds.size() > 1) list.insert(list.end(), kinds.begin(), kinds.end());
  return list;
}

std::vector<std::string> summary_row(const ObjectScores& scores, const SizeClass& size,
                                     const std::string& kind) {
  const Tally t = tally(scores, size, kind);
  return {size.name,
          kind.empty() ? "all" : kind,
          std::to_string(t.num_true),
          std::to_string(t.num_found),
          std::to_string(t.num_told),
          std::to_string(t.num_right),
          decimal(t.precision(), 3),
          decimal(t.recall(), 3)};
}

std::string text_of(const Table& table) {
  std::vector<std::size_t> widths(table.header.size(), 0);
  const auto widen = [&](const std::vector<std::string>& row) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  };
  const auto line = [&](const std::vector<std::string>& row) {
    std::string text;
    for (std::size_t i = 0; i < row.size(); ++i)
      text += fmt::format("{:<{}}", row[i], widths[i] + 2);
    text.erase(text.find_last_not_of(' ') + 1);
    return text + "\n";
  };
  widen(table.header);
  for (const auto& row : table.rows) widen(row);
  std::string text = line(table.header);
  for (const auto& row : table.rows) text += line(row);
  return text;
}

/// Share of the objects with at least so many points that were found.
Figure sizes_figure(const ObjectScores& scores) {
  Figure figure{"sizes",
                "Objects by size",
                "Of the objects with at least the points on the x axis: all, and those found.",
                {.x_label = "points of the object at least", .y_label = "objects", .log_x = true}};
  std::vector<std::int64_t> sizes;
  sizes.reserve(scores.truth.size());
  for (const TrueOutcome& object : scores.truth) sizes.push_back(object.points);
  std::ranges::sort(sizes);
  Series all{.name = "all", .color = "#1565c0", .style = Series::Style::kSteps, .points = {}};
  Series found{.name = "found", .color = "#2e7d32", .style = Series::Style::kSteps, .points = {}};
  for (const std::int64_t size : sizes) {
    const auto is_large = [&](const TrueOutcome& object) { return object.points >= size; };
    const auto is_found = [&](const TrueOutcome& o) { return o.is_found && is_large(o); };
    const auto x = static_cast<double>(size);
    all.points.emplace_back(x, static_cast<double>(std::ranges::count_if(scores.truth, is_large)));
    found.points.emplace_back(x,
                              static_cast<double>(std::ranges::count_if(scores.truth, is_found)));
  }
  if (!sizes.empty()) {  // with room for a single size
    figure.plot.x_range = {{0.9 * static_cast<double>(sizes.front()) + 1.0,
                            1.1 * static_cast<double>(sizes.back()) + 2.0}};
    figure.plot.y_range = {{0.0, 1.05 * static_cast<double>(sizes.size())}};
  }
  figure.plot.series = {all, found};
  return figure;
}

}  // namespace

Table summary_table(const ObjectScores& scores) {
  Table table{{"points", "kind", "true", "found", "told", "right", "precision", "recall"}, {}};
  for (const SizeClass& size : kSizeClasses) {
    for (const std::string& kind : kinds_of(scores)) {
      table.rows.push_back(summary_row(scores, size, kind));
    }
  }
  return table;
}

Table truth_table(const ObjectScores& scores) {
  Table table{{"object", "kind", "points", "found", "as_kind", "translation_cm", "rotation_deg",
               "surface_cm", "reason"},
              {}};
  for (const TrueOutcome& object : scores.truth) {
    std::optional<double> translation_cm;
    std::optional<double> rotation_deg;
    if (object.error) {
      translation_cm = 100.0 * object.error->translation_m;
      if (std::isfinite(object.error->rotation_deg)) rotation_deg = object.error->rotation_deg;
    }
    std::optional<double> surface_cm;
    if (object.surface_m) surface_cm = 100.0 * *object.surface_m;
    table.rows.push_back({object.key, object.kind, std::to_string(object.points),
                          object.is_found ? "yes" : "no", object.is_found_as_kind ? "yes" : "no",
                          decimal(translation_cm, 2), decimal(rotation_deg, 2),
                          decimal(surface_cm, 2), object.reason});
  }
  return table;
}

Table claims_table(const ObjectScores& scores) {
  Table table{{"id", "told", "points", "score", "right", "object", "reason", "utime"}, {}};
  for (const ClaimOutcome& claim : scores.claims) {
    table.rows.push_back({std::to_string(claim.id), claim.kind, std::to_string(claim.points),
                          decimal(claim.score, 2), claim.is_right ? "yes" : "no", claim.key,
                          claim.reason, claim.utime ? std::to_string(*claim.utime) : ""});
  }
  return table;
}

MovedShare moved_share(const ObjectScores& scores) {
  constexpr double kMost_m = 0.02;
  constexpr double kMost_deg = 5.0;
  MovedShare share;
  for (const TrueOutcome& object : scores.truth) {
    if (object.kind != "moved" || object.points < kLarge) continue;
    ++share.num_true;
    const bool is_right = object.is_found_as_kind && object.error &&
                          object.error->translation_m <= kMost_m &&
                          object.error->rotation_deg <= kMost_deg;
    if (is_right) ++share.num_right;
  }
  return share;
}

std::int64_t num_large_false_claims(const ObjectScores& scores) {
  constexpr std::int64_t kMinPoints = 200;
  return std::ranges::count_if(scores.claims, [](const ClaimOutcome& claim) {
    return !claim.is_right && claim.points >= kMinPoints;
  });
}

std::string to_text(const ObjectScores& scores) {
  const MovedShare moved = moved_share(scores);
  std::string text = text_of(summary_table(scores));
  if (moved.num_true > 0) {
    text += fmt::format(
        "\nmoved objects of {} points and more told as moved, within 2 cm and 5 degrees: {} of "
        "{}\n",
        kLarge, moved.num_right, moved.num_true);
  }
  text += fmt::format("false, of 200 points and more: {}\n\n", num_large_false_claims(scores));
  return text + text_of(truth_table(scores)) + "\n" + text_of(claims_table(scores));
}

std::string to_json(const ObjectScores& scores) {
  using Json = nlohmann::ordered_json;
  const auto list_of = [](const Table& table) {
    Json list = Json::array();
    for (const auto& row : table.rows) {
      Json entry;
      for (std::size_t i = 0; i < row.size(); ++i) {
        if (!row[i].empty()) entry[table.header[i]] = row[i];
      }
      list.push_back(entry);
    }
    return list;
  };
  Json summary = Json::array();
  for (const SizeClass& size : kSizeClasses) {
    for (const std::string& kind : kinds_of(scores)) {
      const Tally t = tally(scores, size, kind);
      Json entry = {{"points", size.name},  {"kind", kind.empty() ? "all" : kind},
                    {"true", t.num_true},   {"found", t.num_found},
                    {"told", t.num_told},   {"right", t.num_right},
                    {"precision", nullptr}, {"recall", nullptr}};
      if (t.precision()) entry["precision"] = *t.precision();
      if (t.recall()) entry["recall"] = *t.recall();
      summary.push_back(entry);
    }
  }
  const MovedShare moved = moved_share(scores);
  const Json report{
      {"summary", summary},
      {"moved_within_2cm_5deg", {{"right", moved.num_right}, {"true", moved.num_true}}},
      {"false_of_200_points", num_large_false_claims(scores)},
      {"objects", list_of(truth_table(scores))},
      {"claims", list_of(claims_table(scores))}};
  return json_text(report, 1) + "\n";
}

void write_objects_report(const ObjectScores& scores, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  draw_figures({sizes_figure(scores)}, gnuplot_version().has_value(), folder);
  write_text_file(folder / "summary.csv", to_csv(summary_table(scores)));
  write_text_file(folder / "objects.csv", to_csv(truth_table(scores)));
  write_text_file(folder / "claims.csv", to_csv(claims_table(scores)));
  write_text_file(folder / "scores.json", to_json(scores));
}

}  // namespace kintsugi::segmenter
