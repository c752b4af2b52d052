#pragma once

#include <memory>
#include <vector>

#include "framework/imaging/depth_filter.h"
#include "framework/pose/alignment.h"
#include "framework/registration/nonrigid_method.h"

namespace pliant {

/// How a pair is registered: what comes before non-rigid registration, and that.
struct Method : NonRigidMethod {
  std::unique_ptr<DepthFilter> filter;         ///< of the target, and of the source where that has none
  std::unique_ptr<DepthFilter> source_filter;  ///< null: `filter`
  std::unique_ptr<Alignment> alignment;
};

/// The rows of an experiment file that describe a method.
std::vector<Parameter> method_rows();

/// Assembles the method that an experiment describes. Throws ConfigError for a combination that makes no
/// sense.
Method make_method(const Parameters& experiment, const Registry& registry);

}  // namespace pliant
