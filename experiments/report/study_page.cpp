#include "experiments/report/study_page.h"

#include <fmt/format.h>

#include "experiments/report/base64.h"
#include "experiments/report/chart_html.h"
#include "experiments/report/findings_html.h"
#include "experiments/report/json_table.h"
#include "experiments/report/view_html.h"
#include "framework/io/file.h"

namespace pliant {
namespace {

using nlohmann::ordered_json;

std::string fold(const std::string& title, const std::string& body) {
  return "<details class=\"card\"><summary>" + title + "</summary>\n" + body + "</details>\n";
}

std::string environment_html(const ordered_json& environment) {
  if (environment.empty()) return "";
  return fold("Versions, device and seed", bare_html(facts_table("", environment)));
}

std::string experiment_html(const std::string& experiment) {
  if (experiment.empty()) return "";
  return fold("The experiment, resolved", "<pre>" + html_escape(experiment) + "</pre>\n");
}

std::string charts_html(const Study& study) {
  if (study.charts.empty()) return "";
  std::string html;
  for (Chart chart : study.charts) {
    chart.name = study.name + "-" + chart.name;
    html += chart_html(chart);
  }
  return "<div class=\"charts\">\n" + html + "</div>\n";
}

std::string picture_html(const PictureFigure::Shown& shown) {
  return fmt::format(
      "<figure><div class=\"picture\"><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"></div>"
      "<figcaption>{0}</figcaption></figure>\n",
      html_escape(shown.caption), base64(read_file(shown.file.string())));
}

std::string pictures_html(const Study& study) {
  std::string html;
  for (const PictureFigure& figure : study.pictures) {
    std::string body = figure.text.empty() ? "" : "<p>" + html_escape(figure.text) + "</p>\n";
    body += "<div class=\"pictures\">\n";
    for (const auto& shown : figure.pictures) body += picture_html(shown);
    html +=
        html_section(html_escape(figure.title), body + "</div>\n", html_id(study.name + "-" + figure.name));
  }
  return html;
}

std::string views_html(const Study& study) {
  std::string html;
  for (const auto& view : study.views) html += view_html(view.title, read_view(view.file));
  return html.empty() ? "" : "<div class=\"views\">\n" + html + "</div>\n";
}

std::string study_html(const Study& study) {
  std::string html = fmt::format("<article class=\"study\" id=\"{}\"><h2>{}</h2>\n", html_id(study.name),
                                 html_escape(study.title));
  if (!study.lead.empty()) html += "<p class=\"lead\">" + html_escape(study.lead) + "</p>\n";
  html += findings_html(study) + charts_html(study);
  for (const auto& table : study.tables) html += to_html(table);
  return html + pictures_html(study) + views_html(study) + html_notes(study.notes) +
         experiment_html(study.experiment) + environment_html(study.environment) + "</article>\n";
}

}  // namespace

Page study_page(const std::string& title, const std::string& lead, const std::vector<Study>& studies) {
  Page page{title, lead, findings_summary_html(studies)};
  if (!page.body.empty()) page.contents.push_back({"findings", "What was found"});
  for (const auto& study : studies) {
    page.contents.push_back({html_id(study.name), study.title});
    page.body += study_html(study);
  }
  return page;
}

std::string make_study_page(const std::string& title, const std::string& lead,
                            const std::vector<Study>& studies) {
  return html_page(study_page(title, lead, studies));
}

}  // namespace pliant
