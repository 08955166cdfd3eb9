#include "noise/hash.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "noise/lattice.h"

namespace shimmer::noise {
namespace {

// The vector of the SipHash paper's appendix A: key bytes 00 .. 0f, message bytes 00 .. 0e.
TEST(HashPath, EqualsPublishedVector) {
  std::string message;
  for (char c = 0; c < 15; ++c) message += c;
  EXPECT_EQ(HashPath(0x0706050403020100u, 0x0f0e0d0c0b0a0908u, message), 0xa129ca6149be45e5u);
}

TEST(HashPath, EverySeedClipAndPathCounts) {
  std::set<uint64_t> seen;
  for (uint64_t seed : {0ull, 1ull, ~0ull})
    for (uint64_t clip : {0ull, 1ull, 99999ull})
      for (const char* path : {"", "a", "tilt.strength_px", "tilt.strength_pxx"})
        seen.insert(HashPath(seed, clip, path));
  EXPECT_EQ(seen.size(), 36u);
}

TEST(HashStream, IsUniform) {
  HashStream stream(HashPath(0, 0, "uniform"));
  int counts[16] = {};
  const int draws = 160000;
  for (int i = 0; i < draws; ++i) ++counts[stream.Below(16)];
  double chi2 = 0;
  for (int count : counts) chi2 += (count - draws / 16.0) * (count - draws / 16.0) / (draws / 16.0);
  EXPECT_LT(chi2, 37.7);  // 15 degrees of freedom, p = 0.001
}

TEST(ShuffledPermutation, IsAPermutationAndDependsOnTheStream) {
  std::set<Permutation> seen;
  for (uint64_t key = 0; key < 20; ++key) {
    HashStream stream(key);
    const Permutation p = ShuffledPermutation(stream);
    EXPECT_EQ(std::set<uint8_t>(p.begin(), p.end()).size(), 256u);
    seen.insert(p);
  }
  EXPECT_EQ(seen.size(), 20u);
}

// Each value reaches each place equally often: chi-square over the places of value 0 in 25,600 shuffles.
TEST(ShuffledPermutation, IsUniform) {
  HashStream stream(HashPath(0, 0, "shuffle"));
  int counts[256] = {};
  const int shuffles = 25600;
  for (int i = 0; i < shuffles; ++i) {
    const Permutation p = ShuffledPermutation(stream);
    ++counts[std::find(p.begin(), p.end(), 0) - p.begin()];
  }
  double chi2 = 0;
  for (int count : counts) chi2 += (count - 100.0) * (count - 100.0) / 100.0;
  EXPECT_LT(chi2, 330.5);  // 255 degrees of freedom, p = 0.001
}

}  // namespace
}  // namespace shimmer::noise
