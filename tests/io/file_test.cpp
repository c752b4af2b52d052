#include "framework/io/file.h"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>

#include "tests/io/test_files.h"

namespace pliant {
namespace {

using test::data_error_of;
using ::testing::AllOf;
using ::testing::HasSubstr;

class File : public test::TestFiles {};

TEST_F(File, ReadsWhatWasWritten) {
  const std::vector<std::uint8_t> bytes = {0, '\n', '\r', 0xff, 26};
  write_file(file("a"), bytes);
  EXPECT_EQ(read_file(file("a")), bytes);
}

TEST_F(File, AnySizeIsReadWhole) {
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{65535}, std::size_t{65536}, std::size_t{500001}}) {
    std::vector<std::uint8_t> bytes(size);
    for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::uint8_t>(i * 7 + i / 256);
    write_file(file("a"), bytes);
    EXPECT_EQ(read_file(file("a")), bytes) << size;
  }
}

TEST_F(File, MissingIsAnError) {
  EXPECT_THAT(data_error_of([&] { read_file(file("none")); }), HasSubstr("none: no such file"));
}

TEST_F(File, FolderIsAnError) {
  EXPECT_THAT(data_error_of([&] { read_file(file("")); }), HasSubstr("is a folder"));
}

TEST_F(File, ADeviceIsAnError) {
  EXPECT_THAT(data_error_of([] { read_file("/dev/null"); }), HasSubstr("/dev/null: is a device"));
}

TEST_F(File, WritingIntoAMissingFolderIsAnError) {
  EXPECT_THAT(data_error_of([&] { write_file(file("no/where"), {1}); }),
              AllOf(HasSubstr("no/where: cannot be written"), HasSubstr("No such file")));
}

TEST_F(File, ALinkIsFollowed) {
  write("a", "old");
  std::filesystem::create_symlink("a", file("link"));
  write("link", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(file("link")));
  EXPECT_EQ(read_file(file("a")), (std::vector<std::uint8_t>{'n', 'e', 'w'}));
}

// A limit on the size of files stands for a full disk.
TEST_F(File, ADiskThatFillsUpLeavesTheOldFileAndNoOther) {
  write("a", "old");
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  rlimit small = before;
  small.rlim_cur = 10;
  std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  const std::string message = data_error_of([&] { write_file(file("a"), std::vector<std::uint8_t>(20)); });
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(message, file("a") + ": cannot be written: File too large");
  EXPECT_EQ(read_file(file("a")), (std::vector<std::uint8_t>{'o', 'l', 'd'}));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(file("")), {}), 1);
}

TEST_F(File, FullDiskIsAnError) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  EXPECT_THAT(data_error_of([] {
                write_file("/dev/full", {1, 2, 3});
              }),
              HasSubstr("/dev/full: cannot be written"));
}

}  // namespace
}  // namespace pliant
