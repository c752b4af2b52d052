#include "framework/problem/equation_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "framework/problem/loss.h.embed.h"
#include "framework/problem/transform.cl.embed.h"

namespace pliant {
namespace {

std::string without_preprocessor_includes(std::string_view source) {
  std::string text;
  text.reserve(source.size() + 1);  // it is made for every problem, of which a stream has many
  std::size_t begin = 0;
  while (begin < source.size()) {
    const auto end = std::min(source.find('\n', begin), source.size());
    const auto line = source.substr(begin, end - begin);
    if (!line.starts_with("#include") && !line.starts_with("#pragma once")) text.append(line) += '\n';
    begin = end + 1;
  }
  return text;
}

}  // namespace

std::string as_opencl(std::string_view source, const std::string& real) {
  return "#undef PLIANT_EQUATION\n#define PLIANT_EQUATION static inline\n#undef Real\n#define Real " + real +
         "\n" + without_preprocessor_includes(source);
}

std::string equation_source(const Energy& energy, const std::string& real) {
  return as_opencl(energy.equation.source, real);
}

std::string transform_source(const NodeTransform& transform, int stride) {
  return fmt::format(
      "{0}\n#define UNKNOWNS {1}\n#define STRIDE {2}\n#define RETRACT {3}_retract\n#define PULL_BACK "
      "{3}_pull_back\n#define NEAREST {3}_nearest\n{4}",
      as_opencl(transform.source, "float"), transform.unknowns, stride, transform.name,
      embedded::framework_problem_transform_cl);
}

std::string losses_source(const std::string& real) {
  return as_opencl(embedded::framework_problem_loss_h, real);
}

std::string loss_choice_source(const Loss& loss) {
  return fmt::format(
      "#undef LOSS_VALUE\n#undef LOSS_WEIGHT\n#define LOSS_VALUE(s, scale) {0}_value(s, scale)\n"
      "#define LOSS_WEIGHT(s, scale) {0}_weight(s, scale)\n",
      loss.name);
}

std::string loss_source(const Loss& loss, const std::string& real) {
  return losses_source(real) + loss_choice_source(loss);
}

}  // namespace pliant
