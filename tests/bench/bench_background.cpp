// How good backgrounds are: clips of `shimmer generate` of a static scene, with the truth `tilt` on disk and
// one clean frame. PSNR in dB against it of a frame, of the plain mean and median over time, and of ours
// without registration, with it to the frames' mean and to the reference of the whole clip, each the mean
// over the clip's frames; and the strength that was found beside the true root mean square of the tilt, px
// along an axis. Arguments: folders of data sets.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "restore/background.h"
#include "restore/psnr.h"
#include "restore/scene_reference.h"
#include "restore/segment.h"
#include "restore/turbulence_strength.h"
#include "sim/dataset/image_io.h"

namespace shimmer::bench {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> FilesOf(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& file : fs::directory_iterator(folder)) files.push_back(file.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<cv::Mat> FramesOf(const fs::path& folder) {
  std::vector<cv::Mat> frames;
  for (const auto& file : FilesOf(folder)) frames.push_back(cv::imread(file.string()));
  return frames;
}

double TrueTilt(const fs::path& folder) {
  const std::array<std::string, 2> names = {"dx", "dy"};
  double sum = 0, count = 0;
  for (const auto& file : FilesOf(folder)) {
    const cv::Mat tilt = dataset::ReadChannels(file, names);
    sum += std::pow(cv::norm(tilt), 2), count += 2.0 * static_cast<double>(tilt.total());
  }
  return std::sqrt(sum / count);
}

cv::Mat MeanOf(const std::vector<cv::Mat>& frames) {
  cv::Mat sum = cv::Mat::zeros(frames[0].size(), CV_32FC3), mean;
  for (const cv::Mat& frame : frames) cv::accumulate(frame, sum);
  sum.convertTo(mean, CV_8U, 1.0 / static_cast<double>(frames.size()));
  return mean;
}

cv::Mat MedianOf(const std::vector<cv::Mat>& frames) {
  cv::Mat median(frames[0].size(), frames[0].type());
  std::vector<uint8_t> values(frames.size());
  for (int y = 0; y < median.rows; ++y)
    for (int i = 0; i < median.cols * 3; ++i) {
      for (size_t k = 0; k < frames.size(); ++k) values[k] = frames[k].ptr<uint8_t>(y)[i];
      const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
      std::nth_element(values.begin(), middle, values.end());
      median.ptr<uint8_t>(y)[i] = *middle;
    }
  return median;
}

double MeanPsnr(const std::vector<cv::Mat>& frames, const cv::Mat& clean) {
  double sum = 0;
  for (const cv::Mat& frame : frames) sum += restore::Psnr(frame, clean);
  return sum / static_cast<double>(frames.size());
}

restore::SceneReference ReferenceOf(const std::vector<cv::Mat>& frames) {
  restore::SceneReferenceMean mean;
  for (const int place : restore::SurveyPlaces(static_cast<int>(frames.size())))
    mean.Add({frames[static_cast<size_t>(place)], {}});
  return mean.Result();
}

std::vector<cv::Mat> Backgrounds(const std::vector<cv::Mat>& frames,
                                 const restore::BackgroundParams& params) {
  restore::Background background(params);
  std::vector<cv::Mat> means;
  for (const cv::Mat& frame : frames)
    for (const restore::BackgroundFrame& mean : background.Next({frame, {}})) means.push_back(mean.frame);
  while (const auto mean = background.Rest()) means.push_back(mean->frame);
  return means;
}

void Report(const fs::path& set) {
  std::printf("%s\n%-8s %7s %7s %8s %8s %8s %8s %8s %8s\n", set.filename().c_str(), "clip", "tilt", "found",
              "frame", "mean", "median", "ours", "to mean", "to scene");
  std::array<double, 6> sum{};
  double clips = 0;
  for (const fs::path& clip : FilesOf(set / "clips")) {
    const std::vector<cv::Mat> frames = FramesOf(clip / "turb");
    const cv::Mat clean = FramesOf(clip / "clean").front();
    restore::StrengthEstimate strength;
    for (const cv::Mat& frame : frames) strength.Add(frame);
    const std::array<double, 6> psnr = {
        MeanPsnr(frames, clean),
        MeanPsnr({MeanOf(frames)}, clean),
        MeanPsnr({MedianOf(frames)}, clean),
        MeanPsnr(Backgrounds(frames, {}), clean),
        MeanPsnr(Backgrounds(frames, {.registered = true}), clean),
        MeanPsnr(Backgrounds(frames, {.registered = true, .scene = ReferenceOf(frames)}), clean)};
    std::printf("%-8s %7.3f %7.3f", clip.filename().c_str(), TrueTilt(clip / "truth"),
                std::sqrt(strength.Result().tilt_variance_px2));
    for (size_t i = 0; i < psnr.size(); ++i) std::printf(" %8.2f", psnr[i]), sum[i] += psnr[i];
    std::printf("\n");
    ++clips;
  }
  std::printf("%-24s", "mean");
  for (const double value : sum) std::printf(" %8.2f", value / clips);
  std::printf("\n");
}

}  // namespace
}  // namespace shimmer::bench

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) shimmer::bench::Report(argv[i]);
}
