#include "experiments/study/expression.h"

#include <fmt/format.h>
#include <muParser.h>

#include <cmath>
#include <deque>
#include <utility>

#include "framework/core/error.h"

namespace pliant {
namespace {

/// Whether somewhere a single "=" stands, which the parser takes for an assignment.
bool assigns(const std::string& text) {
  const auto is_of_comparison = [](char before) {
    return std::string("=<>!").find(before) != std::string::npos;
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=' || (i > 0 && is_of_comparison(text[i - 1]))) continue;
    if (i + 1 == text.size() || text[i + 1] != '=') return true;
  }
  return false;
}

}  // namespace

struct Expression::Parser {
  mu::Parser parser;
  std::deque<double> values;  // of the names, in their order; their addresses are the parser's
};

Expression::Expression(const std::string& text, const std::string& place)
    : parser_(std::make_unique<Parser>()) {
  if (assigns(text))
    throw ConfigError(
        fmt::format("{}: '{}' is no formula: '=' gives no name a value; expected '=='", place, text));
  try {
    parser_->parser.DefineNameChars("0123456789_.abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ");
    parser_->parser.SetExpr(text);
    for (const auto& [name, value] : parser_->parser.GetUsedVar()) names_.push_back(name);
    for (const std::string& name : names_) parser_->parser.DefineVar(name, &parser_->values.emplace_back(1));
    parser_->parser.Eval();
  } catch (const mu::ParserError& error) {
    throw ConfigError(fmt::format("{}: '{}' is no formula: {}", place, text, error.GetMsg()));
  }
}

Expression::Expression(Expression&&) noexcept = default;
Expression::~Expression() = default;

std::optional<double> Expression::value(const Numbers& numbers) const {
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const auto found = numbers.find(names_[i]);
    if (found == numbers.end()) return std::nullopt;
    parser_->values[i] = found->second;
  }
  const double value = parser_->parser.Eval();
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

}  // namespace pliant
