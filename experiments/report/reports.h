#pragma once

#include "framework/core/registry.h"

namespace pliant {

/// The reports there are, in the order in which they are listed. A new one is its own source file and its
/// name on this line (docs/adding-a-component.md).
#define PLIANT_REPORTS(REPORT) REPORT(surfaces) REPORT(pictures) REPORT(page) REPORT(view)

#define PLIANT_DECLARE_REPORT(NAME) void register_##NAME##_report(Registry& registry);
PLIANT_REPORTS(PLIANT_DECLARE_REPORT)
#undef PLIANT_DECLARE_REPORT

/// Adds every report.
void register_reports(Registry& registry);

}  // namespace pliant
