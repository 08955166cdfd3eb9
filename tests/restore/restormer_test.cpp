#include "restore/restormer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <cstring>
#include <thread>

#include "restore/restormer_tensors.h"
#include "tests/restore/random_network.h"
#include "tests/restore/restormer_twin.h"
#include "tests/restore/safe_tensor_file.h"

namespace shimmer::restore {
namespace {

using testing::HasSubstr;

constexpr double kError = 2e-6;  // of the range, as restormer.h says

RestormerShape Small() {
  return {.width = 8, .blocks = {1, 1, 2}, .heads = {1, 2, 4}, .refinement = 1, .unshuffle = 2};
}

double LargestError(const cv::Mat& image, const cv::Mat& truth) {
  cv::Mat image_double;
  image.convertTo(image_double, CV_64F);
  double largest = 0;
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x)
      for (int c = 0; c < 3; ++c) {
        const double off = std::abs(image_double.at<cv::Vec3d>(y, x)[c] - truth.at<cv::Vec3d>(y, x)[c]);
        if (off > largest || std::isnan(off)) largest = off;
      }
  return largest;
}

cv::Mat ImageOf(const Tensor& planes) {
  const int height = static_cast<int>(planes.shape[1]), width = static_cast<int>(planes.shape[2]);
  cv::Mat image(height, width, CV_32FC3);
  const float* value = planes.values.data();
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) image.at<cv::Vec3f>(y, x)[c] = *value++;
  return image;
}

bool SameBytes(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() &&
         std::memcmp(a.data, b.data, a.total() * a.elemSize()) == 0;
}

struct Case {
  const char* name;
  RestormerShape shape;
  std::vector<cv::Size> sizes;
};

std::ostream& operator<<(std::ostream& out, const Case& of) { return out << of.name; }

class RestormerAgainstTwin : public testing::TestWithParam<Case> {};

TEST_P(RestormerAgainstTwin, IsWithinItsError) {
  uint64_t seed = 1;
  for (const bool with_bias : {true, false}) {
    RestormerShape shape = GetParam().shape;
    shape.norm_with_bias = with_bias;
    const SafeTensors file = RandomNetwork(shape, ++seed);
    const Restormer network(file);
    for (const cv::Size size : GetParam().sizes) {
      const cv::Mat image = RandomImage(size, ++seed), out = network.Run(image);
      ASSERT_EQ(out.size(), size);
      const cv::Mat truth = RestormerTwin(file, image);
      EXPECT_LE(LargestError(out, truth), kError) << size << " with_bias " << with_bias;
      EXPECT_GT(LargestError(image, truth), 0.01) << "the network does next to nothing";
    }
  }
}

const Case kCases[] = {
    {"TwoLevels",
     {.width = 8, .blocks = {1, 1}, .heads = {1, 2}, .refinement = 0},
     {{64, 64}, {65, 47}, {1, 1}, {2, 3}}},
    {"ThreeLevelsUnshuffled", Small(), {{64, 64}, {65, 47}, {1, 1}, {130, 7}}},
    {"FourLevels",
     {.width = 12, .blocks = {1, 1, 1, 2}, .heads = {1, 2, 4, 8}, .refinement = 2, .expansion = 2.66},
     {{40, 24}, {7, 33}}},
    // Rows of a tile with one to six channels, and heads whose products have rests.
    {"OddChannels",
     {.width = 10, .blocks = {2, 1}, .heads = {5, 4}, .refinement = 1, .expansion = 1.3, .unshuffle = 4},
     {{33, 66}, {3, 200}}},
    // (of fewer channels yet, some px have no variance to speak of, and what rounding does to them grows)
    {"FewChannels",
     {.width = 6, .blocks = {1, 1}, .heads = {3, 4}, .refinement = 1, .expansion = 0.5},
     {{19, 8}}},
    // Several tiles side by side and on top of each other.
    {"ManyTiles",
     {.width = 8, .blocks = {1, 1}, .heads = {1, 1}, .refinement = 0, .expansion = 16},
     {{395, 50}}},
};

INSTANTIATE_TEST_SUITE_P(Shapes, RestormerAgainstTwin, testing::ValuesIn(kCases),
                         [](const auto& info) { return std::string(info.param.name); });

// Weights, an input and PyTorch's output, from tests/restore/data/make_restormer.py.
TEST(Restormer, GivesWhatPyTorchGives) {
  for (const char* name : {"restormer_with_bias", "restormer_bias_free"}) {
    SafeTensors file =
        ReadSafeTensors(std::string(SHIMMER_SOURCE_DIR) + "/tests/restore/data/" + name + ".safetensors");
    const Tensor output = file.tensors.at("sample.output");
    const cv::Mat image = ImageOf(file.tensors.at("sample.input"));
    cv::Mat truth;
    ImageOf(output).convertTo(truth, CV_64F);
    EXPECT_LE(LargestError(Restormer(file).Run(image), truth), kError) << name;
    EXPECT_GT(LargestError(image, truth), 0.1) << name;
  }
}

TEST(Restormer, ReadsItsFile) {
  const SafeTensors file = RandomNetwork(Small(), 3);
  EXPECT_EQ(Restormer(file).Card().text, file.metadata.at("card"));
}

TEST(Restormer, GivesTheSameBytesOnAnyNumberOfThreads) {
  const Restormer network(RandomNetwork(Small(), 5));
  const cv::Mat image = RandomImage({300, 200}, 6);
  cv::Mat first;
  for (const size_t threads : {1, 2, 5}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    tbb::task_arena arena(static_cast<int>(threads));
    for (int repeat = 0; repeat < 3; ++repeat) {
      const cv::Mat out = arena.execute([&] { return network.Run(image); });
      if (first.empty()) first = out;
      EXPECT_TRUE(SameBytes(out, first)) << threads;
    }
  }
}

TEST(Restormer, MayRunOnSeveralThreadsAtOnce) {
  const Restormer network(RandomNetwork(Small(), 7));
  const cv::Mat images[] = {RandomImage({90, 70}, 8), RandomImage({64, 100}, 9)};
  const cv::Mat alone[] = {network.Run(images[0]), network.Run(images[1])};
  cv::Mat together[2];
  std::thread threads[2];
  for (int i = 0; i < 2; ++i)
    threads[i] = std::thread([&, i] {
      for (int repeat = 0; repeat < 5; ++repeat) together[i] = network.Run(images[i]);
    });
  for (std::thread& thread : threads) thread.join();
  for (int i = 0; i < 2; ++i) EXPECT_TRUE(SameBytes(together[i], alone[i]));
}

TEST(Restormer, TakesAPartOfAnImage) {
  const Restormer network(RandomNetwork(Small(), 10));
  const cv::Mat image = RandomImage({90, 70}, 11), part = image({13, 9, 40, 30});
  EXPECT_TRUE(SameBytes(network.Run(part), network.Run(part.clone())));
}

TEST(Restormer, OtherImagesAreRefused) {
  const Restormer network(RandomNetwork(Small(), 12));
  EXPECT_THROW(network.Run({}), std::invalid_argument);
  EXPECT_THROW(network.Run(cv::Mat::zeros(8, 8, CV_32FC1)), std::invalid_argument);
  EXPECT_THROW(network.Run(cv::Mat::zeros(8, 8, CV_8UC3)), std::invalid_argument);
}

std::string Refusal(const SafeTensors& file) {
  const std::string error = ErrorOf([&] { Restormer network(file); });
  EXPECT_THAT(error, testing::StartsWith("random.safetensors: "));
  EXPECT_THAT(error, testing::Not(HasSubstr("\n")));
  return error;
}

TEST(Restormer, EveryTensorIsNeeded) {
  const SafeTensors good = RandomNetwork(Small(), 13);
  for (const auto& [name, tensor] : good.tensors) {
    SafeTensors file = good;
    file.tensors.erase(name);
    EXPECT_THAT(Refusal(file),
                HasSubstr("tensor " + name + " is missing, must be " + ShapeText(tensor.shape)));
  }
}

TEST(Restormer, TensorsOfAnotherNetworkAreRefused) {
  SafeTensors file = RandomNetwork(Small(), 14);
  file.tensors["down.0.weight"].shape = {8, 4, 3, 3};
  EXPECT_THAT(Refusal(file),
              HasSubstr("tensor down.0.weight is [8, 4, 3, 3], must be [4, 8, 3, 3] by the model card"));
  file = RandomNetwork(Small(), 14);
  file.tensors["decoder.2.0.norm1.weight"] = {{8}, std::vector<float>(8)};
  EXPECT_THAT(Refusal(file),
              HasSubstr("tensor decoder.2.0.norm1.weight, [8], is none of the model card's network"));
}

// A file with the sample that PyTorch would have recorded.
SafeTensors WithSample(double off) {
  SafeTensors file = RandomNetwork(Small(), 15);
  const cv::Mat input = RandomImage({11, 6}, 16), output = RestormerTwin(file, input);
  Tensor in{{3, 6, 11}, {}}, out{{3, 6, 11}, {}};
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < 6; ++y)
      for (int x = 0; x < 11; ++x) {
        in.values.push_back(input.at<cv::Vec3f>(y, x)[c]);
        out.values.push_back(static_cast<float>(output.at<cv::Vec3d>(y, x)[c]));
      }
  out.values[100] += static_cast<float>(off);
  file.tensors["sample.input"] = in;
  file.tensors["sample.output"] = out;
  return file;
}

TEST(Restormer, ARecordedSampleMustComeOut) {
  EXPECT_NO_THROW(Restormer(WithSample(0)));
  EXPECT_NO_THROW(Restormer(WithSample(0.9e-4)));
  EXPECT_THAT(Refusal(WithSample(0.01)),
              HasSubstr("makes of sample.input something that is off by 0.010000"));
  SafeTensors file = WithSample(0);
  file.tensors.erase("sample.input");
  EXPECT_THAT(Refusal(file), HasSubstr("tensor sample.input is missing: the other is there"));
  file = WithSample(0);
  file.tensors["sample.output"].shape = {3, 11, 6};
  EXPECT_THAT(Refusal(file),
              HasSubstr("tensor sample.output is [3, 11, 6], must be as large as sample.input"));
  file.tensors["sample.input"].shape = {6, 33};
  EXPECT_THAT(Refusal(file), HasSubstr("tensor sample.input is [6, 33], must be [3, height, width]"));
}

}  // namespace
}  // namespace shimmer::restore
