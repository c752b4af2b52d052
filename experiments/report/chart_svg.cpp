#include "experiments/report/chart_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "experiments/report/chart_axis.h"
#include "experiments/report/chart_values.h"
#include "experiments/report/html.h"
#include "experiments/report/web/chart.css.embed.h"

namespace pliant {
namespace {

constexpr double width = 600;
constexpr double plot_height = 280;
constexpr double right = 18;
constexpr double letter = 6.7;  ///< mean width at the size of the labels
constexpr double row = 22;      ///< of the legend

/// Those of chart.css in the light, in the order of chart_colors().
const char* paint_of(std::size_t color) {
  static constexpr std::array<const char*, 9> paints{"#2f6fdb", "#d9541e", "#1d8a5a", "#8a4fbf", "#a87400",
                                                     "#c2306b", "#178b9c", "#6b7280", "#d1242f"};
  return paints[color];
}

double text_width(const std::string& text) {
  // Only the first byte of a letter counts.
  const auto letters =
      std::count_if(text.begin(), text.end(), [](unsigned char byte) { return (byte & 0xC0) != 0x80; });
  return letter * static_cast<double>(letters);
}

std::string text(double x, double y, const std::string& anchor, const std::string& words,
                 const std::string& kind = "tick", const std::string& more = "") {
  return fmt::format(
      "<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" fill=\"{}\"{}>{}</text>\n", kind, x, y,
      anchor, kind == "tick" ? "#5b6573" : "#1d232b", more, html_escape(words));
}

std::string line(const char* kind, double x1, double y1, double x2, double y2, const char* stroke,
                 std::size_t color = 0) {
  return fmt::format(
      "<line class=\"{} s{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"/>\n",
      kind, color, x1, y1, x2, y2, stroke);
}

/// Each series has a mark of its own, for who cannot tell the colours.
std::string mark(double x, double y, std::size_t series, std::size_t color) {
  const std::string paint = fmt::format("class=\"mark s{}\" fill=\"{}\"", color, paint_of(color));
  switch (series % 4) {
    case 0:
      return fmt::format("<circle {} cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\"", paint, x, y);
    case 1:
      return fmt::format("<rect {} x=\"{:.1f}\" y=\"{:.1f}\" width=\"7\" height=\"7\"", paint, x - 3.5,
                         y - 3.5);
    case 2:
      return fmt::format("<path {} d=\"M{:.1f} {:.1f}l4.6 8h-9.2z\"", paint, x, y - 5);
    default:
      return fmt::format("<path {} d=\"M{:.1f} {:.1f}l5 5l-5 5l-5 -5z\"", paint, x, y - 5);
  }
}

std::string titled(const std::string& element, const std::string& name, const std::string& at,
                   const Chart::Point& point) {
  return fmt::format("{}><title>{}</title>{}\n", element,
                     html_escape(fmt::format("{}, {}: {}", name, at, value_text(point))),
                     element.substr(0, element.find(' ')).replace(0, 1, "</") + ">");
}

/// Draws one chart.
class Drawing {
 public:
  explicit Drawing(const Chart& chart)
      : chart_(chart),
        labels_(is_over_numbers(chart) ? std::vector<std::string>{} : labels_of(chart)),
        y_(y_axis_of(chart)),
        x_(x_axis_of(chart)) {
    double widest = 0;
    for (const double tick : y_.ticks) widest = std::max(widest, text_width(tick_label(tick)));
    left_ = widest + 44;
    lay_out_legend();
    tilts_ = !labels_.empty() && longest_label() > slot() - 6;
    bottom_ = 50 + (tilts_ ? std::min(0.5 * longest_label(), 90.0) : 0);
  }

  double height() const { return top_ + plot_height + bottom_; }

  std::string svg() const {
    return legend() + y_axis() + (is_over_numbers(chart_) ? x_axis() : word_axis()) + values() + limits();
  }

 private:
  std::size_t slot_of(const Chart::Point& point) const {
    return static_cast<std::size_t>(std::find(labels_.begin(), labels_.end(), point.label) - labels_.begin());
  }

  double longest_label() const {
    double longest = 0;
    for (const auto& label : labels_) longest = std::max(longest, text_width(label));
    return longest;
  }

  std::size_t color(std::size_t series) const { return color_of(chart_, series); }
  const char* paint(std::size_t series) const { return paint_of(color(series)); }
  double slot() const { return (width - left_ - right) / static_cast<double>(labels_.size()); }
  double x(double value) const { return left_ + x_.place(value) * (width - left_ - right); }
  double y(double value) const { return top_ + (1 - y_.place(value)) * plot_height; }
  /// The foot of bars.
  double floor() const { return y_.is_log ? top_ + plot_height : y(0); }

  void lay_out_legend() {
    double at = left_;
    double rows = 1;
    for (const auto& series : chart_.series) {
      const double wide = text_width(series.name) + 34;
      if (at + wide > width - right && at > left_) {
        at = left_;
        ++rows;
      }
      places_in_legend_.emplace_back(at, row * rows - 8);
      at += wide;
    }
    if (chart_.series.size() < 2) rows = 0;
    top_ = row * rows + 14;
  }

  std::string legend() const {
    if (chart_.series.size() < 2) return "";
    std::string svg;
    for (std::size_t i = 0; i < chart_.series.size(); ++i) {
      const auto& [at, base] = places_in_legend_[i];
      svg += is_over_numbers(chart_)
                 ? line("line", at, base - 4, at + 18, base - 4, paint(i), color(i)) +
                       legend_mark(at + 9, base - 4, i)
                 : fmt::format(
                       "<rect class=\"bar s{}\" fill=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"14\" "
                       "height=\"12\" rx=\"2\"/>",
                       color(i), paint(i), at + 2, base - 10);
      svg += text(at + 24, base, "start", chart_.series[i].name, "label");
    }
    return svg;
  }

  std::string legend_mark(double at, double base, std::size_t series) const {
    return chart_.kind == Chart::Kind::lines ? mark(at, base, series, color(series)) + "/>" : "";
  }

  std::string y_axis() const {
    std::string svg;
    for (const double tick : y_.ticks)
      svg += line("grid", left_, y(tick), width - right, y(tick), "#e3e7ec") +
             text(left_ - 8, y(tick) + 4, "end", tick_label(tick));
    return svg + text(0, 0, "middle", chart_.y_label, "label",
                      fmt::format(" transform=\"translate(14 {:.1f}) rotate(-90)\"", top_ + plot_height / 2));
  }

  std::string x_label() const {
    return text((left_ + width - right) / 2, height() - 8, "middle", chart_.x_label, "label");
  }

  std::string base_line() const {
    return line("axis", left_, top_ + plot_height, width - right, top_ + plot_height, "#98a2b0");
  }

  std::string x_axis() const {
    std::string svg = base_line();
    double end = 0;
    for (const double tick : x_.ticks) {
      const std::string label = tick_label(tick);
      svg += line("axis", x(tick), top_ + plot_height, x(tick), top_ + plot_height + 5, "#98a2b0");
      if (x(tick) - text_width(label) / 2 < end) continue;  // would touch the one before
      svg += text(x(tick), top_ + plot_height + 19, "middle", label);
      end = x(tick) + text_width(label) / 2 + 6;
    }
    return svg + x_label();
  }

  std::string word_axis() const {
    std::string svg = base_line();
    for (std::size_t i = 0; i < labels_.size(); ++i) {
      const double middle = left_ + (static_cast<double>(i) + 0.5) * slot();
      const double under = top_ + plot_height + (tilts_ ? 14 : 19);
      svg += text(middle, under, tilts_ ? "end" : "middle", labels_[i], "tick",
                  tilts_ ? fmt::format(" transform=\"rotate(-30 {:.1f} {:.1f})\"", middle, under) : "");
    }
    return svg + x_label();
  }

  std::string values() const {
    switch (chart_.kind) {
      case Chart::Kind::lines:
      case Chart::Kind::frames:
        return lines();
      case Chart::Kind::bars:
        return bars();
      default:
        return stacks();
    }
  }

  std::string whisker(double at, const Chart::Point& point, std::size_t series, double half = 4) const {
    if (!(point.spread > 0) || !std::isfinite(point.spread)) return "";
    const double high = y(point.value + point.spread);
    const double low =
        y_.is_log && point.value <= point.spread ? top_ + plot_height : y(point.value - point.spread);
    return line("whisker", at, low, at, high, paint(series), color(series)) +
           line("whisker", at - half, high, at + half, high, paint(series), color(series)) +
           line("whisker", at - half, low, at + half, low, paint(series), color(series));
  }

  std::string lines() const {
    std::string svg;
    for (std::size_t i = 0; i < chart_.series.size(); ++i) svg += curve(chart_.series[i], i);
    return svg;
  }

  std::string curve(const Chart::Series& series, std::size_t index) const {
    const bool is_dense = chart_.kind == Chart::Kind::frames;
    std::string path;
    std::string marks;
    bool is_broken = true;
    for (const auto& point : series.points) {
      if (!x_.takes(point.x) || !y_.takes(point.value)) {
        is_broken |= is_dense;
        continue;
      }
      path += fmt::format("{}{:.1f} {:.1f}", is_broken ? "M" : "L", x(point.x), y(point.value));
      is_broken = false;
      if (!is_dense) marks += marked(series, point, index);
    }
    if (path.empty()) return "";
    return fmt::format(
        "<path class=\"line s{}\" d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>\n{}",
        color(index), path, paint(index), marks);
  }

  std::string marked(const Chart::Series& series, const Chart::Point& point, std::size_t index) const {
    return whisker(x(point.x), point, index) + titled(mark(x(point.x), y(point.value), index, color(index)),
                                                      series.name, place_text(point), point);
  }

  /// Dashed across the plot, each with its name above its end.
  std::string limits() const {
    std::string svg;
    for (const auto& limit : chart_.limits) {
      if (!y_.takes(limit.value)) continue;
      svg += fmt::format(
                 "<line class=\"limit\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" "
                 "stroke=\"#1d232b\" stroke-dasharray=\"7 5\"/>\n",
                 left_, y(limit.value), width - right, y(limit.value)) +
             text(width - right - 4, y(limit.value) - 5, "end", limit_text(limit), "label");
    }
    return svg;
  }

  std::string bar(double at, double wide, double from, double to, std::size_t index,
                  const Chart::Point& point) const {
    return titled(
        fmt::format("<rect class=\"bar s{}\" fill=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
                    "height=\"{:.1f}\"",
                    color(index), paint(index), at, std::min(from, to), wide,
                    std::max(std::abs(to - from), 0.5)),
        chart_.series[index].name, point.label, point);
  }

  std::string bars() const {
    std::string svg;
    const double wide = std::min(0.8 * slot() / static_cast<double>(chart_.series.size()), 64.0);
    const double group = wide * static_cast<double>(chart_.series.size());
    for (std::size_t i = 0; i < chart_.series.size(); ++i)
      for (const auto& point : chart_.series[i].points) {
        if (!y_.takes(point.value)) continue;
        const double at = left_ + (static_cast<double>(slot_of(point)) + 0.5) * slot() - group / 2 +
                          wide * static_cast<double>(i);
        svg += bar(at + 0.05 * wide, 0.9 * wide, floor(), y(point.value), i, point) +
               ink_whisker(at + wide / 2, point);
      }
    return svg;
  }

  /// Over a bar, in a colour that is seen on it.
  std::string ink_whisker(double at, const Chart::Point& point) const {
    std::string svg = whisker(at, point, 0, 5);
    const std::string mine = fmt::format("whisker s{}", color(0));
    for (std::size_t found = 0; (found = svg.find(mine, found)) != std::string::npos; ++found)
      svg.replace(found, mine.size(), "whisker ink");
    return svg;
  }

  std::string stacks() const {
    std::string svg;
    const double wide = std::min(0.7 * slot(), 96.0);
    std::vector<double> reached(labels_.size(), 0);
    for (std::size_t i = 0; i < chart_.series.size(); ++i)
      for (const auto& point : chart_.series[i].points) {
        if (!std::isfinite(point.value)) continue;
        const std::size_t at = slot_of(point);
        const double from = reached[at];
        reached[at] += point.value;
        svg += bar(left_ + (static_cast<double>(at) + 0.5) * slot() - wide / 2, wide, y(from), y(reached[at]),
                   i, point);
      }
    return svg;
  }

  const Chart& chart_;
  std::vector<std::string> labels_;
  ChartAxis y_;
  ChartAxis x_;
  double left_ = 0;
  double top_ = 0;
  double bottom_ = 0;
  bool tilts_ = false;
  std::vector<std::pair<double, double>> places_in_legend_;
};

/// `attributes`: of the element; they are asked for once its height is known.
template <class Attributes>
std::string element(const Chart& chart, Attributes attributes, const std::string& first) {
  const Drawing drawing(chart);
  return fmt::format(
             "<svg class=\"chart\"{} viewBox=\"0 0 {} {:.0f}\" role=\"img\" aria-label=\"{}\" "
             "font-family=\"system-ui, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif\" "
             "font-size=\"12.5\">\n",
             attributes(drawing.height()), width, drawing.height(), html_escape(chart.title)) +
         first + drawing.svg() + "</svg>\n";
}

bool is_empty(const Chart& chart) {
  return std::all_of(chart.series.begin(), chart.series.end(), [&](const Chart::Series& series) {
    return std::none_of(series.points.begin(), series.points.end(), [&](const Chart::Point& point) {
      return std::isfinite(point.value) && (!chart.log_y || point.value > 0);
    });
  });
}

}  // namespace

std::string chart_svg(const Chart& chart) {
  if (is_empty(chart)) return "<p class=\"quiet\">No value to draw.</p>\n";
  return element(
      chart, [](double) { return ""; }, "");
}

std::string chart_svg_file(const Chart& chart) {
  const std::string style(embedded::experiments_report_web_chart_css);
  const auto attributes = [](double height) {
    return fmt::format(" xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{:.0f}\"", width, height);
  };
  return element(chart, attributes,
                 "<style>" + style +
                     "</style>\n<rect class=\"paper\" width=\"100%\" height=\"100%\" "
                     "fill=\"#ffffff\"/>\n");
}

}  // namespace pliant
