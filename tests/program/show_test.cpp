// `pliant track --show`: the window on the screen of an X server that has none but memory.
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "framework/geometry/image.h"
#include "framework/geometry/pixel_window.h"
#include "tests/program/program_run.h"

namespace pliant::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

pid_t start(const std::string& command) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    ::_exit(127);
  }
  return child;
}

int stop(pid_t child, int signal) {
  ::kill(child, signal);
  int status = 0;
  ::waitpid(child, &status, 0);
  return status;
}

bool eventually(const std::function<bool()>& holds) {
  for (int i = 0; i < 600; ++i) {
    if (holds()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return false;
}

/// The picture of a file as X servers dump their screens: 25 numbers, the highest byte first, then names and
/// colours, then 32 bits a pixel. Empty while it is not there.
ColorImage read_screen(const std::string& file) {
  if (!fs::exists(file)) return {};
  const auto bytes = read_file(file);
  const auto number = [&](std::size_t index) {
    std::size_t value = 0;
    for (std::size_t i = 4 * index; i < 4 * index + 4; ++i) value = value << 8 | bytes[i];
    return value;
  };
  if (bytes.size() < 100) return {};
  const std::size_t pixels = number(0) + 12 * number(19);
  ColorImage screen(static_cast<int>(number(4)), static_cast<int>(number(5)));
  for (int v = 0; v < screen.height(); ++v)
    for (int u = 0; u < screen.width(); ++u) {
      const std::size_t at =
          pixels + number(12) * static_cast<std::size_t>(v) + 4 * static_cast<std::size_t>(u);
      screen(u, v) = {bytes[at + 2], bytes[at + 1], bytes[at]};
    }
  return screen;
}

/// The colours of a part of the screen.
std::vector<Rgb> part_of(const ColorImage& screen, const PixelWindow& part) {
  std::vector<Rgb> pixels;
  for (int v = part.top; v < part.top + part.height; ++v)
    for (int u = part.left; u < part.left + part.width; ++u) pixels.push_back(screen(u, v));
  return pixels;
}

std::size_t colors_of(const std::vector<Rgb>& pixels) {
  std::set<int> colors;
  for (const Rgb& color : pixels) colors.insert(color.r << 16 | color.g << 8 | color.b);
  return colors.size();
}

class ShowTest : public ProgramTest {
 protected:
  ShowTest() {
    write("head.yaml",
          "data: {type: head, image_width: 160, image_height: 120, focal_length: 131.25, frames: 100000, "
          "texture: skin, motion: {rotation_y: 10}}\n"
          "model: {type: tsdf, volume: fitted, resolution: 64}\n");
  }

  /// A screen as large as the picture of a frame with some margin.
  void open_screen() {
    server_ = start("exec Xvfb -displayfd 1 -screen 0 1500x1200x24 -nolisten tcp -fbdir '" + file("") +
                    "' >'" + file("display.txt") + "' 2>'" + file("xvfb.txt") + "'");
    ASSERT_TRUE(eventually([&] {
      return fs::exists(file("display.txt")) && !text_of("display.txt").empty();
    })) << text_of("xvfb.txt");
    display_ = ":" + std::to_string(std::stoi(text_of("display.txt")));
  }

  ~ShowTest() override {
    if (server_ > 0) stop(server_, SIGTERM);
  }

  ColorImage screen() const { return read_screen(file("Xvfb_screen0")); }

  pid_t server_ = 0;
  std::string display_;
};

TEST_F(ShowTest, ShowsFourPanelsThatDifferAndEndsWithWhatThereIs) {
  open_screen();
  const pid_t program = start("cd '" + file("") + "' && exec env DISPLAY=" + display_ +
                              " '" PLIANT_PROGRAM "' track head.yaml --show --out out >out.txt 2>err.txt");
  // The picture of 1298 x 1042 pixels stands in the middle of the screen.
  const auto panel = [](int place) {
    return PixelWindow{101 + 6 + place % 2 * 646, 79 + 24 + place / 2 * 504, 640, 480};
  };
  ColorImage seen;
  const bool is_shown = eventually([&] {
    seen = screen();
    if (seen.empty()) return false;
    for (const int place : {0, 1, 2, 3})
      if (colors_of(part_of(seen, panel(place))) < 20) return false;
    return true;
  });
  EXPECT_TRUE(is_shown) << text_of("err.txt");
  for (const int place : {0, 1, 2})
    EXPECT_NE(part_of(seen, panel(place)), part_of(seen, panel(place + 1))) << place;
  EXPECT_TRUE(eventually([&] { return part_of(screen(), panel(1)) != part_of(seen, panel(1)); }))
      << "the next frame";
  const int status = stop(program, SIGINT);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << text_of("err.txt");
  EXPECT_GT(nlohmann::json::parse(text_of("out/result.json"))["runs"][0]["frames"], 0);
}

TEST_F(ShowTest, WithoutAScreenSaysSoBeforeAnyWork) {
  const ProgramRun run = call("track head.yaml --show --out out", "env -u WAYLAND_DISPLAY DISPLAY=:4711");
  EXPECT_EQ(run.exit_code, 4);
  EXPECT_THAT(run.err, AllOf(HasSubstr("no screen to show the frames on"), HasSubstr("DISPLAY is ':4711'")));
  EXPECT_FALSE(fs::exists(file("out")));
}

}  // namespace
}  // namespace pliant::test
