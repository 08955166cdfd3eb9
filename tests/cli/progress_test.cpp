#include "cli/progress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace shimmer::cli {
namespace {

// Where stderr is no terminal: at once only the last line.
TEST(Progress, CountsToTheEnd) {
  testing::internal::CaptureStderr();
  Progress progress("frames", 3, 1, false);
  progress.Step();
  progress.Step(true);
  progress.End();
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              testing::MatchesRegex("3 of 3 frames, [^,]*/s, 0:00 left, 1 failed\n"));
  EXPECT_EQ(progress.failed(), 1);
}

TEST(Progress, QuietSaysNothing) {
  testing::internal::CaptureStderr();
  Progress progress("frames", 1, 0, true);
  progress.Step();
  progress.End();
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Progress, DurationsAreReadByPeople) {
  EXPECT_EQ(DurationText(0.4), "0:00");
  EXPECT_EQ(DurationText(67), "1:07");
  EXPECT_EQ(DurationText(3 * 3600 + 25 * 60), "3:25:00");
}

}  // namespace
}  // namespace shimmer::cli
