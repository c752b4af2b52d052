#include "solvers/gauss_newton/reductions.h"

#include <fmt/format.h>

#include "solvers/gauss_newton/reductions.cl.embed.h"

namespace pliant {

std::string with_reductions(std::string_view source, std::size_t group_size) {
  return fmt::format("#define GROUP_SIZE {}\n{}{}", group_size, embedded::solvers_gauss_newton_reductions_cl,
                     source);
}

}  // namespace pliant
