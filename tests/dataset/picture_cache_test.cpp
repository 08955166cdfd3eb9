// Pictures are decoded once while they fit, dropped in the order of their use, and stay whole in the hands
// that have them.
#include "sim/dataset/picture_cache.h"

#include <atomic>
#include <thread>

#include "tests/dataset/temp_folder.h"

namespace shimmer::dataset {
namespace {

const cv::Size kSize(200, 100);
constexpr uint64_t kPixelBytes = 200 * 100 * 3;  // of 8-bit RGB: a byte a sample
// Three, with what they take beside, and one that is being read; but no fourth.
constexpr uint64_t kThreeFit = (3 + 2) * kPixelBytes + kPixelBytes / 2;

class Pictures : public ::testing::Test {
 protected:
  void SetUp() override {
    for (int i = 0; i < kCount; ++i) folder_.Put(NameOf(i), EncodePng(RandomImage(kSize, 3, i), 8));
  }

  static std::string NameOf(int i) { return std::to_string(i) + ".png"; }
  std::filesystem::path PathOf(int i) const { return folder_ / NameOf(i); }

  static constexpr int kCount = 5;
  TempFolder folder_;
};

TEST_F(Pictures, AreWhatReadSamplesReads) {
  PictureCache cache(kThreeFit);
  folder_.Put("float.exr", EncodeImage(RandomImage({9, 5}, 1, 1), {FileFormat::kExr, 32}));
  for (int run = 0; run < 2; ++run)
    for (const std::string name : {"0.png", "float.exr"}) {
      const Picture read = ReadSamples(folder_ / name);
      const auto cached = cache.Read(folder_ / name);
      EXPECT_TRUE(SameBits(cached->pixels, read.pixels));
      EXPECT_EQ(cached->linear, read.linear);
    }
  EXPECT_EQ(cache.statistics().hits, 2);
  EXPECT_EQ(cache.statistics().misses, 2);
}

TEST_F(Pictures, MakeRoomForOthersInTheOrderOfTheirUse) {
  PictureCache cache(kThreeFit);
  for (const int i : {0, 1, 2, 3, 0, 4}) cache.Read(PathOf(i));  // 4 takes the place of 1
  EXPECT_EQ(cache.statistics().evictions, 1);
  EXPECT_GE(cache.statistics().held_bytes, 4 * kPixelBytes);  // now that none is being read
  EXPECT_LE(cache.statistics().held_bytes, kThreeFit);
  const int64_t misses = cache.statistics().misses;
  for (const int i : {0, 2, 3, 4}) cache.Read(PathOf(i));
  EXPECT_EQ(cache.statistics().misses, misses);
  cache.Read(PathOf(1));
  EXPECT_EQ(cache.statistics().misses, misses + 1);
}

TEST_F(Pictures, OutliveTheirPlaceInTheCache) {
  PictureCache cache(kPixelBytes * 3 / 2);  // one fits
  const auto first = cache.Read(PathOf(0));
  for (int i = 1; i < kCount; ++i) cache.Read(PathOf(i));
  EXPECT_EQ(cache.statistics().evictions, kCount - 1);
  EXPECT_TRUE(SameBits(first->pixels, ReadSamples(PathOf(0)).pixels));
}

TEST_F(Pictures, LargerThanTheBudgetAreReadAndNotKept) {
  PictureCache cache(kPixelBytes / 2);
  for (int run = 0; run < 2; ++run)
    EXPECT_TRUE(SameBits(cache.Read(PathOf(0))->pixels, ReadSamples(PathOf(0)).pixels));
  EXPECT_EQ(cache.statistics().misses, 2);
  EXPECT_EQ(cache.statistics().held_bytes, 0u);
  // Nor do they push out what fits.
  cache.Read(folder_.Put("small.png", EncodePng(RandomImage({5, 4}, 3, 1), 8)));
  cache.Read(PathOf(0));
  EXPECT_EQ(cache.statistics().evictions, 0);
}

TEST_F(Pictures, ABudgetThatShrinksIsKept) {
  PictureCache cache(kThreeFit);
  for (int i = 0; i < 3; ++i) cache.Read(PathOf(i));
  cache.SetBudget(kPixelBytes * 3 / 2);
  EXPECT_EQ(cache.statistics().evictions, 2);
  EXPECT_LE(cache.statistics().held_bytes, kPixelBytes * 3 / 2);
  cache.Read(PathOf(2));
  EXPECT_EQ(cache.statistics().hits, 1);
}

TEST_F(Pictures, ThatCantBeReadSayItToEachAndAreTriedAgain) {
  PictureCache cache(kThreeFit);
  const auto path = folder_.Put("bad.png", "not a picture");
  std::atomic<int> errors = 0;
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 8; ++i)
      threads.emplace_back([&] {
        errors += Contains(ErrorOf<std::runtime_error>([&] { cache.Read(path); }), "bad.png: not a picture");
      });
  }
  EXPECT_EQ(errors, 8);
  EXPECT_EQ(cache.statistics().held_bytes, 0u);
  folder_.Put("bad.png", EncodePng(RandomImage({5, 4}, 3, 1), 8));
  EXPECT_EQ(cache.Read(path)->pixels.size(), cv::Size(5, 4));
}

TEST_F(Pictures, ManyThreadsReadEachOnce) {
  PictureCache cache(kCount * kPixelBytes * 2);
  std::vector<Picture> expected;
  for (int i = 0; i < kCount; ++i) expected.push_back(ReadSamples(PathOf(i)));
  std::atomic<int> wrong = 0;
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 8; ++t)
      threads.emplace_back([&, t] {
        for (int n = 0; n < 40; ++n) {
          const int i = (t + n) / 2 % kCount;
          wrong += !SameBits(cache.Read(PathOf(i))->pixels, expected[i].pixels);
        }
      });
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(cache.statistics().misses, kCount);
  EXPECT_EQ(cache.statistics().hits, 8 * 40 - kCount);
}

// With room for one or two of them, all the time.
TEST_F(Pictures, ManyThreadsShareASmallBudget) {
  PictureCache cache(kPixelBytes * 5 / 2);
  std::atomic<int> wrong = 0;
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 4; ++t)
      threads.emplace_back([&, t] {
        for (int n = 0; n < 40; ++n) {
          const auto picture = cache.Read(PathOf((t * 7 + n * 3) % kCount));
          wrong += picture->pixels.size() != kSize || cache.statistics().held_bytes > kPixelBytes * 5 / 2;
        }
      });
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(cache.statistics().evictions, 0);
}

}  // namespace
}  // namespace shimmer::dataset
