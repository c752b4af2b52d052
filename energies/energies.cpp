#include "energies/energies.h"

namespace pliant {

void register_energies(Registry& registry) {
#define PLIANT_REGISTER_ENERGY(NAME) register_##NAME(registry);
  PLIANT_ENERGIES(PLIANT_REGISTER_ENERGY)
#undef PLIANT_REGISTER_ENERGY
}

}  // namespace pliant
