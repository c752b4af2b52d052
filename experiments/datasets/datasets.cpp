#include "experiments/datasets/datasets.h"

#include "experiments/datasets/deepdeform.h"
#include "experiments/datasets/image_folder.h"
#include "experiments/datasets/mesh_sources.h"
#include "experiments/datasets/openni.h"
#include "experiments/datasets/rendered_mesh.h"
#include "experiments/datasets/rgbd_pair.h"
#include "experiments/datasets/surface_pair.h"
#include "experiments/datasets/synthetic_sheet.h"
#include "experiments/datasets/tum.h"

namespace pliant {

void register_datasets(Registry& registry) {
  register_deepdeform(registry);
  register_image_folder(registry);
  register_figures(registry, figure_kinds());
  register_gltf(registry);
  register_openni(registry);
  register_rendered_mesh(registry);
  register_rgbd_pair(registry);
  register_surface_pair(registry);
  register_synthetic_sheet(registry);
  register_tum(registry);
}

}  // namespace pliant
