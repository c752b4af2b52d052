#pragma once

#include <string>
#include <vector>

#include "framework/core/registry.h"
#include "framework/pose/alignment.h"
#include "framework/pose/rigid_icp.h"

namespace pliant {

/// Rigid ICP from where `start` (mm, camera frame) puts the source.
RigidIcpResult run_icp(const AlignmentInput& input, const RigidIcpOptions& options,
                       const Eigen::Isometry3d& start);

/// Whether ICP brought the source clearly nearer: its two-way residual falls by a third at least. A
/// deformation leaves a residual that moving the whole hardly lowers.
bool is_clearly_nearer(const RigidIcpResult& result);

/// Whether ICP lowered the two-way residual at all.
bool is_nearer(const RigidIcpResult& result);

/// What came of it, in words: "ICP: two-way residual 14.7 -> 1.6 mm, ..."
std::string described(const RigidIcpResult& result);

/// The rows of `RigidIcpOptions` in an experiment file, and what they say.
std::vector<Parameter> icp_rows();
RigidIcpOptions read_icp_options(const Parameters& section);

/// Adds the alignment `icp`.
void register_icp_alignment(Registry& registry);

}  // namespace pliant
