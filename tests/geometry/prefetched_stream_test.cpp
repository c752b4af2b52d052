#include "framework/geometry/prefetched_stream.h"

#include <gmock/gmock.h>

#include <atomic>
#include <condition_variable>
#include <mutex>

#include "framework/core/error.h"

namespace pliant {
namespace {

using ::testing::ElementsAre;

/// `frames` frames, the depth of each its number, then an error or the end. A gate holds it back before any
/// frame.
class GatedStream : public FrameStream {
 public:
  explicit GatedStream(int frames, bool fails = false, bool on_host = true)
      : frames_(frames), fails_(fails), on_host_(on_host) {}

  std::string name() const override { return "street"; }
  const Rig& rig() const override { return rig_; }
  bool reads_on_host() const override { return on_host_; }
  std::vector<std::string> warnings() const override { return {"read " + std::to_string(given_)}; }

  std::optional<Frame> next() override {
    ++asked_;
    reader_ = std::this_thread::get_id();
    std::unique_lock lock(mutex_);
    opens_.wait(lock, [this] { return given_ < open_until_; });
    if (given_ == frames_ && fails_) throw SourceLost("street: gone");
    if (given_ == frames_) return std::nullopt;
    ++given_;
    return Frame{DepthImage(8, 6, static_cast<float>(given_)), {}, {}, given_ / 30.0};
  }

  /// Lets so many frames pass from now on.
  void open(int frames) {
    {
      const std::lock_guard lock(mutex_);
      open_until_ = frames;
    }
    opens_.notify_all();
  }

  /// How often a frame was asked for.
  int asked() const { return asked_; }
  std::thread::id reader() const { return reader_; }

 private:
  Rig rig_{{100, 100, 3.5, 2.5, 8, 6}};
  int frames_;
  bool fails_;
  bool on_host_;
  int given_ = 0;
  std::atomic<int> asked_ = 0;
  std::atomic<std::thread::id> reader_;
  std::mutex mutex_;
  std::condition_variable opens_;
  int open_until_ = 1'000'000;
};

TEST(PrefetchedStream, GivesTheFramesInTheirOrderAndTheEnd) {
  GatedStream stream(200);
  PrefetchedStream ahead(stream, 3);
  EXPECT_EQ(ahead.name(), "street");
  EXPECT_EQ(&ahead.rig(), &stream.rig());
  CheckedStream frames(ahead);
  for (int i = 1; i <= 200; ++i) {
    const auto frame = frames.next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->depth(3, 2), static_cast<float>(i));
    EXPECT_THAT(ahead.warnings(), ElementsAre("read " + std::to_string(i)))
        << "not those of frames read ahead";
  }
  EXPECT_FALSE(ahead.next());
  EXPECT_FALSE(ahead.next()) << "the end is the end";
  EXPECT_NE(stream.reader(), std::this_thread::get_id());
}

TEST(PrefetchedStream, ReadsAheadByItselfAndNoFurther) {
  GatedStream stream(100);
  PrefetchedStream ahead(stream, 2);
  while (stream.asked() < 3) std::this_thread::yield();  // two wait, one is in hand
  ahead.next();
  while (stream.asked() < 4) std::this_thread::yield();
  EXPECT_LE(stream.asked(), 4);
}

TEST(PrefetchedStream, GivesAnErrorAfterTheFramesBeforeItAndAgain) {
  GatedStream stream(3, true);
  PrefetchedStream ahead(stream);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(ahead.next());
  for (int again = 0; again < 2; ++again)
    EXPECT_THAT([&] { ahead.next(); }, ::testing::ThrowsMessage<SourceLost>("street: gone"));
  EXPECT_THAT(ahead.warnings(), ElementsAre("read 3"));
}

TEST(PrefetchedStream, MayEndAtAnyTime) {
  for (int taken = 0; taken < 6; ++taken) {
    GatedStream stream(4);
    PrefetchedStream ahead(stream);
    for (int i = 0; i < taken; ++i) ahead.next();
  }
  GatedStream stream(100);
  stream.open(1);
  auto ahead = std::make_unique<PrefetchedStream>(stream);
  while (stream.asked() < 2) std::this_thread::yield();
  // The thread waits in the stream for the second frame now.
  std::thread closing([&] { ahead.reset(); });
  stream.open(100);
  closing.join();
  EXPECT_LE(stream.asked(), 4);
}

TEST(PrefetchedStream, ThatNeedsTheDeviceIsReadWhenItIsAsked) {
  GatedStream stream(2, false, false);
  PrefetchedStream ahead(stream);
  EXPECT_EQ(stream.asked(), 0);
  EXPECT_EQ(ahead.next()->depth(0, 0), 1);
  EXPECT_EQ(stream.asked(), 1);
  EXPECT_EQ(stream.reader(), std::this_thread::get_id());
  EXPECT_THAT(ahead.warnings(), ElementsAre("read 1"));
}

}  // namespace
}  // namespace pliant
