#include "experiments/datasets/stored_pair.h"

#include <utility>

namespace pliant {

StoredPairStream::StoredPairStream(StoredPair pair) : pair_(std::move(pair)) {
  pair_.source.time = 0;
  pair_.target.time = 1 / frame_rate;
}

std::optional<Frame> StoredPairStream::next() {
  ++given_;
  if (given_ == 1) return std::move(pair_.source);
  if (given_ == 2) return std::move(pair_.target);
  return std::nullopt;
}

std::optional<PairTruth> StoredPairStream::truth(int number) const {
  return number == 2 ? pair_.truth : std::nullopt;
}

}  // namespace pliant
