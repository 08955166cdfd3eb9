#include "cli/process.h"

#include <gtest/gtest.h>

#include <csignal>
#include <opencv2/core.hpp>

namespace shimmer::cli {
namespace {

TEST(Process, TheFirstSignalAsksToStopTheSecondEndsIt) {
  EXPECT_EXIT(
      {
        const std::atomic<bool>& stop = ListenToSignals();
        if (stop) std::_Exit(1);
        raise(SIGINT);
        if (!stop) std::_Exit(2);
        raise(SIGINT);
        std::_Exit(3);
      },
      testing::KilledBySignal(SIGINT), "");
}

TEST(Process, OpenCvIsSilentAboutWhatItThrows) {
  SilenceOpenCv();
  testing::internal::CaptureStderr();
  EXPECT_THROW(cv::Mat(2, 2, CV_8U)(cv::Rect(0, 0, 3, 3)), cv::Exception);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace shimmer::cli
