#include "sim/dataset/layout.h"

#include <algorithm>
#include <cmath>

#include "tests/dataset/temp_folder.h"

namespace shimmer::dataset {
namespace {

TEST(Layout, Sequence) {
  const Layout layout;
  EXPECT_EQ(layout.Path(FrameKind::kTurb, 123, 0), "clips/000123/turb/0000.png");
  EXPECT_EQ(layout.Path(FrameKind::kClean, 0, 15), "clips/000000/clean/0015.png");
  EXPECT_EQ(layout.Path(FrameKind::kTruth, 123, 0), "clips/000123/truth/0000.exr");
  EXPECT_EQ(layout.Path(FrameKind::kTurb, 12345678, 12345), "clips/12345678/turb/12345.png");
  EXPECT_EQ(layout.ClipFolder(123), "clips/000123");
  EXPECT_EQ(Layout{.format = FileFormat::kExr}.Path(FrameKind::kTurb, 1, 1), "clips/000001/turb/0001.exr");
}

TEST(Layout, PairsHaveEqualNamesInOrder) {
  const Layout layout{.kind = LayoutKind::kPairs, .name = "set", .test_fraction = 0.5, .frames_per_clip = 3};
  EXPECT_EQ(layout.Path(FrameKind::kTurb, 0, 2), "set/train/turb/000002.png");
  EXPECT_EQ(layout.Path(FrameKind::kClean, 0, 2), "set/train/noturb/000002.png");
  EXPECT_EQ(layout.Path(FrameKind::kTruth, 0, 2), "set/train/truth/000002.exr");
  EXPECT_EQ(layout.Path(FrameKind::kTurb, 1, 0), "set/test/turb/000003.png");
  EXPECT_EQ(layout.ClipFolder(0), "");
  std::vector<std::string> names;
  for (int64_t clip = 0; clip < 400; clip += 2)
    for (int64_t frame = 0; frame < 3; ++frame) names.push_back(layout.Path(FrameKind::kTurb, clip, frame));
  EXPECT_TRUE(std::ranges::is_sorted(names));
  EXPECT_EQ(std::ranges::adjacent_find(names), names.end());
}

TEST(Layout, TheShareOfTestClipsIsExact) {
  for (const double fraction : {0., 0.01, 0.02, 0.1, 0.29, 0.3, 1. / 3, 0.5, 0.57, 0.7, 0.99, 1.}) {
    int64_t test_clips = 0;
    for (int64_t clip = 0; clip < 3000; ++clip) {
      test_clips += IsTestClip(clip, fraction);
      // Of the first n clips floor(n f) are tests. In hundredths, exact, for all but the third.
      const int64_t n = clip + 1, hundredths = std::lround(fraction * 100);
      const int64_t expected = fraction == 1. / 3 ? n / 3 : n * hundredths / 100;
      ASSERT_EQ(test_clips, expected) << fraction << " of " << n;
    }
  }
}

TEST(Layout, TheShareHoldsForTheLastOfABillion) {
  int64_t test_clips = 0;
  for (int64_t clip = 1'000'000'000 - 1000; clip < 1'000'000'000; ++clip)
    test_clips += IsTestClip(clip, 0.29);
  EXPECT_EQ(test_clips, 290);
}

TEST(Layout, Digits) {
  EXPECT_EQ(PairDigits(1'000'000, 1), 6);
  EXPECT_EQ(PairDigits(1'000'001, 1), 9);
  EXPECT_EQ(PairDigits(100'000, 10), 6);
  EXPECT_EQ(PairDigits(100'000, 16), 9);
  EXPECT_EQ(PairDigits(1, 100'000), 6);
}

TEST(Layout, NamesThatAreNoFolderOfOurOwn) {
  for (const std::string name :
       {"", ".", "..", "../x", "a/b", "/a", ".hidden", "a\nb", "clips", "dataset.json"}) {
    const Layout layout{.kind = LayoutKind::kPairs, .name = name};
    EXPECT_TRUE(Contains(ErrorOf<std::invalid_argument>([&] { layout.Validate(); }), "name")) << name;
  }
  EXPECT_NO_THROW(
      (Layout{.kind = LayoutKind::kPairs, .name = "ASU_Turbulence_Clean_100k_dataset_v1"}.Validate()));
  EXPECT_THROW((Layout{.kind = LayoutKind::kPairs, .test_fraction = std::nan("")}.Validate()),
               std::invalid_argument);
  EXPECT_THROW((Layout{.kind = LayoutKind::kPairs, .frames_per_clip = 0}.Validate()), std::invalid_argument);
}

}  // namespace
}  // namespace shimmer::dataset
