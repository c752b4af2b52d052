#include <memory>
#include <utility>

#include "framework/model/reintegration.h"
#include "framework/model/tsdf.h"
#include "framework/model/warp_field.h"

namespace pliant {
namespace {

class ReintegrationKind : public ModelUpdate {
 public:
  explicit ReintegrationKind(const Parameters& section)
      : weight_(static_cast<int>(section.integer("weight"))) {}

  std::unique_ptr<DeformingModel> make(Device& device, std::unique_ptr<ReferenceModel> model) const override {
    return std::make_unique<Reintegration>(device, std::move(model), weight_);
  }

 private:
  int weight_;
};

}  // namespace

void register_model_updates(Registry& registry) {
  registry.add<ModelUpdate>(
      "reintegration", "The deformed surface is fused into the model, as frames are [4.8]",
      {integer("weight", 64)
           .range(1, Tsdf::greatest_weight)
           .doc("Frames that it counts as: beside those that the model was fused from before")},
      [](const Parameters& section, const Registry&) {
        return std::make_unique<ReintegrationKind>(section);
      });
  register_warp_field(registry);
}

}  // namespace pliant
