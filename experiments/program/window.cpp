#include "experiments/program/window.h"

#include <SDL.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <memory>

#include "framework/core/error.h"

namespace pliant {
namespace {

constexpr double most_of_screen = 0.92;  // the rest is its frame's

std::string value_of(const char* variable) {
  const char* value = std::getenv(variable);
  return value == nullptr || *value == '\0' ? "not set" : fmt::format("'{}'", value);
}

[[noreturn]] void fail(const std::string& what) {
  throw DeviceError(fmt::format("{}: {} (DISPLAY is {}, WAYLAND_DISPLAY is {})", what, SDL_GetError(),
                                value_of("DISPLAY"), value_of("WAYLAND_DISPLAY")));
}

/// The part of the window that a picture fills, in its own proportions.
SDL_Rect place_of(const ColorImage& picture, const SDL_Surface& window) {
  const double scale = std::min(static_cast<double>(window.w) / picture.width(),
                                static_cast<double>(window.h) / picture.height());
  const int width = std::max(static_cast<int>(picture.width() * scale), 1);
  const int height = std::max(static_cast<int>(picture.height() * scale), 1);
  return {(window.w - width) / 2, (window.h - height) / 2, width, height};
}

}  // namespace

Window::Window(const std::string& title) {
  SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");  // the program answers them
  // A console or a terminal far away is no screen.
  SDL_SetHint(SDL_HINT_VIDEODRIVER, "x11,wayland");
  SDL_SetHint(SDL_HINT_FRAMEBUFFER_ACCELERATION, "0");
  SDL_SetHint(SDL_HINT_VIDEO_ALLOW_SCREENSAVER, "1");
  if (SDL_Init(SDL_INIT_VIDEO) != 0) fail("no screen to show the frames on");
  window_ = SDL_CreateWindow(title.c_str(), SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED, 640, 480,
                             SDL_WINDOW_HIDDEN | SDL_WINDOW_RESIZABLE);
  if (window_ == nullptr) fail("no window to show the frames in");
}

Window::~Window() {
  SDL_DestroyWindow(window_);
  SDL_Quit();
}

void Window::show(const ColorImage& picture) {
  if (!is_open_) open(picture.width(), picture.height());
  SDL_Surface* surface = SDL_GetWindowSurface(window_);
  if (surface == nullptr) fail("the window shows nothing");
  const std::unique_ptr<SDL_Surface, void (*)(SDL_Surface*)> pixels(
      // SDL does not write through it.
      SDL_CreateRGBSurfaceWithFormatFrom(const_cast<Rgb*>(picture.data()), picture.width(), picture.height(),
                                         24, 3 * picture.width(), SDL_PIXELFORMAT_RGB24),
      SDL_FreeSurface);
  SDL_Rect place = place_of(picture, *surface);
  SDL_BlitScaled(pixels.get(), nullptr, surface, &place);
  SDL_UpdateWindowSurface(window_);
}

/// As large as the picture, or as the screen has room for.
void Window::open(int width, int height) {
  SDL_Rect screen{0, 0, width, height};
  SDL_GetDisplayUsableBounds(SDL_GetWindowDisplayIndex(window_), &screen);
  const double scale = std::min({1.0, most_of_screen * screen.w / width, most_of_screen * screen.h / height});
  SDL_SetWindowSize(window_, static_cast<int>(width * scale), static_cast<int>(height * scale));
  SDL_SetWindowPosition(window_, SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED);
  SDL_ShowWindow(window_);
  is_open_ = true;
}

void Window::take_events() {
  SDL_Event event;
  while (SDL_PollEvent(&event) != 0) {
    if (event.type == SDL_QUIT) is_closed_ = true;
    if (event.type == SDL_KEYDOWN && event.key.repeat == 0) answer_key(event.key.keysym.sym);
  }
}

void Window::answer_key(int key) {
  if (key == SDLK_q || key == SDLK_ESCAPE) is_closed_ = true;
  if (key == SDLK_SPACE) is_paused_ = !is_paused_;
}

}  // namespace pliant
