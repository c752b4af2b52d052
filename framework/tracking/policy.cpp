#include "framework/tracking/policy.h"

#include <memory>

namespace pliant {
namespace {

class RigidOnly : public Policy {
 public:
  bool registers(const TrackingError&, int) const override { return false; }
};

class EveryN : public Policy {
 public:
  explicit EveryN(int n) : n_(n) {}
  bool registers(const TrackingError&, int frame) const override { return frame % n_ == 0; }

 private:
  int n_;
};

class Adaptive : public Policy {
 public:
  explicit Adaptive(double threshold) : threshold_(threshold) {}
  bool registers(const TrackingError& rigid, int) const override { return rigid.mean > threshold_; }

 private:
  double threshold_;
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
      {real("threshold", 2)
           .unit("mm")
           .at_least(0)
           .doc("A greater mean error of rigid tracking is a failure; 0: every frame is one")},
      [](const Parameters& section, const Registry&) {
        return std::make_unique<Adaptive>(section.real("threshold"));
      });
}

}  // namespace pliant
