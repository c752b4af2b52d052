#include "experiments/report/page.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include "experiments/report/pictures.h"
#include "experiments/report/plot.h"
#include "framework/io/file.h"

namespace pliant {
namespace {

constexpr const char* style = R"(
:root { color-scheme: light dark; --paper: #ffffff; --card: #f6f7f9; --ink: #1d232b; --quiet: #667080;
  --rule: #dfe3e8; --accent: #2f6fdb; }
@media (prefers-color-scheme: dark) {
  :root { --paper: #14171c; --card: #1d2229; --ink: #e8ebef; --quiet: #98a2b0; --rule: #323943; --accent: #6ea3ff; }
}
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 1180px; padding: 32px 24px 64px; background: var(--paper); color: var(--ink);
  font: 15px/1.5 system-ui, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif; }
h1 { margin: 0; font-size: 28px; letter-spacing: -0.01em; overflow-wrap: anywhere; }
h2 { margin: 0 0 12px; font-size: 17px; }
.lead { margin: 4px 0 24px; color: var(--quiet); }
section { background: var(--card); border: 1px solid var(--rule); border-radius: 12px; padding: 20px 22px;
  margin-bottom: 20px; min-width: 0; }
.columns { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 440px), 1fr)); gap: 0 20px; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th, td { padding: 6px 0 6px 16px; border-bottom: 1px solid var(--rule); text-align: right; white-space: nowrap; }
th:first-child, td:first-child { text-align: left; padding-left: 0; }
thead th { color: var(--quiet); font-weight: 500; }
tbody tr:last-child > * { border-bottom: 0; }
tbody th { font-weight: 400; }
td.final { font-weight: 650; }
.quiet { color: var(--quiet); }
.bar { width: 34%; min-width: 80px; }
.bar span { display: block; height: 10px; min-width: 1px; border-radius: 5px; background: var(--accent); }
.plot { width: 100%; height: auto; display: block; font-size: 12px; }
.plot text { fill: var(--quiet); }
.plot .label { fill: var(--ink); font-size: 13px; }
.plot .grid { stroke: var(--rule); }
.plot polyline { fill: none; stroke: var(--accent); stroke-width: 2; stroke-linejoin: round; }
.plot circle { fill: var(--accent); }
.pictures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 440px), 1fr)); gap: 20px; }
figure { margin: 0; }
figure img { width: 100%; display: block; border-radius: 8px; border: 1px solid var(--rule); }
)";

std::string escape(const std::string& text) {
  std::string safe;
  for (const char letter : text) {
    switch (letter) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += letter;
    }
  }
  return safe;
}

std::string section(const std::string& title, const std::string& body) {
  return fmt::format("<section><h2>{}</h2>\n{}</section>\n", title, body);
}

std::string with_sd(double mean, double sd) {
  return fmt::format("{:.2f} <span class=\"quiet\">&plusmn; {:.2f}</span>", mean, sd);
}

/// A row of the table of metrics; `cell` writes one of its three values.
std::string metrics_row(const std::string& name, const RunRecord& run,
                        const std::function<std::string(const Metrics&)>& cell) {
  return fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td class=\"final\">{}</td></tr>\n",
                     name, cell(run.initial), cell(run.aligned), cell(run.metrics));
}

std::string truth_rows(const RunRecord& run) {
  const auto row = [&](const char* name, const std::function<std::string(const Metrics::Truth&)>& cell) {
    return metrics_row(name, run, [&](const Metrics& metrics) {
      return metrics.truth ? cell(*metrics.truth) : std::string("&ndash;");
    });
  };
  using Truth = Metrics::Truth;
  return row("To the true position (EPE)",
             [](const Truth& truth) { return with_sd(truth.epe_mean, truth.epe_sd); }) +
         row("EPE, 95th percentile",
             [](const Truth& truth) { return fmt::format("{:.2f}", truth.epe_p95); }) +
         row("EPE of points that truly move",
             [](const Truth& truth) { return fmt::format("{:.2f}", truth.epe_moving_mean); });
}

std::string metrics_table(const RunRecord& run) {
  std::string rows =
      metrics_row("Residual, to the target at the same pixel", run,
                  [](const Metrics& metrics) { return with_sd(metrics.residual_mean, metrics.residual_sd); });
  rows += metrics_row("Coverage (points that have such a pixel)", run,
                      [](const Metrics& metrics) { return fmt::format("{:.1f} %", 100 * metrics.coverage); });
  rows += metrics_row("To the nearest target point", run, [](const Metrics& metrics) {
    return with_sd(metrics.nearest_mean, metrics.nearest_sd);
  });
  if (run.metrics.truth) rows += truth_rows(run);
  return section(
      "Distances in mm, mean &plusmn; standard deviation",
      "<div class=\"scroll\"><table><thead><tr><th></th><th>initial</th><th>aligned</th><th>final</th>"
      "</tr></thead><tbody>\n" +
          rows + "</tbody></table></div>\n");
}

std::string facts_table(const std::vector<std::pair<std::string, std::string>>& facts) {
  std::string rows;
  for (const auto& [name, value] : facts) {
    rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", name, escape(value));
  }
  return "<div class=\"scroll\"><table><tbody>\n" + rows + "</tbody></table></div>\n";
}

std::string counts_table(const RegistrationResult& result) {
  const RegistrationResult::Counts& counts = result.counts;
  return section("Counts", facts_table({{"Source points", std::to_string(counts.source_points)},
                                        {"Nodes", std::to_string(counts.nodes)},
                                        {"Edges", std::to_string(counts.edges)},
                                        {"Constraints", std::to_string(counts.constraints)},
                                        {"Unknowns", std::to_string(counts.unknowns)},
                                        {"Outer iterations", std::to_string(counts.outer_iterations)},
                                        {"Solver iterations", std::to_string(counts.solver_iterations)}}));
}

std::string method_table(const RegistrationResult& result) {
  const double angle = Eigen::AngleAxisd(result.alignment.motion.rotation()).angle() * 180 / EIGEN_PI;
  const std::string matches =
      result.alignment.matches == 0
          ? "none used"
          : fmt::format("{} of {} agree", result.alignment.inliers, result.alignment.matches);
  return section("Method",
                 facts_table({{"Solver", result.solver.name},
                              {"Linear solver", result.solver.linear_solver},
                              {"Last solve ended", result.solver.termination},
                              {"Registration ended", result.termination},
                              {"Feature matches", matches},
                              {"Initial rotation", fmt::format("{:.2f} degrees", angle)},
                              {"Initial translation",
                               fmt::format("{:.1f} mm", result.alignment.motion.translation().norm())}}));
}

std::string energy_plot(const RegistrationResult::Energy& energy) {
  std::vector<double> values{energy.initial};
  values.insert(values.end(), energy.per_iteration.begin(), energy.per_iteration.end());
  return section("Energy", log_plot_svg(values, "outer iteration", "energy (log scale)") +
                               fmt::format("<p class=\"quiet\">From {:.6g} to {:.6g}.</p>\n", energy.initial,
                                           energy.final));
}

std::string time_bars(const RegistrationResult& result) {
  std::vector<std::pair<std::string, double>> stages(result.time_ms.begin(), result.time_ms.end());
  std::stable_sort(stages.begin(), stages.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  const double longest = stages.empty() ? 0 : stages.front().second;
  std::string rows;
  for (const auto& [name, milliseconds] : stages) {
    const double share = longest > 0 ? 100 * milliseconds / longest : 0;
    rows += fmt::format(
        "<tr><th scope=\"row\">{}</th><td class=\"bar\"><span "
        "style=\"width:{:.1f}%\"></span></td><td>{:.2f}</td>"
        "</tr>\n",
        escape(name), share, milliseconds);
  }
  rows += fmt::format("<tr><th scope=\"row\">total</th><td></td><td class=\"final\">{:.2f}</td></tr>\n",
                      result.total_ms);
  return section("Time in ms", "<div class=\"scroll\"><table><tbody>\n" + rows + "</tbody></table></div>\n");
}

std::string picture_grid(const ReportInput& input) {
  std::string figures;
  for (const Picture& picture : draw_pictures(input)) {
    figures += fmt::format("<figure><img alt=\"{}\" src=\"data:image/png;base64,{}\"></figure>\n",
                           escape(picture.caption), base64(picture.png));
  }
  return section("Pictures", "<div class=\"pictures\">\n" + figures + "</div>\n");
}

class PageReport : public Report {
 public:
  std::vector<std::filesystem::path> write(const ReportInput& input,
                                           const std::filesystem::path& folder) const override {
    const std::string page = make_page(input);
    const std::filesystem::path file = folder / "index.html";
    write_file(file.string(), {page.begin(), page.end()});
    return {file};
  }
};

}  // namespace

std::string base64(const std::vector<std::uint8_t>& bytes) {
  constexpr const char* alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? alphabet[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string make_page(const ReportInput& input) {
  const RunRecord& run = input.run;
  return fmt::format(
             "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
             "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
             "<title>{0} - Pliant</title>\n<style>{1}</style></head><body>\n<h1>{0}</h1>\n"
             "<p class=\"lead\">Non-rigid registration of {2}</p>\n",
             escape(run.name), style, escape(input.pair.name)) +
         metrics_table(run) + "<div class=\"columns\">\n" + counts_table(run.result) +
         method_table(run.result) + energy_plot(run.result.energy) + time_bars(run.result) + "</div>\n" +
         picture_grid(input) + "</body></html>\n";
}

void register_page_report(Registry& registry) {
  registry.add<Report>("page", "index.html: metrics, energy, times and pictures on one page", {},
                       [](const Parameters&, const Registry&) { return std::make_unique<PageReport>(); });
}

}  // namespace pliant
