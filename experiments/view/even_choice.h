#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace pliant {

/// Some values of a sequence whose length nobody knows yet, evenly spaced from the first one on: where there
/// would be more than `most`, every other one goes, so that at least half as many are left.
template <class T>
class EvenChoice {
 public:
  explicit EvenChoice(std::size_t most) : most_(most) {}

  /// To be asked once for each value in turn: whether it is to be kept.
  bool takes_next() { return count_++ % stride_ == 0; }
  void keep(T value) {
    kept_.push_back(std::move(value));
    if (kept_.size() <= most_) return;
    for (std::size_t i = 1; 2 * i < kept_.size(); ++i) kept_[i] = std::move(kept_[2 * i]);
    kept_.erase(kept_.begin() + static_cast<std::ptrdiff_t>((kept_.size() + 1) / 2), kept_.end());
    stride_ *= 2;
  }
  const std::vector<T>& kept() const { return kept_; }

 private:
  std::size_t most_;
  std::size_t stride_ = 1;
  std::size_t count_ = 0;
  std::vector<T> kept_;
};

}  // namespace pliant
