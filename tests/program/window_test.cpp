// What a user does to the window, as SDL's driver without a screen tells of it.
#include "experiments/program/window.h"

#include <SDL.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "experiments/program/live_view.h"

namespace pliant {
namespace {

class WindowTest : public ::testing::Test {
 protected:
  WindowTest() { ::setenv("SDL_VIDEODRIVER", "dummy", 1); }

  static void press(SDL_Keycode key) {
    SDL_Event event{};
    event.type = SDL_KEYDOWN;
    event.key.keysym.sym = key;
    SDL_PushEvent(&event);
  }

  const ColorImage picture_{64, 48, {10, 200, 30}};
};

TEST_F(WindowTest, ClosesByKeysAndWithItsFrame) {
  for (const SDL_Keycode key : {SDLK_q, SDLK_ESCAPE}) {
    Window window("test");
    window.show(picture_);
    window.take_events();
    EXPECT_FALSE(window.is_closed());
    press(key);
    window.take_events();
    EXPECT_TRUE(window.is_closed());
  }
  Window window("test");
  SDL_Event event{};
  event.type = SDL_QUIT;
  SDL_PushEvent(&event);
  window.take_events();
  EXPECT_TRUE(window.is_closed());
}

TEST_F(WindowTest, SpacePausesAndGoesOn) {
  Window window("test");
  for (const bool is_paused : {true, false}) {
    press(SDLK_SPACE);
    press(SDLK_a);
    window.take_events();
    EXPECT_EQ(window.is_paused(), is_paused);
  }
  EXPECT_FALSE(window.is_closed());
}

/// A frame in which nothing is seen.
class LiveViewTest : public WindowTest {
 protected:
  bool show(LiveView& live) {
    live.begin({Camera{70, 70, 39.5, 29.5, 80, 60}});
    return live.show({frame_, frame_.color, record_, nullptr, nullptr});
  }

  Frame frame_{DepthImage(80, 60, 700), {}, {}};
  FrameRecord record_;
};

TEST_F(LiveViewTest, GoesOnUntilTheWindowIsClosed) {
  LiveView live([] { return false; });
  EXPECT_TRUE(show(live));
  press(SDLK_q);
  EXPECT_FALSE(show(live));
}

TEST_F(LiveViewTest, WaitsWhileItIsPausedAndNotForEver) {
  int asked = 0;
  LiveView live([&] { return ++asked == 3; });
  press(SDLK_SPACE);
  EXPECT_TRUE(show(live)) << "whoever else ended it says so";
  EXPECT_EQ(asked, 3);
}

}  // namespace
}  // namespace pliant
