#include "framework/tracking/method.h"

#include <utility>

namespace pliant {

std::vector<Parameter> method_rows() {
  std::vector<Parameter> rows{
      component("filter", "filter", "none").doc("Noise reduction of both depth images before registration"),
      component("source_filter", "filter").optional().doc("Of the source, where it is another than `filter`"),
      component("alignment", "alignment", "none").doc("Rigid motion from which registration starts"),
  };
  for (Parameter& row : nonrigid_rows()) rows.push_back(std::move(row));
  return rows;
}

Method make_method(const Parameters& experiment, const Registry& registry) {
  std::unique_ptr<DepthFilter> source_filter;
  if (experiment.has("source_filter"))
    source_filter = registry.make<DepthFilter>(experiment.section("source_filter"));
  return {make_nonrigid_method(experiment, registry),
          registry.make<DepthFilter>(experiment.section("filter")), std::move(source_filter),
          registry.make<Alignment>(experiment.section("alignment"))};
}

}  // namespace pliant
