#include "framework/tracking/policy.h"

#include <memory>

namespace pliant {
namespace {

class RigidOnly : public Policy {
 public:
  bool registers(const PolicyInput&) const override { return false; }
  bool is_rigid() const override { return true; }
};

class EveryN : public Policy {
 public:
  explicit EveryN(int n) : n_(n) {}
  bool registers(const PolicyInput& input) const override { return input.frame % n_ == 0; }

 private:
  int n_;
};

class Adaptive : public Policy {
 public:
  Adaptive(double threshold, int patience, double growth)
      : threshold_(threshold), patience_(patience), growth_(growth) {}

  bool registers(const PolicyInput& input) const override {
    const double error = input.rigid.mean;
    if (!(error > threshold_)) return false;
    const auto& rejection = input.rejection;
    return !rejection || input.frame - rejection->frame > patience_ ||
           error > (1 + growth_) * rejection->error;
  }

 private:
  double threshold_;
  int patience_;
  double growth_;
};

}  // namespace

void register_policies(Registry& registry) {
  registry.add<Policy>("rigid_only", "Never: the model is taken to be rigid", {},
                       [](const Parameters&, const Registry&) { return std::make_unique<RigidOnly>(); });
  registry.add<Policy>("every_n", "In every n-th frame (NRn of the thesis)",
                       {integer("n", 5).range(1, 1e6).doc("Frames from one registration to the next")},
                       [](const Parameters& section, const Registry&) {
                         return std::make_unique<EveryN>(static_cast<int>(section.integer("n")));
                       });
  registry.add<Policy>(
      "adaptive", "Where rigid tracking fails, the sign of a deformation (NRAdaptive of the thesis)",
      {real("threshold", 0.4)
           .unit("mm")
           .at_least(0)
           .doc("A greater mean error of rigid tracking is a failure; 0: every frame is one"),
       integer("patience", 5)
           .unit("frame")
           .range(0, 1e6)
           .doc("After a registration that gained nothing it is not tried again for so many"),
       real("growth", 0.25).at_least(0).doc("unless the error has grown by this share since")},
      [](const Parameters& section, const Registry&) {
        return std::make_unique<Adaptive>(
            section.real("threshold"), static_cast<int>(section.integer("patience")), section.real("growth"));
      });
}

}  // namespace pliant
