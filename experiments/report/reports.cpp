#include "experiments/report/reports.h"

#include "experiments/report/page.h"
#include "experiments/report/pictures.h"
#include "experiments/report/surfaces.h"

namespace pliant {

void register_reports(Registry& registry) {
  register_surfaces_report(registry);
  register_pictures_report(registry);
  register_page_report(registry);
}

}  // namespace pliant
