#include "framework/problem/equation_source.h"

#include <algorithm>
#include <string_view>

namespace pliant {
namespace {

std::string without_preprocessor_includes(std::string_view source) {
  std::string text;
  std::size_t begin = 0;
  while (begin < source.size()) {
    const auto end = std::min(source.find('\n', begin), source.size());
    const auto line = source.substr(begin, end - begin);
    if (!line.starts_with("#include") && !line.starts_with("#pragma once")) text += std::string(line) + "\n";
    begin = end + 1;
  }
  return text;
}

}  // namespace

std::string equation_source(const Energy& energy, const std::string& real) {
  return "#undef PLIANT_EQUATION\n#define PLIANT_EQUATION static inline\n#undef Real\n#define Real " + real +
         "\n" + without_preprocessor_includes(energy.equation.source);
}

}  // namespace pliant
