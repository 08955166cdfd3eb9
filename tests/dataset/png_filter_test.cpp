#include "sim/dataset/png_filter.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <cstdlib>
#include <random>
#include <vector>

namespace shimmer::dataset {
namespace {

// As the PNG specification (9.4) has it.
std::vector<uint8_t> PaethTwin(const std::vector<uint8_t>& row, const std::vector<uint8_t>& above,
                               size_t pixel_bytes) {
  std::vector<uint8_t> out;
  for (size_t i = 0; i < row.size(); ++i) {
    const int a = i < pixel_bytes ? 0 : row[i - pixel_bytes], b = above[i];
    const int c = i < pixel_bytes ? 0 : above[i - pixel_bytes], p = a + b - c;
    const int pa = std::abs(p - a), pb = std::abs(p - b), pc = std::abs(p - c);
    const int nearest = pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
    out.push_back(static_cast<uint8_t>(row[i] - nearest));
  }
  return out;
}

// Bytes that lie near one another as often as far apart, so that all three neighbours are nearest, and ties.
std::vector<uint8_t> SomeBytes(size_t count, uint32_t seed) {
  std::mt19937 generator(seed);
  std::vector<uint8_t> bytes(count);
  for (uint8_t& byte : bytes)
    byte = static_cast<uint8_t>(generator() % 2 ? generator() % 256 : 250 + generator() % 10);
  return bytes;
}

template <class F>
void ForEachTarget(const F& f) {
  int targets = 0;
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    f(hwy::TargetName(target));
    ++targets;
  }
  hwy::SetSupportedTargetsForTest(0);
  EXPECT_GE(targets, 2);
}

TEST(PngFilter, PaethIsAsSpecifiedOnEveryTarget) {
  ForEachTarget([](const char* target) {
    for (size_t pixel_bytes = 1; pixel_bytes <= 8; ++pixel_bytes)
      for (size_t count = 1; count <= 300; count += count < 80 ? 1 : 37) {
        const std::vector<uint8_t> row = SomeBytes(count, 2 * count), above = SomeBytes(count, 2 * count + 1);
        std::vector<uint8_t> out(count + 1, 77);
        PaethRow(row, above.data(), pixel_bytes, out.data());
        ASSERT_EQ(out.back(), 77) << "written beyond the row";
        out.pop_back();
        ASSERT_EQ(out, PaethTwin(row, above, pixel_bytes)) << target << " " << count << " " << pixel_bytes;
      }
  });
}

// Every triple of neighbours a little apart, and at the ends of the range.
TEST(PngFilter, PaethOfEveryTriple) {
  std::vector<uint8_t> values = {0, 1, 2, 3, 63, 126, 127, 128, 129, 192, 252, 253, 254, 255};
  std::vector<uint8_t> row, above;
  for (const uint8_t left : values)
    for (const uint8_t up : values)
      for (const uint8_t corner : values) {
        row.insert(row.end(), {left, 0});
        above.insert(above.end(), {corner, up});
      }
  ForEachTarget([&](const char* target) {
    std::vector<uint8_t> out(row.size());
    PaethRow(row, above.data(), 1, out.data());
    EXPECT_EQ(out, PaethTwin(row, above, 1)) << target;
  });
}

TEST(PngFilter, HighBytesComeFirstOnEveryTarget) {
  ForEachTarget([](const char* target) {
    for (size_t count = 1; count <= 150; ++count) {
      const std::vector<uint8_t> bytes = SomeBytes(2 * count, count);
      std::vector<uint16_t> row;
      for (size_t i = 0; i < count; ++i)
        row.push_back(static_cast<uint16_t>(bytes[2 * i] * 256 + bytes[2 * i + 1]));
      std::vector<uint8_t> out(2 * count + 1, 77);
      BigEndianRow(row, out.data());
      ASSERT_EQ(out.back(), 77) << "written beyond the row";
      out.pop_back();
      ASSERT_EQ(out, bytes) << target << " " << count;
    }
  });
}

}  // namespace
}  // namespace shimmer::dataset
