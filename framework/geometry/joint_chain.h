#pragma once

#include <string>
#include <vector>

namespace pliant {

/// Builds chains of joints that are all children of one joint from what they are called. Takes the names of
/// all joints and their parents (-1: none) and gives the parents that they get; among the children of each
/// joint, each rule stated once:
///  - Numbers: names that differ in a number at their end only (`tail_1 tail_2`, `tail tail.001`, `tail1
///    tail2`) hang one on the other by their numbers.
///  - Bones: names that differ in the bone only, `metacarpal`, `proximal`, `intermediate`, `distal` and
///  `tip`,
///    hang one on the other in this order, whichever of them there are. Words are parted by `-`, `_`, `.`,
///    blanks or a capital letter and may stand in any order; `phalanx` says nothing. So
///    `index-finger-metacarpal, index-finger-phalanx-proximal, ..., index-finger-tip`, as hands of WebXR have
///    it.
///  - Wrist: the first bone of each of these chains hangs on the `wrist` whose other words, as `left`, it has
///    too.
/// All other joints keep their parent.
std::vector<int> chained_parents(const std::vector<std::string>& names, const std::vector<int>& parents);

}  // namespace pliant
