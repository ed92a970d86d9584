// Replays, tables and the page of an evaluation.

#include <fstream>
#include <map>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segmenter/evaluation/paper/evaluation.hpp"
#include "segmenter/evaluation/paper/report.hpp"
#include "segmenter/evaluation/paper/result_plots.hpp"
#include "segmenter/evaluation/paper/result_tables.hpp"
#include "tests/segmenter/process/slice_session.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

std::vector<SliceGroup> steps_of(const std::vector<CloudSlice>& slices) {
  std::vector<SliceGroup> steps;
  steps.reserve(slices.size());
  for (const CloudSlice& slice : slices) steps.push_back({{slice}, false});
  return steps;
}

RecordedSession session_of(std::vector<SliceGroup> steps) {
  RecordedSession session;
  session.source = "test";
  session.steps = std::move(steps);
  session.num_slices = std::ssize(session.steps);
  session.has_times = true;
  return session;
}

EngineConfig config_for(const std::vector<SliceGroup>& steps) {
  EngineConfig config;
  config.resolution_m = steps.front().slices.front().resolution_m;
  return config;
}

TEST(MeasuredSession, RunsOnceForEachSliceAndTellsHowFarItIs) {
  const auto steps = steps_of(testing::wavy_session(4, 200));
  for (const std::string& mode : evaluation_modes()) {
    std::vector<std::int32_t> told;
    const MeasuredSession measured = measure_incremental(steps, mode, config_for(steps),
                                                         [&](const MeasurementProgress& progress) {
                                                           EXPECT_EQ(progress.num_steps, 4);
                                                           EXPECT_GE(progress.rest_s, 0.0);
                                                           told.push_back(progress.step);
                                                         });
    EXPECT_THAT(told, ElementsAre(1, 2, 3, 4));
    ASSERT_EQ(measured.runs.size(), 4U);
    for (int i = 0; i < 4; ++i) {
      EXPECT_EQ(measured.runs[i].step, i);
      EXPECT_EQ(measured.runs[i].map_points, 200 * (i + 1));
      EXPECT_GT(measured.runs[i].engine_ms, 0.0);
    }
    EXPECT_EQ(measured.labels.size(), 800U);
  }
}

TEST(MeasuredSession, OfBatchLeavesOutRunsButNotTheLast) {
  const auto steps = steps_of(testing::wavy_session(5, 100));
  const MeasuredSession measured = measure_batch(steps, 2, config_for(steps));
  ASSERT_EQ(measured.runs.size(), 3U);
  EXPECT_EQ(measured.runs[0].step, 1);
  EXPECT_EQ(measured.runs[1].map_points, 400);
  EXPECT_EQ(measured.runs[2].step, 4);
  EXPECT_EQ(measured.labels, measure_incremental(steps, "batch", config_for(steps)).labels);
  EXPECT_THROW(measure_batch(steps, 0, config_for(steps)), std::invalid_argument);
}

/// A session in which slices 0 and 2 move by 2 cm, and 0 loses half its points.
std::vector<SliceGroup> corrected_session() {
  const auto slices = testing::wavy_session(5, 200);
  auto steps = steps_of(slices);
  SliceGroup corrections{{slices[0], slices[2]}, true};
  corrections.slices[0].points_W.resize(100);
  for (CloudSlice& slice : corrections.slices) {
    slice.revision = 1;
    for (CloudPoint& point : slice.points_W) point.z += 0.02F;
  }
  steps.push_back(std::move(corrections));
  std::swap(steps[4], steps[5]);
  return steps;
}

TEST(MeasuredSession, ComparesMapsThatWereCorrectedOnTheWay) {
  const auto steps = corrected_session();
  const MeasuredSession batch = measure_batch(steps, 6, config_for(steps));
  EXPECT_EQ(batch.runs.at(0).map_points, 900);
  EXPECT_EQ(batch.labels.size(), 900U);
  std::vector<CloudSlice> newest = {steps[4].slices[0], steps[1].slices[0], steps[4].slices[1],
                                    steps[3].slices[0], steps[5].slices[0]};
  EXPECT_EQ(batch.labels, measure_batch(steps_of(newest), 5, config_for(steps)).labels);
  for (const std::string& mode : evaluation_modes()) {
    if (mode == "voting") continue;
    EXPECT_EQ(measure_incremental(steps, mode, config_for(steps)).labels, batch.labels) << mode;
  }
}

TEST(Evaluate, ComparesEachModeWithBatch) {
  const Evaluation result = evaluate(session_of(steps_of(testing::wavy_session(5, 300))), {});
  EXPECT_EQ(result.num_vertices, 1500);
  ASSERT_EQ(result.modes.size(), evaluation_modes().size());
  for (const ModeResult& mode : result.modes) {
    const std::string& name = mode.measured.mode;
    EXPECT_TRUE(mode.is_complete) << name;
    EXPECT_EQ(mode.slices_behind.size(), 5U) << name;
    const AgreementSummary agreement = summarize(mode.agreements);
    EXPECT_EQ(agreement.num_points, 1500) << name;
    if (name != "voting") {
      EXPECT_EQ(agreement.exact_share, 1.0) << name;
      EXPECT_EQ(agreement.num_segments, result.num_segments) << name;
    }
  }
  ASSERT_EQ(result.thetas.size(), 3U);
  EXPECT_GE(result.thetas[0].history.num_points.back(), result.thetas[1].history.num_points.back());
  EXPECT_GT(result.resident_bytes, 0);
}

TEST(Evaluate, ShowsTheThetaOfSegmentsOfTheCorrectedMap) {
  const auto steps = corrected_session();
  const Evaluation result = evaluate(session_of(steps), {});
  std::map<std::uint32_t, std::int64_t> sizes;
  for (const std::uint32_t label : result.modes.back().measured.labels) ++sizes[label];
  for (const ChosenSegment& segment : result.thetas) {
    EXPECT_EQ(segment.history.num_points.back(), sizes[segment.history.label]);
  }
}

TEST(Evaluate, SamplesBatchWhenItsBudgetIsSmall) {
  EvaluationConfig config;
  config.modes = {"batch"};
  config.batch_budget_s = 1e-9;
  config.segments = {1, 100'000};  // there are not so many
  const Evaluation result = evaluate(session_of(steps_of(testing::wavy_session(6, 100))), config);
  EXPECT_EQ(result.batch_every, 6);
  EXPECT_EQ(result.modes[0].measured.runs.size(), 1U);
  EXPECT_FALSE(result.modes[0].is_complete);
  EXPECT_TRUE(result.modes[0].slices_behind.empty());
  EXPECT_EQ(result.thetas.size(), 1U);
}

TEST(EvaluationConfig, NamesWhatIsOutOfRange) {
  const auto expect_error = [](auto change, const std::string& what) {
    EvaluationConfig config;
    change(config);
    try {
      config.validate();
      ADD_FAILURE() << "expected: " << what;
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), HasSubstr(what));
    }
  };
  expect_error([](auto& c) { c.modes = {}; }, "modes is empty");
  expect_error([](auto& c) { c.modes = {"batch", "quick"}; }, "mode is 'quick', must be one of");
  expect_error([](auto& c) { c.modes = {"batch", "batch"}; }, "'batch' comes twice");
  expect_error([](auto& c) { c.batch_every = -1; }, "batch_every is -1");
  expect_error([](auto& c) { c.batch_budget_s = 0.0; }, "batch_budget_s");
  expect_error([](auto& c) { c.segments = {0}; }, "rank 0");
  expect_error([](auto& c) { c.segments = {2, 2}; }, "rank 2 twice");
  expect_error([](auto& c) { c.engine.beta = 2.0; }, "beta");
}

MeasuredSession measured_with_times(const std::string& mode, const std::vector<double>& times_ms) {
  MeasuredSession measured;
  measured.mode = mode;
  for (const double time_ms : times_ms) {
    MeasuredRun& run = measured.runs.emplace_back();
    run.step = static_cast<std::int32_t>(measured.runs.size()) - 1;
    run.map_points = std::int64_t{4} * (run.step + 1);
    run.engine_ms = time_ms;
    run.engine_cpu_ms = 2.0 * time_ms;
    run.ids_ms = 0.5;
  }
  return measured;
}

/// Three slices of 4 points, 10 ms apart. In `voting` one segment of 6 points lacks 2 of batch's
/// and one of 6 has 2 too many; times 15, 5 and 10 ms.
Evaluation hand_made() {
  Evaluation result;
  std::vector<CloudSlice> slices(3);
  for (int i = 0; i < 3; ++i) {
    slices[i].id = i;
    slices[i].utime = 1'000'000 + 10'000 * i;
    slices[i].points_W.resize(4);
  }
  result.session = session_of(steps_of(slices));
  result.session.source = "some <hand-made> session";
  result.session.build_time_s = 0.02;
  result.session.path_length_m = 1.25;
  result.session.remarks = {"a remark & more"};
  result.num_vertices = 12;
  result.num_segments = 2;
  const std::vector<std::uint32_t> batch = {1, 1, 1, 1, 1, 1, 1, 1, 2, 2, 2, 2};
  const std::vector<std::uint32_t> voting = {7, 7, 7, 7, 7, 7, 8, 8, 8, 8, 8, 8};
  ModeResult& of_voting = result.modes.emplace_back();
  of_voting.measured = measured_with_times("voting", {15.0, 5.0, 10.0});
  of_voting.slices_behind = slices_behind(std::vector<std::int64_t>{0, 10'000, 20'000},
                                          std::vector<double>{15.0, 5.0, 10.0});
  of_voting.agreements = mutual_overlap(voting, batch);
  ModeResult& of_batch = result.modes.emplace_back();
  of_batch.measured = measured_with_times("batch", {1.0, 2.0, 3.0});
  of_batch.measured.runs.erase(of_batch.measured.runs.begin());  // sampled
  of_batch.is_complete = false;
  of_batch.agreements = mutual_overlap(batch, batch);
  result.batch_every = 2;
  result.thetas = {{1, {0, {0.001, 0.0005}, {1, 2}}}};
  return result;
}

TEST(SliceTimes, AreThoseOfTheRuns) {
  const SliceTimes times = slice_times(measured_with_times("voting", {15.0, 5.0, 10.0}));
  EXPECT_EQ(times.max_ms, 15.0);
  EXPECT_EQ(times.min_ms, 5.0);
  EXPECT_DOUBLE_EQ(times.average_ms, 10.0);
  EXPECT_DOUBLE_EQ(times.total_s, 0.030);
  EXPECT_EQ(times.p99_ms, 15.0);
}

TEST(SliceTimes, OfASampledModeAreExactWhereTimeGrowsEvenly) {
  std::vector<double> times_ms;
  for (int i = 1; i <= 10; ++i) times_ms.push_back(i);
  MeasuredSession measured = measured_with_times("batch", times_ms);
  std::erase_if(measured.runs, [](const MeasuredRun& run) { return run.step % 3 != 0; });
  const SliceTimes times = slice_times(measured);
  EXPECT_DOUBLE_EQ(times.total_s, 0.055);
  EXPECT_DOUBLE_EQ(times.average_ms, 5.5);
}

TEST(Tables, HoldTheHandMadeResults) {
  const Evaluation result = hand_made();
  EXPECT_EQ(
      to_csv(table1(result)),
      "mode,vertices,slices,build_time_s,length_m,runs,max_ms,min_ms,average_ms,total_s,p99_ms,"
      "cpu_average_ms,ids_average_ms,segments,memory_growth_bytes\n"
      "voting,12,3,0.020000,1.250000,3,15.000,5.000,10.000,0.030000,15.000,20.000,0.500,2,0\n"
      "batch,12,3,0.020000,1.250000,2,3.000,2.000,2.000,0.006000,3.000,5.000,0.500,2,0\n");
  // Voting is done after 15, 20 and 30 ms: the second slice finds one, the third none.
  EXPECT_EQ(to_csv(table2(result)),
            "mode,max_slices_behind,average_slices_behind\nvoting,1,0.333333\n");
  // v: 6 of 8 shared for one; for the other 4 of 6 with the segment of 4.
  const Table agreement = agreement_table(result);
  ASSERT_EQ(agreement.rows.size(), 4U);
  EXPECT_THAT(agreement.rows[0], ElementsAre("voting", "1", "2", "12", "0.000000", "0.708333",
                                             "0.000000", "0.708333"));
  EXPECT_THAT(agreement.rows[1], ElementsAre("voting", "100", "0", "0", "0.000000", "0.000000",
                                             "0.000000", "0.000000"));
  EXPECT_THAT(agreement.rows[2],
              ElementsAre("batch", "1", "2", "12", "1.000000", "1.000000", "1.000000", "1.000000"));
  const Table slices = slices_table(result, result.modes[0]);
  ASSERT_EQ(slices.rows.size(), 3U);
  EXPECT_THAT(slices.rows[1], ElementsAre("1", "1", "0", "1010000", "4", "8", "5.000", "10.000",
                                          "0.500", "1", "0", "0", "0", "0"));
  EXPECT_EQ(to_csv(theta_table(result)),
            "rank,join,theta,points\n1,0,0.001000000,1\n1,1,0.000500000,2\n");
}

TEST(Tables, ForPeopleHaveThePaperBesideThem) {
  const Table table = readable_table1(hand_made());
  EXPECT_THAT(table.header, ElementsAre("Table I", "voting", "batch", "paper: Office",
                                        "paper: Loop", "paper: Two floors"));
  EXPECT_THAT(table.rows[0],
              ElementsAre("Vertices", "12", "12", "60,265", "1,163,049", "3,878,785"));
  EXPECT_THAT(table.rows[6], ElementsAre("Average per slice (ms)", "10.00", "~ 2.00", "193.10",
                                         "302.70", "335.09"));
  EXPECT_THAT(readable_table2(hand_made()).rows[1],
              ElementsAre("Average cloud slices behind", "0.33", "", "0.2", "0.9", "3.4"));
}

TEST(Table, QuotesWhatCsvAndHtmlWouldMistake) {
  const Table table{{"a", "b"}, {{"1,5", "say \"x\""}, {"<b>&'", ""}}};
  EXPECT_EQ(to_csv(table), "a,b\n\"1,5\",\"say \"\"x\"\"\"\n<b>&',\n");
  EXPECT_THAT(to_html(table), HasSubstr("<td>&lt;b&gt;&amp;&#39;</td><td>&ndash;</td>"));
  EXPECT_EQ(grouped(0), "0");
  EXPECT_EQ(grouped(-1234567), "-1,234,567");
  EXPECT_EQ(grouped(999), "999");
  EXPECT_EQ(decimal(std::nullopt, 2), "");
}

TEST(CumulativeV, IsTheShareOfSegmentsWithAtLeastV) {
  const std::vector<SegmentAgreement> agreements = {
      {1, 10, 1.0}, {2, 200, 0.5}, {3, 10, 0.25}, {4, 10, 1.0}};
  EXPECT_THAT(cumulative_v(agreements, 1, 4),
              ElementsAre(std::pair(0.0, 100.0), std::pair(0.25, 100.0), std::pair(0.5, 75.0),
                          std::pair(0.75, 50.0), std::pair(1.0, 50.0)));
  EXPECT_THAT(cumulative_v(agreements, 100, 2),
              ElementsAre(std::pair(0.0, 100.0), std::pair(0.5, 100.0), std::pair(1.0, 0.0)));
  EXPECT_TRUE(cumulative_v(agreements, 1000).empty());
}

TEST(Thinned, KeepsLowestAndHighestInOrder) {
  std::vector<std::pair<double, double>> points;
  points.reserve(1000);
  for (int i = 0; i < 1000; ++i) points.emplace_back(i, i == 333 ? 50.0 : i == 777 ? -50.0 : 0.0);
  const auto kept = thinned(points, 10);
  EXPECT_LE(kept.size(), 20U);
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  EXPECT_THAT(kept, ::testing::Contains(std::pair(333.0, 50.0)));
  EXPECT_THAT(kept, ::testing::Contains(std::pair(777.0, -50.0)));
  EXPECT_EQ(thinned(points, 500), points);
}

TEST(Gnuplot, ScriptHoldsItsDataAndLeavesOutWhatALogAxisCannotShow) {
  Plot plot{.x_label = "it's x", .y_label = "y (ms)", .log_y = true};
  plot.series = {{.name = "one", .color = "#112233", .dashed = true, .points = {{0, 1}, {1, 0}}}};
  const std::string script = to_gnuplot(plot);
  EXPECT_THAT(script, HasSubstr("set xlabel 'it''s x'"));
  EXPECT_THAT(script, HasSubstr("set logscale y"));
  EXPECT_THAT(script, HasSubstr("$series0 << EOD\n0 1\nEOD\n"));
  EXPECT_THAT(script, HasSubstr("linecolor rgb '#112233'"));
}

std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

TEST(Report, IsOnePageThatRefersToNothingElse) {
  const kintsugi::testing::TemporaryFolder folder;
  const ReportContext context{"kintsugi-evaluate a 'b'", "paper", "1.2.3", gnuplot_version()};
  EXPECT_EQ(write_report(hand_made(), context, folder.path()), context.gnuplot_version.has_value());
  const std::string page = text_of(folder / "index.html");
  EXPECT_THAT(page, HasSubstr("some &lt;hand-made&gt; session"));
  EXPECT_THAT(page, HasSubstr("a remark &amp; more"));
  EXPECT_THAT(page, HasSubstr("kintsugi-evaluate a &#39;b&#39;"));
  EXPECT_THAT(page, HasSubstr("1.2.3"));
  EXPECT_THAT(page, HasSubstr("335.09"));  // the paper's
  EXPECT_THAT(page, HasSubstr("after every 2 slices"));
  for (const std::string reference : {"src=", "href=\"", "href='http", "<link", "<script"}) {
    EXPECT_THAT(page, Not(HasSubstr(reference)));
  }
  const auto count = [&](const std::string& tag) {
    std::size_t found = 0;
    for (auto at = page.find(tag); at != std::string::npos; at = page.find(tag, at + 1)) ++found;
    return found;
  };
  for (const std::string tag : {"table", "tr", "td", "figure", "svg", "dl", "h2"}) {
    EXPECT_EQ(count("<" + tag + ">") + count("<" + tag + " "), count("</" + tag + ">")) << tag;
  }
  if (context.gnuplot_version) {
    EXPECT_EQ(count("</svg>"), figures(hand_made()).size());
    EXPECT_THAT(text_of(folder / "fig4.svg"), HasSubstr("</svg>"));
  }
  EXPECT_EQ(text_of(folder / "table2.csv"), to_csv(table2(hand_made())));
}

TEST(Report, SaysThatTheRunHadOtherParameters) {
  const kintsugi::testing::TemporaryFolder folder;
  Evaluation evaluation = hand_made();
  const auto page_with = [&](std::optional<std::int64_t> segments_of_run) {
    evaluation.session.segments_of_run = segments_of_run;
    write_report(evaluation, {"", "paper", "", std::nullopt}, folder.path());
    return text_of(folder / "index.html");
  };
  EXPECT_THAT(page_with(evaluation.num_segments + 1), HasSubstr("the run had other parameters"));
  EXPECT_THAT(page_with(evaluation.num_segments), Not(HasSubstr("other parameters")));
  const std::string page = page_with(std::nullopt);
  EXPECT_THAT(page, Not(HasSubstr("other parameters")));
  EXPECT_THAT(page, HasSubstr("<dt>Preset</dt><dd>paper"));
}

TEST(Report, SaysWhichPackageTheFiguresNeed) {
  const kintsugi::testing::TemporaryFolder folder;
  EXPECT_FALSE(write_report(hand_made(), {"", "", "", std::nullopt}, folder.path()));
  EXPECT_THAT(text_of(folder / "index.html"), HasSubstr("gnuplot-nox"));
  EXPECT_FALSE(std::filesystem::exists(folder / "fig4.svg"));
  EXPECT_TRUE(std::filesystem::exists(folder / "fig4.gp"));
}

TEST(Report, WithoutTimesHasNoTable2) {
  const kintsugi::testing::TemporaryFolder folder;
  Evaluation result = hand_made();
  result.session.has_times = false;
  result.session.build_time_s.reset();
  for (ModeResult& mode : result.modes) mode.slices_behind.clear();
  write_report(result, {"", "", "", std::nullopt}, folder.path());
  EXPECT_FALSE(std::filesystem::exists(folder / "table2.csv"));
  EXPECT_THAT(text_of(folder / "index.html"), HasSubstr("Left out: the slices have no times."));
  EXPECT_THAT(text_of(folder / "table1.csv"), HasSubstr("voting,12,3,,"));
}

}  // namespace
}  // namespace kintsugi::segmenter
