#include "experiments/report/chart_html.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "experiments/report/chart_svg.h"
#include "experiments/report/chart_values.h"
#include "experiments/report/html.h"

namespace pliant {
namespace {

bool has_spread(const Chart& chart) {
  return chart.kind != Chart::Kind::stacked_bars &&
         std::any_of(chart.series.begin(), chart.series.end(), [](const Chart::Series& series) {
           return std::any_of(series.points.begin(), series.points.end(),
                              [](const Chart::Point& point) { return point.spread > 0; });
         });
}

std::string caption(const Chart& chart) {
  std::string html = html_escape(chart.text);
  if (has_spread(chart))
    html +=
        " <span class=\"quiet\">Whiskers are one standard deviation over the runs long, either way.</span>";
  return html.empty() ? "" : "<figcaption><p>" + html + "</p></figcaption>\n";
}

}  // namespace

Chart chart_of(const Series& series) {
  Chart::Series values{series.value, {}};
  for (std::size_t i = 0; i < series.values.size(); ++i)
    values.points.push_back({static_cast<double>(i), "", series.values[i]});
  Chart chart;
  chart.title = series.title;
  chart.text = series.note;
  chart.x_label = series.step;
  chart.y_label = series.value + " (log scale)";
  chart.log_y = true;
  chart.series.push_back(std::move(values));
  return chart;
}

std::string chart_html(const Chart& chart) {
  const std::string id = chart.name.empty() ? "" : fmt::format(" id=\"{}\"", html_id(chart.name));
  return fmt::format(
             "<section class=\"figure\"{}><h2>{}</h2>\n<figure class=\"chart-figure\"><div "
             "class=\"chart-static\">{}</div>\n{}{}</figure>\n",
             id, html_escape(chart.title), chart_svg(chart), html_data(chart_json(chart)), caption(chart)) +
         "<details class=\"values\"><summary>Values</summary>" + bare_html(values_table(chart)) +
         "</details></section>\n";
}

}  // namespace pliant
