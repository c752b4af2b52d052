#include "experiments/report/html.h"

#include <fmt/format.h>

#include <cctype>

#include "experiments/report/web/chart.css.embed.h"
#include "experiments/report/web/page.css.embed.h"
#include "experiments/report/web/tables.js.embed.h"

namespace pliant {
namespace {

std::string contents_html(const Page& page) {
  if (page.contents.empty()) return "";
  std::string items;
  for (const auto& link : page.contents)
    items += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", html_escape(link.id), html_escape(link.title));
  return "<nav class=\"contents\" aria-label=\"Contents\"><a class=\"brand\" "
         "href=\"#top\">Pliant</a>\n<ol>\n" +
         items + "</ol></nav>\n";
}

std::string head_html(const Page& page, const WebBundle& bundle) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{} - Pliant</title>\n<style>\n{}{}{}</style></head>\n",
      html_escape(page.title), embedded::experiments_report_web_chart_css,
      embedded::experiments_report_web_page_css, bundle.style);
}

std::string footer_html(const WebBundle& bundle) {
  if (bundle.script.empty()) return "<footer>Made by Pliant.</footer>\n";
  return "<footer>Made by Pliant. Plots: uPlot, © Leon Sorokin. Three dimensions: three.js, © its authors. "
         "Both "
         "under the MIT licence, whose text is in the source of this page.</footer>\n";
}

std::string notice_html(const WebBundle& bundle) {
  if (!bundle.script.empty()) return "";
  return "<p class=\"notice\">The figures on this page are pictures: npm could not be reached when Pliant "
         "was "
         "built. Build it again to get figures that move.</p>\n";
}

std::string script_html(const std::string& script) { return "<script>\n" + script + "</script>\n"; }

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

std::string html_section(const std::string& title, const std::string& body, const std::string& id) {
  const std::string attribute = id.empty() ? "" : fmt::format(" id=\"{}\"", id);
  return fmt::format("<section{}><h2>{}</h2>\n{}</section>\n", attribute, title, body);
}

std::string html_notes(const std::vector<std::string>& notes) {
  if (notes.empty()) return "";
  std::string items;
  for (const std::string& note : notes) items += "<li>" + html_escape(note) + "</li>\n";
  return html_section("Notes", "<ul>\n" + items + "</ul>\n");
}

std::string html_data(const nlohmann::ordered_json& data) {
  std::string text;
  // "</script" would end the element wherever it stands.
  for (const char letter : data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace))
    text += letter == '<' ? std::string("\\u003c") : std::string(1, letter);
  return "<script type=\"application/json\">" + text + "</script>\n";
}

std::string html_id(const std::string& name) {
  std::string id;
  for (const char letter : name) id += std::isalnum(static_cast<unsigned char>(letter)) != 0 ? letter : '-';
  return id;
}

std::string html_page(const Page& page, const WebBundle& bundle) {
  const bool has_figures = page.body.find("-figure\"") != std::string::npos;
  const WebBundle used = has_figures ? bundle : WebBundle{};
  return head_html(page, used) + "<body id=\"top\"><div class=\"frame" +
         (page.contents.empty() ? " plain" : "") + "\">\n" + contents_html(page) +
         fmt::format("<main><header><h1>{}</h1>\n<p class=\"lead\">{}</p></header>\n",
                     html_escape(page.title), html_escape(page.lead)) +
         (has_figures ? notice_html(bundle) : "") + page.body + footer_html(used) + "</main></div>\n" +
         script_html(std::string(embedded::experiments_report_web_tables_js)) +
         (used.script.empty() ? "" : script_html(used.script)) + "</body></html>\n";
}

}  // namespace pliant
