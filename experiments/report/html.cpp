#include "experiments/report/html.h"

#include <fmt/format.h>

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
.facts td { white-space: normal; }
td.final { font-weight: 650; }
ul { margin: 0; padding-left: 20px; }
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

}  // namespace

std::string html_escape(const std::string& text) {
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

std::string html_section(const std::string& title, const std::string& body) {
  return fmt::format("<section><h2>{}</h2>\n{}</section>\n", title, body);
}

std::string html_page(const std::string& title, const std::string& lead, const std::string& body) {
  return fmt::format(
             "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
             "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
             "<title>{0} - Pliant</title>\n<style>{1}</style></head><body>\n<h1>{0}</h1>\n"
             "<p class=\"lead\">{2}</p>\n",
             html_escape(title), style, html_escape(lead)) +
         body + "</body></html>\n";
}

}  // namespace pliant
