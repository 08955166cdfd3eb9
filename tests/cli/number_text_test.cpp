#include "cli/number_text.h"

#include <gtest/gtest.h>

namespace shimmer::cli {
namespace {

TEST(NumberTexts, AreShort) {
  EXPECT_EQ(ShortText(0), "0");
  EXPECT_EQ(ShortText(0.03124), "0.0312");
  EXPECT_EQ(ShortText(4.9712), "4.97");
  EXPECT_EQ(ShortText(-2.5), "-2.5");
  EXPECT_EQ(ShortText(12345.6), "12346");
  EXPECT_EQ(ShortText(1e100), "1e+100");
  EXPECT_EQ(RoundedText(-1e-9, 0.5), "0");
  EXPECT_EQ(RoundedText(2, 0.5), "2");
  EXPECT_EQ(RoundedText(12.345, 0.005), "12.345");
  EXPECT_EQ(Grouped(0), "0");
  EXPECT_EQ(Grouped(999), "999");
  EXPECT_EQ(Grouped(1000), "1,000");
  EXPECT_EQ(Grouped(1234567), "1,234,567");
  EXPECT_EQ(Counted(1, "clip"), "1 clip");
  EXPECT_EQ(Counted(0, "clip"), "0 clips");
  EXPECT_EQ(BytesText(999), "999 bytes");
  EXPECT_EQ(BytesText(999'999), "1 MB");  // not 1000 kB
  EXPECT_EQ(BytesText(5'612'345'678), "5.61 GB");
}

}  // namespace
}  // namespace shimmer::cli
