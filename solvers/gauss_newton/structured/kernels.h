#pragma once

#include <string>
#include <vector>

#include "framework/problem/problem.h"

namespace pliant {

/// Whether an energy's J^T J is M (x) I_3 and does not change from step to step: then it is assembled once.
bool enters_matrix(const Energy& energy);

/// The kernels of an energy per edge or per constraint, named after it: evaluate, of edges lever_arms, of
/// what does not enter the matrix change. They take K, the slots of an instance, as an option.
std::string instance_terms_source(const Energy& energy);

/// The kernels that assemble and minimise. `terms`: those per node; `slots`: of a constraint; `coupled`:
/// whether a term of constraints does not enter the matrix; `group_size`: work-items of the one work-group
/// that minimises.
std::string minimiser_source(const std::vector<const Term*>& terms, int slots, bool coupled,
                             std::size_t group_size);

}  // namespace pliant
