#include "framework/device/device.h"

#include <gmock/gmock.h>
#include <malloc.h>

#include <functional>

#include "framework/core/error.h"
#include "framework/device/array.h"

namespace pliant {
namespace {

constexpr auto kScale = R"(
kernel void scale(int count, float factor, global float* values) {
  const int i = get_global_id(0);
  if (i < count) values[i] = factor * values[i];
})";

/// What the DeviceError of `action` says; empty when there is none.
std::string device_error(const std::function<void()>& action) {
  try {
    action();
  } catch (const DeviceError& error) {
    EXPECT_EQ(error.exit_code(), 4);
    return error.what();
  }
  return "";
}

TEST(Device, ListsWhatCanBeOpened) {
  const auto devices = Device::list();
  ASSERT_FALSE(devices.empty());
  for (const auto& info : devices) {
    EXPECT_FALSE(info.name.empty());
    EXPECT_FALSE(info.platform.empty());
    EXPECT_THAT(info.version, testing::StartsWith("OpenCL "));
    EXPECT_GT(info.compute_units, 0);
    EXPECT_GT(info.memory_bytes, 0U);
    EXPECT_GT(info.most_bytes, 0U);
    EXPECT_EQ(Device(info.name).info().is_gpu, info.is_gpu);
  }
  for (std::size_t i = 1; i < devices.size(); ++i)
    EXPECT_LE(devices[i - 1].is_gpu, devices[i].is_gpu) << "processors come first";
}

TEST(Device, IsChosenByKindOrByAnyPartOfItsNameOrPlatform) {
  const auto first = Device::list().front();
  EXPECT_EQ(Device().info().name, first.name);
  EXPECT_EQ(Device("ANY").info().name, first.name);
  EXPECT_EQ(Device(first.is_gpu ? "gpu" : "cpu").info().is_gpu, first.is_gpu);
  std::string shouted = first.platform;
  for (auto& letter : shouted) letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  EXPECT_EQ(Device(shouted).info().platform, first.platform);
  EXPECT_EQ(Device(first.name).width(), first.is_gpu ? 1 : 16);
}

TEST(Device, ShapesItsKernelsByItsKindUnlessToldOtherwise) {
  const auto first = Device::list().front();
  EXPECT_EQ(Device(first.name).work_group_size(), first.is_gpu ? 128 : 1);
  const Device told(first.name, {1, 8, ""});
  EXPECT_EQ(told.width(), 1);
  EXPECT_EQ(told.work_group_size(), 8);
  const Device half_told(first.name, {{}, 8, ""});
  EXPECT_EQ(half_told.width(), Device(first.name).width());
}

TEST(Device, RefusesShapesThatNoKernelHas) {
  const auto refusal = [](const DeviceOptions& options) {
    return device_error([&] { Device device("any", options); });
  };
  for (const int width : {-1, 0, 2, 32})
    EXPECT_EQ(refusal({width, {}, ""}), "a vector width of " + std::to_string(width) + "; expected 1 or 16");
  for (const int size : {-8, 0, 3, 96})
    EXPECT_EQ(refusal({{}, size, ""}),
              "a work-group of " + std::to_string(size) + " work-items; expected a power of two");
  EXPECT_THAT(refusal({{}, 1 << 30, ""}), testing::HasSubstr("too large for " + Device().info().name));
}

TEST(Device, AnUnknownNameIsAnsweredWithTheKnownOnes) {
  const auto message = device_error([] { Device device("abacus"); });
  EXPECT_THAT(message, testing::HasSubstr("'abacus'"));
  EXPECT_THAT(message, testing::HasSubstr(Device::list().front().name));
}

TEST(Device, AFailedBuildShowsTheLog) {
  Device device;
  const auto message = device_error(
      [&] { device.kernel("kernel void broken(global int* x) { x[0] = missing_name; }", "broken"); });
  EXPECT_THAT(message, testing::HasSubstr("kernel broken"));
  EXPECT_THAT(message, testing::HasSubstr(device.info().name));
  EXPECT_THAT(message, testing::HasSubstr("missing_name"));
  EXPECT_NE(device_error([&] { device.kernel(kScale, "no_such_kernel"); }), "");
  EXPECT_NO_THROW(device.kernel(kScale, "scale")) << "a failure leaves the device usable";
}

TEST(Device, KernelsSeeTheWidthAndTheirOptions) {
  Device device;
  auto kernel = device.kernel("kernel void tell(global int* out) { out[0] = WIDTH; out[1] = ANSWER; }",
                              "tell", "-DANSWER=42");
  Array<int> told(2);
  device.run("tell", kernel, 1, 1, told.write_device(device));
  EXPECT_THAT(told.host(), testing::ElementsAre(device.width(), 42));
  auto other = device.kernel("kernel void tell(global int* out) { out[0] = WIDTH; out[1] = ANSWER; }", "tell",
                             "-DANSWER=43");
  device.run("tell", other, 1, 1, told.write_device(device));
  EXPECT_THAT(told.host(), testing::ElementsAre(device.width(), 43)) << "other options, another program";
}

TEST(Device, BuildsEveryProgramWithItsOwnOptions) {
  Device device("any", {1, {}, "-DANSWER=42"});
  auto kernel =
      device.kernel("kernel void tell(global int* out) { out[0] = WIDTH; out[1] = ANSWER; }", "tell");
  Array<int> told(2);
  device.run("tell", kernel, 1, 1, told.write_device(device));
  EXPECT_THAT(told.host(), testing::ElementsAre(1, 42));
}

TEST(Device, CountsTheProgramsItBuilt) {
  Device device;
  EXPECT_EQ(device.programs_built(), 0);
  device.kernel(kScale, "scale");
  device.kernel(kScale, "scale");
  EXPECT_EQ(device.programs_built(), 1) << "made once and kept";
  device.kernel(kScale, "scale", "-DANSWER=42");
  EXPECT_EQ(device.programs_built(), 2) << "other options, another program";
  EXPECT_THROW(device.kernel("kernel void broken( {", "broken"), DeviceError);
  EXPECT_EQ(device.programs_built(), 2);
}

TEST(Device, RoundsTheRangeUpToWholeGroups) {
  Device device;
  auto kernel = device.kernel(
      "kernel void count(global int* out) { out[get_global_id(0)] = get_global_size(0); }", "count");
  Array<int> sizes(std::vector<int>(64, -1));
  device.run("count", kernel, 33, 32, sizes.write_device(device));
  EXPECT_THAT(sizes.host(), testing::Each(64));
  Array<int> untouched(std::vector<int>{7});
  device.run("count", kernel, 0, 32, untouched.write_device(device));
  EXPECT_THAT(untouched.host(), testing::ElementsAre(7)) << "an empty range runs nothing";
}

TEST(Device, ARejectedArgumentOrLaunchSaysWhich) {
  Device device;
  auto kernel = device.kernel(kScale, "scale");
  const Array<float> values(std::vector<float>(4, 1));
  const auto wrong_argument =
      device_error([&] { device.run("scale", kernel, 4, 0, cl_int{4}, double{2}, values.device(device)); });
  EXPECT_THAT(wrong_argument, testing::HasSubstr("argument 1 of scale"));
  const auto too_large_a_group = device_error(
      [&] { device.run("scale", kernel, 1, std::size_t{1} << 40, cl_int{4}, 2.0F, values.device(device)); });
  EXPECT_THAT(too_large_a_group, testing::HasSubstr("running kernel scale"));
}

TEST(Device, MeasuresStagesOnlyWhenAsked) {
  Device device;
  auto kernel = device.kernel(kScale, "scale");
  Array<float> values(std::vector<float>(1 << 20, 1));
  const auto run = [&](const char* stage) {
    device.run(stage, kernel, values.size(), 64, static_cast<cl_int>(values.size()), 1.5F,
               values.write_device(device));
  };
  run("unmeasured");
  EXPECT_TRUE(device.take_stage_times().empty());

  device.measure_stages(true);
  run("first");
  const double once = device.take_stage_times().at("first");
  EXPECT_GT(once, 0);
  for (int i = 0; i < 50; ++i) run("many");
  run("other");
  const auto times = device.take_stage_times();
  EXPECT_EQ(times.size(), 2U) << "what was taken before is gone";
  EXPECT_GT(times.at("many"), times.at("other")) << "fifty launches add up";
  device.measure_stages(false);
  run("unmeasured");
  EXPECT_TRUE(device.take_stage_times().empty());
}

TEST(Device, AnAllocationThatDoesNotFitNamesItsSizeAndTheDevices) {
  Device device;
  const auto& info = device.info();
  for (const std::size_t bytes : {std::size_t{1} << 50, info.most_bytes + 1}) {
    for (const auto& message : {device_error([&] { device.allocate(bytes); }),
                                device_error([&] { device.upload(&bytes, bytes); })}) {
      EXPECT_THAT(message, testing::HasSubstr("of " + std::to_string(bytes) + " bytes"));
      EXPECT_THAT(message, testing::HasSubstr(info.name));
      EXPECT_THAT(message, testing::HasSubstr("one may have " + std::to_string(info.most_bytes)));
      EXPECT_THAT(message, testing::HasSubstr("all together " + std::to_string(info.memory_bytes)));
    }
  }
  EXPECT_NO_THROW(device.allocate(16)) << "a failure leaves the device usable";
}

TEST(Device, TransfersBeyondABufferAreRefused) {
  Device device;
  const auto buffer = device.allocate(16);
  std::vector<char> bytes(100000);  // more than whatever a buffer is rounded up to
  EXPECT_THAT(device_error([&] { device.write(buffer, bytes.data(), bytes.size()); }),
              testing::HasSubstr("writing 100000 bytes"));
  EXPECT_THAT(device_error([&] { device.read(buffer, bytes.data(), bytes.size()); }),
              testing::HasSubstr("reading 100000 bytes"));
  EXPECT_THAT(device_error([&] { device.fill_zero(buffer, bytes.size()); }),
              testing::HasSubstr("clearing 100000 bytes"));
}

TEST(Device, ClearsBuffers) {
  Device device;
  Array<float> values(std::vector<float>{1, 2, 3});
  device.fill_zero(values.write_device(device), 2 * sizeof(float));
  EXPECT_THAT(values.host(), testing::ElementsAre(0, 0, 3));
}

TEST(Device, UploadsCopiesThatMayChangeOnTheHostAtOnce) {
  Device device;
  auto kernel = device.kernel(kScale, "scale");
  std::vector<Buffer> buffers;
  for (int round = 0; round < 1000; ++round) {  // more than what is on its way at once may have
    std::vector<float> values(1000, static_cast<float>(round));
    buffers.push_back(device.upload(values));
    std::fill(values.begin(), values.end(), -1.0F);
    device.run("scale", kernel, values.size(), 0, static_cast<cl_int>(values.size()), 2.0F, buffers.back());
  }
  for (int round = 0; round < 1000; ++round) {
    std::vector<float> values(1000);
    device.read(buffers[static_cast<std::size_t>(round)], values.data(), sizeof(float) * values.size());
    ASSERT_THAT(values, testing::Each(2.0F * static_cast<float>(round)));
  }
}

// A ring of a megabyte has room for so many of them that what drivers keep of each would add up.
TEST(Device, ManySmallUploadsTakeNoMoreMemoryThanSome) {
  Device device;
  const std::vector<float> values(1, 1);
  std::size_t bytes = 0;
  for (int i = 0; i < 20000; ++i) {
    device.upload(values);
    if (i == 2000) bytes = mallinfo2().uordblks;
  }
  device.finish();
  EXPECT_LT(mallinfo2().uordblks, bytes + (1 << 20)) << "a hundred bytes an upload would be more";
}

TEST(Device, UsesDroppedMemoryAgain) {
  Device device;
  const auto round = [&](std::size_t count) {
    const std::vector<float> values(count, 3);
    const auto uploaded = device.upload(values);
    const auto other = device.copy(uploaded, sizeof(float) * count);
    std::vector<float> back(count);
    device.read(other, back.data(), sizeof(float) * count);
    EXPECT_EQ(back, values);
  };
  round(100000);
  const auto once = device.counts().allocations;
  EXPECT_GE(once, 3U) << "two buffers, and the copy on its way";
  for (std::size_t i = 0; i < 20; ++i) round(100000 - 10 * i);
  EXPECT_EQ(device.counts().allocations, once) << "smaller ones fit into what is there";
  const auto held = device.allocate(400000);
  round(100000);
  EXPECT_EQ(device.counts().allocations, once + 1) << "what is held is given to nobody else";
}

TEST(Device, CountsWhatGoesToAndFro) {
  Device device;
  const std::vector<float> values(10, 1);
  std::vector<float> back(10);
  const auto buffer = device.upload(values);
  device.write(buffer, values.data(), 8);
  device.read(buffer, back.data(), 12);
  device.upload(std::vector<float>{});
  device.read(buffer, back.data(), 0);
  const DeviceCounts counts = device.counts();
  EXPECT_EQ(counts.uploads, 2U);
  EXPECT_EQ(counts.uploaded_bytes, 48U);
  EXPECT_EQ(counts.reads, 1U);
  EXPECT_EQ(counts.read_bytes, 12U);
}

}  // namespace
}  // namespace pliant
