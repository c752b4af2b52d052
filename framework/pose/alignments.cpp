#include "framework/pose/alignments.h"

#include <memory>

#include "framework/pose/align_automatic.h"
#include "framework/pose/align_features.h"
#include "framework/pose/align_icp.h"
#include "framework/pose/alignment.h"

namespace pliant {
namespace {

class NoAlignment : public Alignment {
 public:
  AlignmentResult align(const AlignmentInput&) const override { return {}; }
};

}  // namespace

void register_alignments(Registry& registry) {
  registry.add<Alignment>("none", "Leaves the source where it is", {},
                          [](const Parameters&, const Registry&) { return std::make_unique<NoAlignment>(); });
  register_feature_alignment(registry);
  register_icp_alignment(registry);
  register_automatic_alignment(registry);
}

}  // namespace pliant
