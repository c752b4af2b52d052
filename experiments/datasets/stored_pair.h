#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/datasets/frame_source.h"

namespace pliant {

/// What a stream of two frames gives.
struct StoredPair {
  std::string name;
  Rig rig;
  Frame source;
  Frame target;
  std::optional<PairTruth> truth;
  std::vector<std::string> warnings;
};

/// A stream of the source and, a thirtieth of a second later, the target.
class StoredPairStream : public DataStream {
 public:
  explicit StoredPairStream(StoredPair pair);
  std::string name() const override { return pair_.name; }
  const Rig& rig() const override { return pair_.rig; }
  std::optional<Frame> next() override;
  std::vector<std::string> warnings() const override { return pair_.warnings; }
  bool reads_on_host() const override { return true; }
  std::optional<PairTruth> truth(int number) const override;

 private:
  StoredPair pair_;
  int given_ = 0;
};

}  // namespace pliant
