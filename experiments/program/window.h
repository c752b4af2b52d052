#pragma once

#include <memory>
#include <string>

#include "framework/geometry/image.h"

struct SDL_Window;

namespace pliant {

/// A window on the screen that shows one picture after the other. There is at most one at a time.
class Window {
 public:
  /// It is seen with the first picture. Throws DeviceError, which says which screen was looked for, when it
  /// cannot be opened.
  explicit Window(const std::string& title);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// As large as the window has room for it.
  void show(const ColorImage& picture);
  /// Takes what the user did since the last call: space pauses and goes on, q, Esc and closing it close it.
  void take_events();
  bool is_closed() const { return is_closed_; }
  bool is_paused() const { return is_paused_; }

 private:
  void open(int width, int height);
  void answer_key(int key);

  SDL_Window* window_ = nullptr;
  bool is_open_ = false;
  bool is_closed_ = false;
  bool is_paused_ = false;
};

}  // namespace pliant
