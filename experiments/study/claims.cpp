#include "experiments/study/claims.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "experiments/study/measure.h"
#include "framework/core/error.h"
#include "framework/core/nearest.h"

namespace pliant {
namespace {

ParameterTable value_table() {
  std::vector<Parameter> rows = Measure::rows();
  rows.push_back(choice("statistic", statistic_names(), "mean").doc("of the runs' numbers"));
  return ParameterTable(std::move(rows));
}

void check_names(const Expression& holds, const Parameters& section) {
  std::vector<std::string> known;
  for (const auto& [name, value] : section.sections("values")) known.push_back(name);
  for (const std::string& name : holds.names()) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    throw ConfigError(fmt::format("{}: '{}' in 'holds' is none of 'values'; expected one of {}{}",
                                  section.place(), name, fmt::join(known, ", "), suggestion(name, known)));
  }
}

/// Judges a claim over those runs that meet some conditions, too.
Finding judge(const Parameters& section, const Expression& holds, const std::vector<RunRow>& rows,
              const FramesOf& frames_of, const std::vector<std::string>& conditions) {
  Finding finding{section.text("claim"), "", section.text("holds"), {}, Finding::Verdict::unknown, ""};
  Numbers numbers;
  for (const auto& [name, value] : section.sections("values")) {
    const Measure measure(value, rows, frames_of);
    const double number = measure.sample(conditions).statistic(value.text("statistic"));
    if (std::isfinite(number)) {
      numbers[name] = number;
      finding.values.emplace_back(name, number);
    } else if (finding.reason.empty()) {
      finding.reason = measure.missing().empty() ? fmt::format("no run has '{}'", name) : measure.missing();
    }
  }
  const auto verdict = holds.value(numbers);
  if (!verdict) return finding;
  finding.reason = "";
  finding.verdict = *verdict != 0 ? Finding::Verdict::confirmed : Finding::Verdict::not_confirmed;
  return finding;
}

}  // namespace

ParameterTable claim_table() {
  return {
      text("claim").doc("in words"),
      text("each").optional().doc("an axis: judged for each value on it by itself"),
      groups("values", value_table()).at_least(1).doc("numbers of the runs, by name"),
      text("holds").doc("a condition over these names, as in adaptive <= 1.05 * uniform"),
  };
}

std::vector<Finding> make_findings(const Parameters& section, const std::vector<RunRow>& rows,
                                   const FramesOf& frames_of) {
  const Expression holds(section.text("holds"), section.place());
  check_names(holds, section);
  if (!section.has("each")) return {judge(section, holds, rows, frames_of, {})};
  const std::string& axis = section.text("each");
  std::vector<Finding> findings;
  for (const std::string& value : values_on(axis, rows, section.place())) {
    findings.push_back(judge(section, holds, rows, frames_of, {condition(axis, value)}));
    findings.back().scope = fmt::format("{}: {}", axis, value);
  }
  return findings;
}

}  // namespace pliant
