#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "experiments/modeller/figure.h"
#include "experiments/training/draw.h"

namespace pliant {

/// A figure of one kind, its identity drawn at random.
Figure random_figure(const FigureKind& kind, Draw& draw);

/// Its vertices, mm in its own frame, in a form drawn at random: some share of some of its poses.
std::vector<Eigen::Vector3d> random_form(const Figure& figure, Draw& draw);

/// Makes more of a few heads: stretches one along its axes, dents it a little here and there, and may give it
/// hair. `strength`: of the usual; 0 changes nothing.
void vary_head(std::vector<Eigen::Vector3d>& vertices, double strength, Draw& draw);

/// Bends the neck, so that the shoulders stay while the head turns: from the head's frame to a camera's.
/// `camera_from_shoulders`: of the same origin.
void bend_neck(std::vector<Eigen::Vector3d>& vertices, const Eigen::Isometry3d& camera_from_head,
               const Eigen::Isometry3d& camera_from_shoulders);

}  // namespace pliant
