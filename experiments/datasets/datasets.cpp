#include "experiments/datasets/datasets.h"

#include "experiments/datasets/rendered_mesh.h"
#include "experiments/datasets/rgbd_pair.h"
#include "experiments/datasets/synthetic_sheet.h"

namespace pliant {

void register_datasets(Registry& registry) {
  register_rendered_mesh(registry);
  register_rgbd_pair(registry);
  register_synthetic_sheet(registry);
}

}  // namespace pliant
