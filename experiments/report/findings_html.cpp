#include "experiments/report/findings_html.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/report/html.h"

namespace pliant {
namespace {

struct VerdictWords {
  Finding::Verdict verdict;
  const char* kind;
  const char* words;
};

constexpr VerdictWords verdicts[] = {{Finding::Verdict::confirmed, "confirmed", "✓ confirmed"},
                                     {Finding::Verdict::not_confirmed, "not_confirmed", "✗ not confirmed"},
                                     {Finding::Verdict::unknown, "unknown", "? unknown"}};

const VerdictWords& words_of(Finding::Verdict verdict) { return verdicts[static_cast<std::size_t>(verdict)]; }

std::string badge(Finding::Verdict verdict, const std::string& count = "") {
  const VerdictWords& words = words_of(verdict);
  return fmt::format("<span class=\"verdict {}\">{}{}</span>", words.kind, count, words.words);
}

std::string id_of(const Study& study, std::size_t finding) {
  return fmt::format("{}-finding-{}", html_id(study.name), finding + 1);
}

std::string counts_html(const std::vector<Study>& studies) {
  std::string html;
  for (const auto& words : verdicts) {
    std::ptrdiff_t count = 0;
    for (const auto& study : studies)
      count += std::count_if(study.findings.begin(), study.findings.end(),
                             [&](const Finding& finding) { return finding.verdict == words.verdict; });
    if (count > 0) html += badge(words.verdict, fmt::format("{} ", count)) + "\n";
  }
  return "<div class=\"counts\">" + html + "</div>\n";
}

std::string numbers_text(const Finding& finding) {
  std::string text;
  for (const auto& [name, value] : finding.values)
    text += fmt::format("{}{} = {:.4g}", text.empty() ? "" : ", ", name, value);
  return text;
}

std::string summary_row(const Study& study, std::size_t number) {
  const Finding& finding = study.findings[number];
  return fmt::format(
      "<tr><td>{}</td><th scope=\"row\"><a href=\"#{}\">{}</a></th><td>{}</td><td>{}</td></tr>\n",
      badge(finding.verdict), id_of(study, number), html_escape(finding.claim), html_escape(finding.scope),
      html_escape(study.title));
}

std::string finding_html(const Study& study, std::size_t number) {
  const Finding& finding = study.findings[number];
  const std::string scope =
      finding.scope.empty() ? "" : " <span class=\"quiet\">(" + html_escape(finding.scope) + ")</span>";
  std::string html =
      fmt::format("<div class=\"finding\" id=\"{}\">{} <strong>{}</strong>{}\n", id_of(study, number),
                  badge(finding.verdict), html_escape(finding.claim), scope);
  if (!finding.condition.empty())
    html += "<p class=\"quiet\">Asked: <code>" + html_escape(finding.condition) + "</code></p>\n";
  if (!finding.values.empty()) html += "<p>Measured: " + html_escape(numbers_text(finding)) + "</p>\n";
  if (!finding.reason.empty()) html += "<p>" + html_escape(finding.reason) + "</p>\n";
  return html + "</div>\n";
}

}  // namespace

std::string findings_summary_html(const std::vector<Study>& studies) {
  std::string rows;
  for (const auto& study : studies)
    for (std::size_t i = 0; i < study.findings.size(); ++i) rows += summary_row(study, i);
  if (rows.empty()) return "";
  return "<section id=\"findings\"><div class=\"table\"><div class=\"head\"><h2>What was found</h2></div>\n" +
         counts_html(studies) +
         "<div class=\"scroll\"><table class=\"words "
         "claims\"><thead><tr><th>verdict</th><th>claim</th><th>of</th><th>in"
         "</th></tr></thead><tbody>\n" +
         rows + "</tbody></table></div></div></section>\n";
}

std::string findings_html(const Study& study) {
  if (study.findings.empty()) return "";
  std::string html;
  for (std::size_t i = 0; i < study.findings.size(); ++i) html += finding_html(study, i);
  return html_section("Findings", html);
}

}  // namespace pliant
