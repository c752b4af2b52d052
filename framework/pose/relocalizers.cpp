#include <memory>

#include "framework/pose/features_relocalizer.h"
#include "framework/pose/head_relocalizer.h"
#include "framework/pose/relocalizer.h"

namespace pliant {
namespace {

class NoRelocalizer : public RelocalizerKind {
 public:
  std::unique_ptr<Relocalizer> make(Device&, const Rig&) const override { return nullptr; }
};

}  // namespace

void register_relocalizers(Registry& registry) {
  registry.add<RelocalizerKind>(
      "none", "What is lost is found again only near to its last pose", {},
      [](const Parameters&, const Registry&) { return std::make_unique<NoRelocalizer>(); });
  register_features_relocalizer(registry);
  register_head_relocalizer(registry);
}

}  // namespace pliant
