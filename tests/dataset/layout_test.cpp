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
  EXPECT_EQ(layout.Path(FrameKind::kMask, 123, 7), "clips/000123/mask/0007.png");
  EXPECT_EQ(layout.Path(FrameKind::kFlow, 123, 7), "clips/000123/flow/0007.exr");
  EXPECT_EQ(layout.Path(FrameKind::kShake, 123, 0), "clips/000123/shake.json");
  EXPECT_EQ(layout.Path(FrameKind::kTurb, 999, 12345), "clips/000999/turb/12345.png");
  // At most a thousand clips a folder.
  EXPECT_EQ(layout.Path(FrameKind::kTurb, 1000, 0), "clips.001/001000/turb/0000.png");
  EXPECT_EQ(layout.Path(FrameKind::kTurb, 99999, 0), "clips.099/099999/turb/0000.png");
  EXPECT_EQ(layout.Path(FrameKind::kTurb, 12345678, 0), "clips.12345/12345678/turb/0000.png");
  EXPECT_EQ(layout.ClipFolders(123), std::vector<std::string>{"clips/000123"});
  EXPECT_EQ(Layout{.format = FileFormat::kExr}.Path(FrameKind::kTurb, 1, 1), "clips/000001/turb/0001.exr");
}

TEST(Layout, PairsHaveEqualNamesInOrder) {
  const Layout layout{.kind = LayoutKind::kPairs, .name = "set", .test_fraction = 0.5, .frames_per_clip = 3};
  EXPECT_EQ(layout.Path(FrameKind::kTurb, 0, 2), "set/train/turb/000002.png");
  EXPECT_EQ(layout.Path(FrameKind::kClean, 0, 2), "set/train/noturb/000002.png");
  EXPECT_EQ(layout.Path(FrameKind::kTruth, 0, 2), "set/train/truth/000002.exr");
  EXPECT_EQ(layout.Path(FrameKind::kTurb, 1, 0), "set/test/turb/000003.png");
  EXPECT_TRUE(layout.ClipFolders(0).empty());
  std::vector<std::string> names;
  for (int64_t clip = 0; clip < 400; clip += 2)
    for (int64_t frame = 0; frame < 3; ++frame) names.push_back(layout.Path(FrameKind::kTurb, clip, frame));
  EXPECT_TRUE(std::ranges::is_sorted(names));
  EXPECT_EQ(std::ranges::adjacent_find(names), names.end());
}

TEST(Layout, RestormerIsNamedAsItsLoaderSays) {
  const Layout layout{.kind = LayoutKind::kRestormer, .name = "gt", .test_fraction = 0.5};
  EXPECT_EQ(layout.Path(FrameKind::kTurb, 0, 0), "gt/train/lq/000000.png");
  EXPECT_EQ(layout.Path(FrameKind::kClean, 1, 0), "gt/test/gt/000001.png");
  EXPECT_TRUE(layout.ClipFolders(0).empty());
}

// Each part is numbered from 000, as a set of its own.
TEST(Layout, BasicsrHasPartsOfAThousandClips) {
  const Layout layout{.kind = LayoutKind::kBasicsr};
  EXPECT_EQ(layout.Path(FrameKind::kTurb, 7, 99), "lq/007/00000099.png");
  EXPECT_EQ(layout.Path(FrameKind::kClean, 999, 0), "gt/999/00000000.png");
  EXPECT_EQ(layout.Path(FrameKind::kTurb, 1000, 0), "part001/lq/000/00000000.png");
  EXPECT_EQ(layout.Path(FrameKind::kTruth, 98765, 1), "part098/truth/765/00000001.exr");
  EXPECT_EQ(layout.ClipFolders(1002),
            (std::vector<std::string>{"part001/lq/002", "part001/gt/002", "part001/truth/002",
                                      "part001/mask/002", "part001/flow/002", "part001/shake/002"}));
}

TEST(Layout, WebdatasetPutsNeighboursInOneTar) {
  const Layout layout{.kind = LayoutKind::kWebdataset, .clips_per_tar = 10};
  EXPECT_EQ(layout.Path(FrameKind::kTurb, 129, 3), "shards/000012.tar/000129.turb.0003.png");
  EXPECT_EQ(layout.Path(FrameKind::kTruth, 130, 0), "shards/000013.tar/000130.truth.0000.exr");
  EXPECT_EQ(layout.Path(FrameKind::kShake, 130, 0), "shards/000013.tar/000130.shake.json");
  EXPECT_EQ(layout.UnitOf(129), 12);
  EXPECT_THROW((Layout{.kind = LayoutKind::kWebdataset, .clips_per_tar = 0}.Validate()),
               std::invalid_argument);
}

TEST(Layout, AKindIsKnownByItsPath) {
  for (const LayoutKind kind : {LayoutKind::kSequence, LayoutKind::kPairs, LayoutKind::kRestormer,
                                LayoutKind::kBasicsr, LayoutKind::kWebdataset})
    for (const char* name : {"set", "gt", "turb"})
      for (const FrameKind frame_kind : kFrameKinds) {
        const Layout layout{.kind = kind, .name = name};
        EXPECT_EQ(KindOfPath(layout.Path(frame_kind, 1234, 0)), frame_kind);
      }
  for (const char* path : {"", "/", "/dataset.json", "dataset.json", "gt", "clips/000000/masks/0000.png",
                           "shake.json", "shards/000000.tar/000001.json"})
    EXPECT_FALSE(KindOfPath(path)) << path;
}

TEST(Layout, APathLeadsBackToItsClip) {
  for (const LayoutKind kind : {LayoutKind::kSequence, LayoutKind::kPairs, LayoutKind::kRestormer,
                                LayoutKind::kBasicsr, LayoutKind::kWebdataset})
    for (const char* name : {"set", "gt", "turb", "part001"}) {
      const Layout layout{.kind = kind,
                          .name = name,
                          .test_fraction = 0.5,
                          .frames_per_clip = 3,
                          .digits = 9,
                          .clips_per_tar = 7};
      for (const int64_t clip : {0, 7, 999, 1000, 98765, 12345678})
        for (const int64_t frame : {0, 2})
          for (const FrameKind frame_kind : kFrameKinds) {
            const auto place = layout.PlaceOf(layout.Path(frame_kind, clip, frame));
            ASSERT_TRUE(place) << layout.Path(frame_kind, clip, frame);
            EXPECT_EQ(place->kind, frame_kind);
            EXPECT_EQ(place->clip, clip);
            EXPECT_EQ(place->frame, frame_kind == FrameKind::kShake ? 0 : frame);
          }
      const std::string path = layout.Path(FrameKind::kTurb, 1000, 1);
      for (const std::string& other : {"x" + path, path + "x", "sub/" + path, path.substr(1), "0" + path,
                                       path.substr(0, path.size() - 4) + ".exr"})
        EXPECT_FALSE(layout.PlaceOf(other)) << other;
      for (const char* other : {"", "7", "/7.png", "/set/7.png", "../../7.png", "turb/7", "clips/000007",
                                "dataset.json", "turb/99999999999999999999.png"})
        EXPECT_FALSE(layout.PlaceOf(other)) << other;
    }
  const Layout tars{.kind = LayoutKind::kWebdataset, .clips_per_tar = 7};
  EXPECT_EQ(tars.UnitOfTar("shards/001234.tar"), 1234);
  for (const char* other : {"shards/1234.tar", "shards/index.json", "001234.tar", "shards/a/001234.tar"})
    EXPECT_FALSE(tars.UnitOfTar(other)) << other;
  EXPECT_FALSE(Layout{}.UnitOfTar("shards/001234.tar"));
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
