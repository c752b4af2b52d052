#include "framework/device/kernel_cache.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <optional>

#include "framework/device/device.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

/// A folder and an environment of the test's own. Not even root can make a folder below a file, so files
/// stand for what cannot be written.
class KernelCache : public testing::Test {
 protected:
  KernelCache() {
    fs::remove_all(root_);
    fs::create_directories(root_ / "tmp");
    std::ofstream(root_ / "file") << "no folder";
    for (const char* name : {"POCL_CACHE_DIR", "XDG_CACHE_HOME", "HOME", "TMPDIR"}) {
      if (const char* value = std::getenv(name)) before_[name] = value;
      unsetenv(name);
    }
    set("TMPDIR", root_ / "tmp");
  }
  ~KernelCache() override {
    for (const char* name : {"POCL_CACHE_DIR", "XDG_CACHE_HOME", "HOME", "TMPDIR"}) unsetenv(name);
    for (const auto& [name, value] : before_) set(name.c_str(), value);
    fs::remove_all(root_);
  }

  static void set(const char* name, const fs::path& value) { setenv(name, value.c_str(), 1); }
  static std::optional<fs::path> told_pocl() {
    const char* value = std::getenv("POCL_CACHE_DIR");
    return value == nullptr ? std::nullopt : std::optional<fs::path>(value);
  }
  fs::path private_folder() const { return root_ / "tmp" / ("pliant-" + std::to_string(geteuid())); }

  const fs::path root_ = fs::path(testing::TempDir()) / ("kernel cache ü " + std::to_string(getpid()));
  std::map<std::string, std::string> before_;
};

TEST_F(KernelCache, IsWherePoclLooksAndThenTheEnvironmentStays) {
  set("HOME", root_ / "home");
  EXPECT_EQ(open_kernel_cache(), root_ / "home/.cache/pocl/kcache");
  set("XDG_CACHE_HOME", root_ / "caches");
  EXPECT_EQ(open_kernel_cache(), root_ / "caches/pocl/kcache");
  EXPECT_EQ(told_pocl(), std::nullopt);
  set("POCL_CACHE_DIR", root_ / "own");
  EXPECT_EQ(open_kernel_cache(), root_ / "own");
  EXPECT_EQ(told_pocl(), root_ / "own");
  EXPECT_TRUE(fs::is_empty(root_ / "tmp"));
  EXPECT_EQ(kernel_cache_problem(), "");
}

TEST_F(KernelCache, AnEmptyVariableCountsAsNone) {
  set("POCL_CACHE_DIR", "");
  set("XDG_CACHE_HOME", "");
  set("HOME", root_ / "home");
  EXPECT_EQ(open_kernel_cache(), root_ / "home/.cache/pocl/kcache");
  EXPECT_EQ(told_pocl(), root_ / "home/.cache/pocl/kcache") << "PoCL aborts when it is empty";
}

TEST_F(KernelCache, WithoutAHomeIsAPrivateFolder) {
  EXPECT_EQ(open_kernel_cache(), private_folder());
  EXPECT_EQ(told_pocl(), private_folder());
  EXPECT_EQ(fs::status(private_folder()).permissions(), fs::perms::owner_all);
  EXPECT_EQ(open_kernel_cache(), private_folder()) << "the next run finds it";
}

TEST_F(KernelCache, ThatCannotBeMadeIsReplacedByAPrivateFolder) {
  for (const char* name : {"POCL_CACHE_DIR", "XDG_CACHE_HOME", "HOME"}) {
    unsetenv("POCL_CACHE_DIR");
    set(name, root_ / "file");
    EXPECT_EQ(open_kernel_cache(), private_folder()) << name;
    EXPECT_EQ(told_pocl(), private_folder()) << name;
    unsetenv(name);
  }
}

TEST_F(KernelCache, APrivateFolderThatOthersCanEnterIsNotUsed) {
  fs::create_directories(private_folder());
  fs::permissions(private_folder(), fs::perms::all);
  EXPECT_EQ(open_kernel_cache(), "");
  EXPECT_EQ(told_pocl(), std::nullopt);
  EXPECT_THAT(kernel_cache_problem(),
              testing::AllOf(testing::HasSubstr("HOME is not set"), testing::HasSubstr(private_folder()),
                             testing::HasSubstr("set POCL_CACHE_DIR")));
}

TEST_F(KernelCache, APrivateFolderThatIsALinkIsNotUsed) {
  fs::create_directories(root_ / "elsewhere");
  fs::permissions(root_ / "elsewhere", fs::perms::owner_all);
  fs::create_directory_symlink(root_ / "elsewhere", private_folder());
  EXPECT_EQ(open_kernel_cache(), "");
}

TEST_F(KernelCache, WithoutAnyPlaceSaysWhatWasTried) {
  set("HOME", root_ / "file");
  set("TMPDIR", root_ / "file");
  EXPECT_EQ(open_kernel_cache(), "");
  EXPECT_THAT(kernel_cache_problem(), testing::AllOf(testing::HasSubstr(root_ / "file/.cache/pocl/kcache"),
                                                     testing::HasSubstr(root_ / "file/pliant-")));
}

TEST_F(KernelCache, RemembersWhichProgramsWereBuilt) {
  const fs::path cache = root_ / "cache";
  EXPECT_FALSE(is_noted(cache, "a"));
  note(cache, "a");
  EXPECT_TRUE(is_noted(cache, "a"));
  EXPECT_FALSE(is_noted(cache, "b"));
  EXPECT_FALSE(is_noted("", "a"));
  EXPECT_NO_THROW(note("", "a"));
  EXPECT_NO_THROW(note(root_ / "file", "a"));
}

TEST_F(KernelCache, ADeviceTellsOnceThatItBuildsWhatNoRunHasBuilt) {
  set("POCL_CACHE_DIR", root_ / "own");
  std::vector<std::string> told;
  const auto build = [&](const std::string& values) {
    Device device;
    device.tell_of_building([&](const Progress& progress) { told.push_back(progress.message); });
    for (const char value : values)
      device.kernel(std::string("kernel void a_new_one(global int* x) { x[0] = ") + value + "; }",
                    "a_new_one");
  };
  build("12");
  EXPECT_THAT(told, testing::ElementsAre(testing::HasSubstr("building kernels")));
  build("12");
  EXPECT_EQ(told.size(), 1U) << "built by an earlier run";
  build("123");
  EXPECT_EQ(told.size(), 2U);
}

}  // namespace
}  // namespace pliant
