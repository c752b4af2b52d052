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

/// Findings of one claim, in a row: of each thing that it was asked of.
struct Claim {
  std::size_t first;
  std::size_t count;
};

std::vector<Claim> claims_of(const Study& study) {
  std::vector<Claim> claims;
  for (std::size_t i = 0; i < study.findings.size(); ++i) {
    const Finding& finding = study.findings[i];
    const bool is_next = i > 0 && finding.claim == study.findings[i - 1].claim &&
                         finding.condition == study.findings[i - 1].condition;
    if (is_next)
      ++claims.back().count;
    else
      claims.push_back({i, 1});
  }
  return claims;
}

/// "hand" of "set: hand".
std::string value_of_scope(const std::string& scope) {
  const std::size_t colon = scope.find(": ");
  return colon == std::string::npos ? scope : scope.substr(colon + 2);
}

/// The verdict with what it was asked of.
std::string scoped_badge(const Finding& finding) {
  if (finding.scope.empty()) return badge(finding.verdict);
  const VerdictWords& words = words_of(finding.verdict);
  const std::string mark = std::string(words.words).substr(0, std::string(words.words).find(' '));
  return fmt::format("<span class=\"verdict {}\" title=\"{}\">{} {}</span>", words.kind, words.words, mark,
                     html_escape(value_of_scope(finding.scope)));
}

std::string summary_row(const Study& study, const Claim& claim) {
  std::string badges;
  for (std::size_t i = claim.first; i < claim.first + claim.count; ++i)
    badges += scoped_badge(study.findings[i]) + "\n";
  return fmt::format(
      "<tr><th scope=\"row\"><a href=\"#{}\">{}</a></th><td class=\"verdicts\">{}</td><td>{}</td></tr>\n",
      id_of(study, claim.first), html_escape(study.findings[claim.first].claim), badges,
      html_escape(study.title));
}

std::string asked_html(const Finding& finding) {
  if (finding.condition.empty()) return "";
  return "<p class=\"quiet\">Asked: <code>" + html_escape(finding.condition) + "</code></p>\n";
}

std::string finding_html(const Study& study, std::size_t number) {
  const Finding& finding = study.findings[number];
  const std::string scope =
      finding.scope.empty() ? "" : " <span class=\"quiet\">(" + html_escape(finding.scope) + ")</span>";
  std::string html =
      fmt::format("<div class=\"finding\" id=\"{}\">{} <strong>{}</strong>{}\n", id_of(study, number),
                  badge(finding.verdict), html_escape(finding.claim), scope) +
      asked_html(finding);
  if (!finding.values.empty()) html += "<p>Measured: " + html_escape(numbers_text(finding)) + "</p>\n";
  if (!finding.reason.empty()) html += "<p>" + html_escape(finding.reason) + "</p>\n";
  return html + "</div>\n";
}

/// The findings of a claim that was asked of several things, a row each.
std::string claim_html(const Study& study, const Claim& claim) {
  if (claim.count == 1) return finding_html(study, claim.first);
  const Finding& first = study.findings[claim.first];
  std::string rows;
  for (std::size_t i = claim.first; i < claim.first + claim.count; ++i) {
    const Finding& finding = study.findings[i];
    rows += fmt::format("<tr id=\"{}\"><td>{}</td><td>{}</td><td class=\"measured\">{}</td></tr>\n",
                        id_of(study, i), html_escape(finding.scope), badge(finding.verdict),
                        html_escape(finding.reason.empty() ? numbers_text(finding) : finding.reason));
  }
  return fmt::format(
             "<div class=\"finding\"><strong>{}</strong>\n{}<div class=\"scroll\"><table "
             "class=\"words\"><tbody>\n",
             html_escape(first.claim), asked_html(first)) +
         rows + "</tbody></table></div></div>\n";
}

}  // namespace

std::string findings_summary_html(const std::vector<Study>& studies) {
  std::string rows;
  for (const auto& study : studies)
    for (const Claim& claim : claims_of(study)) rows += summary_row(study, claim);
  if (rows.empty()) return "";
  return "<section id=\"findings\"><div class=\"table\"><div class=\"head\"><h2>What was found</h2></div>\n" +
         counts_html(studies) +
         "<div class=\"scroll\"><table class=\"words "
         "claims\"><thead><tr><th>claim</th><th>verdict</th><th>in</th></tr></thead><tbody>\n" +
         rows + "</tbody></table></div></div></section>\n";
}

std::string findings_html(const Study& study) {
  if (study.findings.empty()) return "";
  std::string html;
  for (const Claim& claim : claims_of(study)) html += claim_html(study, claim);
  return html_section("Findings", html);
}

}  // namespace pliant
