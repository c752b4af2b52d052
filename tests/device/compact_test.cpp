#include "framework/device/compact.h"

#include <gmock/gmock.h>

#include <random>

namespace pliant {
namespace {

std::vector<int> random_flags(std::size_t count, double share) {
  std::mt19937 generator(static_cast<unsigned>(count));
  std::bernoulli_distribution raised(share);
  std::uniform_int_distribution<int> value(-3, -1);  // any value but zero counts
  std::vector<int> flags(count, 0);
  for (int& flag : flags)
    if (raised(generator)) flag = value(generator);
  return flags;
}

TEST(Compact, KeepsWhatIsNotZeroInOrder) {
  Device device;
  EXPECT_THAT(compact(device, "test", Array<int>({0, 5, 0, 0, -1, 1})).host(), testing::ElementsAre(1, 4, 5));
}

TEST(Compact, AgreesWithItsReferenceAroundTheEndsOfChunks) {
  Device device;
  for (const std::size_t count : {1, 255, 256, 257, 4095, 4096, 4097, 30001})
    for (const double share : {0.0, 0.02, 0.5, 1.0}) {
      const std::vector<int> flags = random_flags(count, share);
      EXPECT_EQ(compact(device, "test", Array<int>(flags)).host(), compact_reference(flags))
          << count << " flags, " << share << " of them raised";
    }
}

TEST(Compact, OfNothingIsNothing) {
  Device device;
  EXPECT_TRUE(compact(device, "test", Array<int>(std::vector<int>())).host().empty());
}

}  // namespace
}  // namespace pliant
