#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "framework/core/error.h"
#include "framework/io/file.h"

namespace pliant::test {

/// A folder of its own for every test, removed at its end.
class TestFiles : public ::testing::Test {
 protected:
  TestFiles() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        std::filesystem::temp_directory_path() / (std::string("pliant_") + test->test_suite_name() + "_" +
                                                  test->name() + "_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  ~TestFiles() override {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }

  std::string write(const std::string& name, const std::string& text) const {
    write_file(file(name), {text.begin(), text.end()});
    return file(name);
  }

  std::string write(const std::string& name, const std::vector<std::uint8_t>& bytes) const {
    write_file(file(name), bytes);
    return file(name);
  }

  /// The first `size` bytes of a file as another file.
  std::string cut(const std::string& path, std::size_t size) const {
    auto bytes = read_file(path);
    bytes.resize(size);
    return write("cut" + std::to_string(size) + std::filesystem::path(path).extension().string(), bytes);
  }

 private:
  std::filesystem::path folder_;
};

/// A file of the real data that tests use where it is there; "" where it is not.
inline std::string real_data(const std::string& name) {
  const char* folder = std::getenv("PLIANT_DATA");
  if (folder == nullptr) return "";
  const auto path = std::filesystem::path(folder) / name;
  return std::filesystem::exists(path) ? path.string() : "";
}

/// The message of the DataError that `action` throws, "" when it throws none. It must be one line.
template <class Action>
std::string data_error_of(Action action) {
  try {
    action();
  } catch (const DataError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no DataError";
  return "";
}

}  // namespace pliant::test
