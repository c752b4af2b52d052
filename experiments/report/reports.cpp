#include "experiments/report/reports.h"

namespace pliant {

void register_reports(Registry& registry) {
#define PLIANT_REGISTER_REPORT(NAME) register_##NAME##_report(registry);
  PLIANT_REPORTS(PLIANT_REGISTER_REPORT)
#undef PLIANT_REGISTER_REPORT
}

}  // namespace pliant
