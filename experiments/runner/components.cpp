#include "experiments/runner/components.h"

#include "energies/energies.h"
#include "experiments/datasets/datasets.h"
#include "experiments/report/reports.h"
#include "framework/deformation/node_transform.h"
#include "framework/imaging/depth_filter.h"
#include "framework/imaging/normals.h"
#include "framework/model/reference_model.h"
#include "framework/pose/alignments.h"
#include "framework/pose/pose_estimator.h"
#include "framework/pose/relocalizer.h"
#include "framework/registration/correspondence.h"
#include "framework/registration/handle.h"
#include "framework/segmentation/segmentations.h"
#include "graphs/graphs.h"
#include "samplers/samplers.h"
#include "solvers/solvers.h"

namespace pliant {

void register_everything(Registry& registry) {
  register_datasets(registry);
  register_filters(registry);
  register_normals(registry);
  register_segmentations(registry);
  register_models(registry);
  register_alignments(registry);
  register_pose_estimators(registry);
  register_relocalizers(registry);
  register_graphs(registry);
  register_transforms(registry);
  register_samplers(registry);
  register_correspondences(registry);
  register_handles(registry);
  register_energies(registry);
  register_solvers(registry);
  register_reports(registry);
}

}  // namespace pliant
