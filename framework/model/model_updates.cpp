#include "framework/model/warp_field.h"

namespace pliant {

void register_model_updates(Registry& registry) { register_warp_field(registry); }

}  // namespace pliant
