#include "tests/report/sample_study.h"

#include <cmath>

namespace pliant {

Chart sample_lines() {
  Chart chart;
  chart.name = "accuracy";
  chart.title = "Figure 5.5: accuracy over nodes, hand";
  chart.text =
      "More nodes help until the noise of the depth is reached; adaptive nodes get there with fewer.";
  chart.x_label = "nodes";
  chart.y_label = "mean residual, mm";
  chart.log_x = true;
  chart.series = {{"uniform nodes (ED)", {}}, {"adaptive nodes <AdNodes>", {}}};
  for (const double nodes : {16.0, 32.0, 64.0, 128.0, 256.0, 512.0}) {
    chart.series[0].points.push_back({nodes, "", 1.1 + 40 / nodes, 0.1 + 3 / nodes, 10});
    chart.series[1].points.push_back({nodes * 0.8, "", 1.0 + 22 / nodes, 0.08 + 2 / nodes, 10});
  }
  return chart;
}

Chart sample_frames() {
  Chart chart;
  chart.name = "frames";
  chart.title = "Figure 6.4: tracking error over frames, cheeks";
  chart.kind = Chart::Kind::frames;
  chart.x_label = "frame";
  chart.y_label = "mm";
  chart.series = {{"rigid", {}, 8}, {"rigid + non-rigid", {}, 0}};
  for (int frame = 1; frame <= 60; ++frame) {
    const double bump = std::exp(-std::pow((frame - 30) / 8.0, 2));
    const bool is_lost = frame > 28 && frame < 34;
    chart.series[0].points.push_back({double(frame), "", is_lost ? std::nan("") : 1.1 + 4 * bump});
    chart.series[1].points.push_back({double(frame), "", 1 + bump});
  }
  chart.limits = {{"threshold", 2}};
  return chart;
}

Chart sample_bars(Chart::Kind kind) {
  Chart chart;
  const bool is_stacked = kind == Chart::Kind::stacked_bars;
  chart.name = is_stacked ? "stages" : "speed";
  chart.title = is_stacked ? "Figure 5.12: where the time goes" : "Figure 5.11: frames a second";
  chart.text = is_stacked ? "Most of the time is spent in the solver." : "Both methods on every data set.";
  chart.kind = kind;
  chart.x_label = "data set";
  chart.y_label = is_stacked ? "ms" : "frames a second";
  chart.series = {{is_stacked ? "match" : "ED", {}}, {is_stacked ? "solve" : "AdNodes+AdCons", {}}};
  double value = 14;
  for (const char* set : {"sheet (I)", "hand (II)", "head: inflated cheeks (III-2)"}) {
    chart.series[0].points.push_back({0, set, value, 1.5, 10});
    chart.series[1].points.push_back({0, set, value * 1.6, 2, 10});
    value += 4;
  }
  return chart;
}

namespace {

Table wide_table() {
  Table table{"Table 5.1: residual and true error in mm, mean ± standard deviation over 10 seeds",
              {"data set", "method", "nodes", "constraints", "iterations", "residual", "nearest", "EPE",
               "EPE, 95th percentile", "EPE of moving points", "frames a second"},
              {},
              7};
  for (const char* set : {"sheet", "hand", "head", "bag"})
    for (const char* method : {"ED", "AdNodes+AdCons"})
      table.rows.push_back({{set, method, "256", "1024", "14", "1.25 ± 0.11", "0.85 ± 0.04", "2.31 ± 0.52",
                             "5.12 ± 0.94", "3.01 ± 0.61", "18.2 ± 0.4"}});
  return table;
}

}  // namespace

std::vector<Study> sample_studies() {
  Study accuracy;
  accuracy.name = "figure_5_5";
  accuracy.title = "Figures 5.5 and 5.6";
  accuracy.lead = "Each data set was registered with graphs of 16 to 512 nodes, ten seeds each.";
  accuracy.charts = {sample_lines(), sample_bars(Chart::Kind::bars), sample_bars(Chart::Kind::stacked_bars)};
  accuracy.tables = {wide_table()};
  accuracy.findings = {{"Adaptive nodes are as accurate as twice as many uniform ones",
                        "set: hand",
                        "adaptive <= 1.05 * uniform",
                        {{"adaptive", 1.234}, {"uniform", 1.3}},
                        Finding::Verdict::confirmed,
                        ""},
                       {"A low residual means a low true error",
                        "set: head",
                        "epe < 2 * residual",
                        {{"epe", 4.2}, {"residual", 1.1}},
                        Finding::Verdict::not_confirmed,
                        ""}};
  accuracy.notes = {"hand/seed_7 failed: no point of the source projects onto a point of the target"};
  accuracy.experiment =
      "extends: methods/ed.yaml\ndata: {type: synthetic_sheet}\nsweep:\n  graph.nodes: [16, 32]\n";
  accuracy.environment = {{"version", "0.1.0"},
                          {"device", {{"name", "a CPU"}, {"driver", "3.1"}}},
                          {"seed", 1},
                          {"libraries", {{"ceres", "2.1.0"}, {"eigen", "3.4.0"}}}};
  Study speed;
  speed.name = "figure_5_11";
  speed.title = "Figure 5.11: speed";
  speed.lead = "";
  speed.charts = {sample_bars(Chart::Kind::bars)};
  speed.findings = {{"15 frames a second are reached",
                     "",
                     "fps >= 15",
                     {},
                     Finding::Verdict::unknown,
                     "unknown: the runs of AdNodes+AdCons failed"}};
  return {accuracy, speed};
}

}  // namespace pliant
