#include "framework/device/array.h"

#include <gmock/gmock.h>

#include <numeric>

namespace pliant {
namespace {

using testing::ElementsAre;

class ArrayTest : public testing::Test {
 protected:
  void add(Array<float>& values, float summand, Device& device) {
    auto kernel = device.kernel(
        "kernel void add(int count, float summand, global float* values) {"
        "  if (get_global_id(0) < count) values[get_global_id(0)] += summand; }",
        "add");
    device.run("add", kernel, values.size(), 16, static_cast<cl_int>(values.size()), summand,
               values.write_device(device));
  }
  void add(Array<float>& values, float summand) { add(values, summand, device_); }

  Device device_;
};

TEST_F(ArrayTest, EachSideSeesWhatTheOtherWrote) {
  Array<float> values(std::vector<float>{1, 2, 3});
  add(values, 10);
  EXPECT_THAT(values.host(), ElementsAre(11, 12, 13)) << "host to device and back";
  values.write_host()[1] = 50;
  add(values, 1);
  EXPECT_THAT(values.host(), ElementsAre(12, 51, 14)) << "a change on the host reaches the device";
  add(values, 1);
  add(values, 1);
  values.write_host()[0] = 0;
  EXPECT_THAT(values.host(), ElementsAre(0, 53, 16)) << "writing on the host starts from the device's values";
}

TEST_F(ArrayTest, CarriesManyValuesUnchanged) {
  std::vector<int> numbers(100003);
  std::iota(numbers.begin(), numbers.end(), -5);
  Array<int> values(numbers);
  values.write_device(device_);  // no kernel follows: the values come back as they went
  EXPECT_EQ(values.host(), numbers);
}

TEST_F(ArrayTest, MayBeWrittenByTheDeviceFirst) {
  Array<float> values(std::size_t{5});
  device_.fill_zero(values.write_device(device_), 5 * sizeof(float));
  add(values, 2);
  EXPECT_THAT(values.host(), testing::AllOf(testing::SizeIs(5), testing::Each(2)));
}

TEST_F(ArrayTest, MayBeEmpty) {
  const Array<float> nothing;
  EXPECT_TRUE(nothing.empty());
  EXPECT_NO_THROW(nothing.device(device_));
  EXPECT_TRUE(nothing.host().empty());
  Array<float> none(std::size_t{0});
  none.write_device(device_);
  EXPECT_TRUE(none.host().empty());
}

TEST_F(ArrayTest, MovesFromOneDeviceToAnother) {
  Device other;
  Array<float> values(std::vector<float>{1, 2});
  add(values, 1);
  add(values, 10, other);
  add(values, 100);
  EXPECT_THAT(values.host(), ElementsAre(112, 113));
}

TEST_F(ArrayTest, ACloneKeepsWhatTheDeviceHadWritten) {
  Array<float> original(std::vector<float>{1, 2});
  add(original, 1);
  const Array<float> copy = original.clone();  // enqueued before what comes next
  add(original, 10);
  EXPECT_THAT(copy.host(), ElementsAre(2, 3));
  EXPECT_THAT(original.host(), ElementsAre(12, 13));
  EXPECT_TRUE(Array<float>(std::size_t{0}).clone().host().empty());
}

TEST_F(ArrayTest, ACloneIsIndependent) {
  Array<float> original(std::vector<float>{1, 2});
  add(original, 1);
  Array<float> copy = original.clone();
  add(copy, 10);
  EXPECT_THAT(copy.host(), ElementsAre(12, 13));
  EXPECT_THAT(original.host(), ElementsAre(2, 3));
  add(original, 1);
  EXPECT_THAT(original.host(), ElementsAre(3, 4)) << "the device's copy too";
  copy = original.clone();
  add(copy, 10);
  EXPECT_THAT(original.host(), ElementsAre(3, 4));
}

TEST_F(ArrayTest, KeepsItsValuesWhenMoved) {
  Array<float> values(std::vector<float>{1, 2});
  add(values, 1);
  Array<float> moved = std::move(values);
  add(moved, 1);
  EXPECT_THAT(moved.host(), ElementsAre(3, 4));
}

TEST_F(ArrayTest, IsFetchedAsItWasThen) {
  Array<float> values(std::vector<float>(100000, 1));
  add(values, 1);
  values.fetch();
  values.fetch();
  EXPECT_THAT(values.host(), testing::Each(2));
  add(values, 1);
  values.fetch();
  add(values, 1);  // later than the copy, which is of no use then
  EXPECT_THAT(values.host(), testing::Each(4));
}

TEST_F(ArrayTest, MayBeMovedReplacedOrDroppedWhileItIsFetched) {
  for (int round = 0; round < 20; ++round) {
    Array<float> values(std::vector<float>(100000, 1));
    add(values, 1);
    values.fetch();
    Array<float> moved = std::move(values);
    Array<float> replaced(std::vector<float>(100000, 5));
    add(replaced, 1);
    replaced.fetch();
    replaced = std::move(moved);
    EXPECT_THAT(replaced.host(), testing::Each(2));
    Array<float> dropped(std::vector<float>(100000, 7));
    add(dropped, 1);
    dropped.fetch();
  }
}

TEST_F(ArrayTest, AskedForWithoutADeviceNothingIsFetched) {
  const Array<float> values(std::vector<float>{1, 2});
  values.fetch();
  EXPECT_THAT(values.host(), ElementsAre(1, 2));
  const Array<float> none;
  none.fetch();
  EXPECT_TRUE(none.host().empty());
}

}  // namespace
}  // namespace pliant
