#include "restore/torch_flow.h"

#include <gmock/gmock.h>
#include <tbb/global_control.h>

#include <opencv2/core.hpp>
#include <optional>

#include "tests/restore/frames.h"
#include "tests/restore/torch/networks.h"

namespace shimmer::restore {
namespace {

using dataset::ErrorOf;
using dataset::SameBits;
using testing::HasSubstr;

class TorchFlow : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (Networks::CanBeMade()) networks_.emplace();
  }
  static void TearDownTestSuite() { networks_.reset(); }
  void SetUp() override {
    if (!networks_) GTEST_SKIP() << kNoPyTorch;
  }

  static cv::Mat FlowBy(const std::string& network, const cv::Mat& from, const cv::Mat& to) {
    return TorchFlows((*networks_)[network])()->Flow(from, to);
  }

  static std::optional<Networks> networks_;
};

std::optional<Networks> TorchFlow::networks_;

void ExpectEverywhere(const cv::Mat& flow, cv::Size size, double x, double y) {
  ASSERT_EQ(flow.size(), size);
  ASSERT_EQ(flow.type(), CV_32FC2);
  EXPECT_LT(cv::norm(flow, cv::Mat(size, CV_32FC2, cv::Scalar(x, y)), cv::NORM_INF), 1e-6) << size;
}

TEST_F(TorchFlow, IsOfTheFramesSizeWhateverItIs) {
  const auto flow = TorchFlows((*networks_)["Constant"])();
  for (const cv::Size size : {cv::Size(161, 119), cv::Size(136, 128), cv::Size(7, 3), cv::Size(1, 1)})
    for (const int type : {CV_8UC1, CV_8UC3, CV_16UC3, CV_32FC1})
      ExpectEverywhere(flow->Flow(Noise(size, type, 1), Noise(size, type, 2)), size, 3, -2);
  // Of halves, in px of the frames.
  const cv::Mat large = Noise({1203, 41}, CV_8UC1, 1);
  ExpectEverywhere(flow->Flow(large, large), large.size(), 6, -4);
}

// Red, green and blue are where a network looks for them, at the same px, from 0 to 255; grey is all three.
TEST_F(TorchFlow, SeesTheFramesAsTheyAre) {
  for (const int type : {CV_8UC3, CV_8UC1}) {
    const int last = CV_MAT_CN(type) - 1;
    const cv::Mat from = Noise({161, 119}, type, 1), to = Noise({161, 119}, type, 2);
    const cv::Mat flow = FlowBy("Samples", from, to);
    for (int y = 0; y < flow.rows; ++y)
      for (int x = 0; x < flow.cols; ++x) {
        const auto& at = flow.at<cv::Vec2f>(y, x);
        const double green = LevelAt(to, x, y, last / 2), blue = LevelAt(to, x, y, last);
        ASSERT_EQ(static_cast<double>(at[0]), LevelAt(from, x, y, 0));
        ASSERT_NEAR(static_cast<double>(at[1]), green + blue / 100, 1e-4);
      }
  }
}

TEST_F(TorchFlow, TakesItsRangeFromTheFile) {
  const cv::Mat black = Flat({64, 64}, CV_8UC1, 0), white = Flat({64, 64}, CV_8UC1, 255);
  ExpectEverywhere(FlowBy("Signed", black, black), black.size(), -1, -1.01);
  ExpectEverywhere(FlowBy("Signed", white, black), black.size(), 1, -1.01);
  for (const auto& [name, range] :
       {std::pair("Backwards", "1 -1"), {"OneNumber", "255"}, {"Words", "0 255 px"}})
    EXPECT_THAT(ErrorOf<std::runtime_error>([&, name = name] { FlowBy(name, black, black); }),
                HasSubstr(std::string(name) + ".pt: range is '" + range + "', must be what"));
}

// Evenly on both sides to a multiple of 8 and to 128 px, by what is at the edge.
TEST_F(TorchFlow, ContinuesTheEdges) {
  const cv::Mat frame = Noise({161, 119}, CV_8UC1, 1), other = Noise({161, 119}, CV_8UC1, 2);
  const cv::Mat place = FlowBy("Place", frame, other);  // in 168x128 px
  EXPECT_EQ(place.at<cv::Vec2f>(0, 0), cv::Vec2f(3, 4));
  EXPECT_EQ(place.at<cv::Vec2f>(118, 160), cv::Vec2f(163, 122));
  ExpectEverywhere(FlowBy("Corners", frame, other), frame.size(), LevelAt(frame, 0, 0, 0),
                   LevelAt(other, 160, 118, 0));
  const cv::Mat fits = Noise({200, 136}, CV_8UC1, 1);
  EXPECT_EQ(FlowBy("Place", fits, fits).at<cv::Vec2f>(0, 0), cv::Vec2f(0, 0));
}

TEST_F(TorchFlow, IsTheLastOfSeveral) {
  const cv::Mat from = Flat({70, 70}, CV_8UC3, 7), to = Flat({70, 70}, CV_8UC3, 9);
  for (const char* name : {"Pyramid", "Steps"}) ExpectEverywhere(FlowBy(name, from, to), from.size(), 7, 9);
}

TEST_F(TorchFlow, IsTheSameOnAnyNumberOfThreads) {
  const cv::Mat from = Noise({200, 150}, CV_8UC3, 1);
  std::vector<cv::Mat> to;
  for (uint32_t seed = 2; seed < 8; ++seed) to.push_back(Noise({200, 150}, CV_8UC3, seed));
  std::vector<cv::Mat> first;
  for (const size_t threads : {1, 2, 4, 2}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    const auto flow = TorchFlows((*networks_)["Layers"])();
    const std::vector<cv::Mat> flows = flow->Flows(from, to);
    if (first.empty()) first = flows;
    for (size_t k = 0; k < to.size(); ++k) {
      EXPECT_TRUE(SameBits(flows[k], first[k])) << threads;
      EXPECT_TRUE(SameBits(flow->Flow(from, to[k]), first[k])) << threads;
    }
  }
  EXPECT_GT(cv::norm(first[0], first[1], cv::NORM_INF), 0.01);
}

TEST_F(TorchFlow, PrintsNothing) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  FlowBy("Talking", Noise({64, 64}, CV_8UC1, 1), Noise({64, 64}, CV_8UC1, 2));
  EXPECT_EQ(testing::internal::GetCapturedStdout() + testing::internal::GetCapturedStderr(), "");
}

// Before a frame is seen, in one line with the file, what is wrong, and what would be right.
TEST_F(TorchFlow, RefusesWhatIsNoFlowNetwork) {
  const std::pair<const char*, const char*> wrong[] = {
      {"FourChannels", "gives [1, 4, 136, 144] of two images of 144x136 px"},
      {"Half", "gives [1, 2, 68, 72] of two images of 144x136 px"},
      {"NotFinite", "gives a flow that is not finite"},
      {"Nothing", "gives no flow"},
      {"OneImage", "fails on two images of 144x136 px, torch says: Expected at most 2 argument(s)"},
      {"Cut", "can't be loaded, torch says: PytorchStreamReader failed"},
      {"Text", "can't be loaded, torch says: PytorchStreamReader failed"},
      {"Empty", "can't be loaded, torch says: PytorchStreamReader failed"},
      {"Weights", "can't be loaded, torch says: PytorchStreamReader failed"},
  };
  for (const auto& [name, what] : wrong) {
    const std::string error =
        ErrorOf<std::runtime_error>([&, name = name] { TorchFlows((*networks_)[name]); });
    EXPECT_THAT(error, HasSubstr(std::string(name) + ".pt: " + what));
    EXPECT_THAT(error, HasSubstr(". Must be TorchScript that takes two images 1x3xHxW"));
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
  EXPECT_THAT(ErrorOf<std::runtime_error>([] { TorchFlows("nowhere.pt"); }),
              HasSubstr("nowhere.pt: is not there, must be dis or the file of a network"));
}

// What it can't do with the small frames that it is tried on, it says then.
TEST_F(TorchFlow, SaysWhatFailsOnTheWay) {
  const auto flow = TorchFlows((*networks_)["Wide"])();
  const cv::Mat small = Noise({200, 10}, CV_8UC1, 1), wide = Noise({201, 10}, CV_8UC1, 1);
  EXPECT_EQ(flow->Flow(small, small).size(), small.size());
  const std::string error = ErrorOf<std::runtime_error>([&] { flow->Flows(wide, {wide, wide}); });
  EXPECT_THAT(error, HasSubstr("Wide.pt: fails on two images of 208x128 px, torch says: "));
  EXPECT_THAT(error, HasSubstr("too wide for me. Must be"));
  EXPECT_EQ(error.find('\n'), std::string::npos) << error;
}

}  // namespace
}  // namespace shimmer::restore
