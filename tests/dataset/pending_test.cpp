#include "sim/dataset/pending.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

namespace shimmer::dataset {
namespace {

using Clips = std::vector<int64_t>;

const Layout kSequence, kTars{.kind = LayoutKind::kWebdataset, .clips_per_tar = 3};

TEST(Pending, IsWhatIsNeitherDoneNorFailed) {
  EXPECT_EQ(PendingClips(kSequence, {.clips = 5}, {}, {}), (Clips{0, 1, 2, 3, 4}));
  EXPECT_EQ(PendingClips(kSequence, {.clips = 5}, {0, 3, 9}, {4}), (Clips{1, 2}));
  EXPECT_EQ(PendingClips(kSequence, {.clips = 5, .retry_failed = true}, {0, 3}, {4}), (Clips{1, 2, 4}));
  EXPECT_EQ(PendingClips(kSequence, {.clips = 5, .only = {4, 3, 1, 4}}, {0, 3}, {4}), (Clips{1, 4}));
}

// A tar is written whole: with one clip of it all others come.
TEST(Pending, ClipsOfATarStayTogether) {
  EXPECT_EQ(PendingClips(kTars, {.clips = 8}, {0, 1, 2, 4}, {}), (Clips{3, 4, 5, 6, 7}));
  EXPECT_EQ(PendingClips(kTars, {.clips = 8}, {0, 1, 2, 3, 5}, {4}), (Clips{6, 7}));
  EXPECT_EQ(PendingClips(kTars, {.clips = 8, .retry_failed = true}, {0, 1, 2, 3, 5, 6, 7}, {4}),
            (Clips{3, 4, 5}));
  EXPECT_EQ(PendingClips(kTars, {.clips = 8, .only = {7}}, {}, {}), (Clips{6, 7}));
  // The set has grown by a clip: the last tar is made again with it.
  EXPECT_EQ(PendingClips(kTars, {.clips = 8}, {0, 1, 2, 3, 4, 5, 6}, {}), (Clips{6, 7}));
  EXPECT_TRUE(PendingClips(kTars, {.clips = 7}, {0, 1, 2, 3, 4, 5, 6, 7}, {}).empty());
}

TEST(Pending, ShardsShareAllClipsOut) {
  for (const Layout& layout : {kSequence, kTars})
    for (const int64_t count : {1, 2, 3, 7, 40}) {
      Clips all;
      for (int64_t index = 0; index < count; ++index) {
        const Clips own = PendingClips(layout, {.clips = 20, .shard = {index, count}}, {}, {});
        all.insert(all.end(), own.begin(), own.end());
      }
      std::ranges::sort(all);
      EXPECT_EQ(all, PendingClips(layout, {.clips = 20}, {}, {})) << count;
    }
}

TEST(Shard, IsNamedAndChecked) {
  EXPECT_EQ(Shard{}.Suffix(), "");
  EXPECT_EQ((Shard{3, 8}).Suffix(), ".003-of-008");
  EXPECT_EQ((Shard{1234, 5000}).Suffix(), ".1234-of-5000");
  EXPECT_NO_THROW((Shard{7, 8}.Validate()));
  for (const Shard& bad : {Shard{8, 8}, Shard{-1, 8}, Shard{0, 0}})
    EXPECT_THROW(bad.Validate(), std::invalid_argument);
}

}  // namespace
}  // namespace shimmer::dataset
