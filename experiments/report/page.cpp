#include "experiments/report/page.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include "experiments/report/html.h"
#include "experiments/report/pictures.h"
#include "experiments/report/plot.h"
#include "framework/io/file.h"

namespace pliant {
namespace {

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
  return html_section(
      "Distances in mm, mean &plusmn; standard deviation",
      "<div class=\"scroll\"><table><thead><tr><th></th><th>initial</th><th>aligned</th><th>final</th>"
      "</tr></thead><tbody>\n" +
          rows + "</tbody></table></div>\n");
}

std::string facts_table(const std::vector<std::pair<std::string, std::string>>& facts) {
  std::string rows;
  for (const auto& [name, value] : facts) {
    rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", name, html_escape(value));
  }
  return "<div class=\"scroll\"><table><tbody>\n" + rows + "</tbody></table></div>\n";
}

std::string counts_table(const RegistrationResult::Counts& counts) {
  std::vector<std::pair<std::string, std::string>> facts{
      {"Source points", std::to_string(counts.source_points)},
      {"Nodes", std::to_string(counts.nodes)},
      {"Edges", std::to_string(counts.edges)},
      {"Constraints", std::to_string(counts.constraints)},
      {"Unknowns", std::to_string(counts.unknowns)}};
  if (counts.outer_iterations > 0)
    facts.emplace_back("Outer iterations", std::to_string(counts.outer_iterations));
  facts.emplace_back("Solver iterations", std::to_string(counts.solver_iterations));
  return html_section("Counts", facts_table(facts));
}

std::string method_table(const RegistrationResult& result) {
  const double angle = Eigen::AngleAxisd(result.alignment.motion.rotation()).angle() * 180 / EIGEN_PI;
  const std::string matches =
      result.alignment.matches == 0
          ? "none used"
          : fmt::format("{} of {} agree", result.alignment.inliers, result.alignment.matches);
  return html_section(
      "Method",
      facts_table(
          {{"Solver", result.solver.name},
           {"Linear solver", result.solver.linear_solver},
           {"Last solve ended", result.solver.termination},
           {"Registration ended",
            result.reason.empty() ? result.termination : result.termination + ": " + result.reason},
           {"Aligned by", result.alignment.method +
                              (result.alignment.reason.empty() ? "" : ": " + result.alignment.reason)},
           {"Feature matches", matches},
           {"Initial rotation", fmt::format("{:.2f} degrees", angle)},
           {"Initial translation", fmt::format("{:.1f} mm", result.alignment.motion.translation().norm())}}));
}

std::string method_table(const EditResult& result) {
  return html_section("Method", facts_table({{"Solver", result.solver.name},
                                             {"Linear solver", result.solver.linear_solver},
                                             {"The solve ended", result.solver.termination}}));
}

std::string handles_table(const EditResult& result) {
  std::string rows;
  for (const auto& handle : result.handles)
    rows += fmt::format(
        "<tr><th scope=\"row\">{}</th><td>{}</td><td>{:.2f}</td><td "
        "class=\"final\">{:.3f}</td><td>{:.3f}</td>"
        "</tr>\n",
        html_escape(handle.name), handle.points, handle.initial_mean, handle.mean, handle.max);
  return html_section("Handles: distance in mm of the points that they hold from where they want them",
                      "<div class=\"scroll\"><table><thead><tr><th></th><th>points</th><th>initial "
                      "mean</th><th>final mean</th>"
                      "<th>final maximum</th></tr></thead><tbody>\n" +
                          rows + "</tbody></table></div>\n");
}

std::string energy_plot(const RegistrationResult::Energy& energy, const char* step) {
  std::vector<double> values{energy.initial};
  values.insert(values.end(), energy.per_iteration.begin(), energy.per_iteration.end());
  return html_section("Energy", log_plot_svg(values, step, "energy (log scale)") +
                                    fmt::format("<p class=\"quiet\">From {:.6g} to {:.6g}.</p>\n",
                                                energy.initial, energy.final));
}

std::string time_bars(const StageTimes& time_ms, double total_ms) {
  std::vector<std::pair<std::string, double>> stages(time_ms.begin(), time_ms.end());
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
        html_escape(name), share, milliseconds);
  }
  rows += fmt::format("<tr><th scope=\"row\">total</th><td></td><td class=\"final\">{:.2f}</td></tr>\n",
                      total_ms);
  return html_section("Time in ms",
                      "<div class=\"scroll\"><table><tbody>\n" + rows + "</tbody></table></div>\n");
}

std::string picture_grid(const std::vector<Picture>& pictures) {
  std::string figures;
  for (const Picture& picture : pictures) {
    figures += fmt::format("<figure><img alt=\"{}\" src=\"data:image/png;base64,{}\"></figure>\n",
                           html_escape(picture.caption), base64(picture.png));
  }
  return html_section("Pictures", "<div class=\"pictures\">\n" + figures + "</div>\n");
}

class PageReport : public Report {
 public:
  std::vector<std::string> files() const override { return {"index.html"}; }
  std::vector<std::filesystem::path> write(const ReportInput& input,
                                           const std::filesystem::path& folder) const override {
    return write(make_page(input), folder);
  }
  std::vector<std::filesystem::path> write(const EditInput& input,
                                           const std::filesystem::path& folder) const override {
    return write(make_page(input), folder);
  }

 private:
  static std::vector<std::filesystem::path> write(const std::string& page,
                                                  const std::filesystem::path& folder) {
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
  const std::string body =
      metrics_table(run) + "<div class=\"columns\">\n" + counts_table(run.result.counts) +
      method_table(run.result) + energy_plot(run.result.energy, "outer iteration") +
      time_bars(run.result.time_ms, run.result.total_ms) + "</div>\n" + picture_grid(draw_pictures(input));
  return html_page(run.name, "Non-rigid registration of " + input.pair.name, body);
}

std::string make_page(const EditInput& input) {
  const EditResult& result = input.run.result;
  const std::string body = handles_table(result) + "<div class=\"columns\">\n" + counts_table(result.counts) +
                           method_table(result) + energy_plot(result.energy, "iteration of the solver") +
                           time_bars(result.time_ms, result.total_ms) + "</div>\n" +
                           picture_grid(draw_pictures(input));
  return html_page(input.run.name, "The source of " + input.pair.name + ", bent by handles", body);
}

void register_page_report(Registry& registry) {
  registry.add<Report>("page", "index.html: metrics, energy, times and pictures on one page", {},
                       [](const Parameters&, const Registry&) { return std::make_unique<PageReport>(); });
}

}  // namespace pliant
