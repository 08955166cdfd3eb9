// make_evaluation_page FOLDER: writes FOLDER/report.html of an evaluation made by hand, with pictures to
// show.
#include <cstdio>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "restore/app/evaluation/pictures.h"
#include "restore/app/evaluation/report_page.h"
#include "sim/dataset/files.h"
#include "tests/restore/app/evaluations.h"

namespace shimmer::restore::app {
namespace {

// A wall of windows whose edges are `waves_px` off.
cv::Mat Scene(const cv::Size& size, double waves_px, int seed) {
  cv::Mat image(size, CV_8UC3, cv::Scalar(150, 170, 190)), map_x(size, CV_32F), map_y(size, CV_32F);
  for (int y = -10; y < size.height; y += 60)
    for (int x = 10 + 7 * (seed % 5); x < size.width; x += 50)
      cv::rectangle(image, {x, y, 28, 40}, cv::Scalar(60 + (x * 3) % 120, 70, 40 + (y * 2) % 90), cv::FILLED);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      map_x.at<float>(y, x) = float(x + waves_px * std::sin(0.11 * y + seed + 0.03 * x));
      map_y.at<float>(y, x) = float(y + waves_px * std::cos(0.09 * x + 2 * seed));
    }
  cv::Mat moved;
  cv::remap(image, moved, map_x, map_y, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return moved;
}

cv::Mat RowsOverTime(const cv::Size& size, double waves_px, int frames) {
  cv::Mat rows;
  for (int frame = 0; frame < frames; ++frame)
    rows.push_back(Scene(size, waves_px, 5 * frame).row(size.height / 2).clone());
  return rows;
}

void WritePictures(const ClipResult& clip, const std::filesystem::path& report, int seed, bool truth) {
  const std::filesystem::path folder = PicturesOf(report, clip.facts.name);
  std::filesystem::create_directories(folder);
  const auto write = [&](const char* name, const cv::Mat& image) { cv::imwrite(folder / name, image); };
  const cv::Size size = clip.facts.size;
  write(kInputPicture, Scene(size, 4, seed));
  write(kResultPicture, Scene(size, 0.7, seed));
  write(kInputRows, RowsOverTime(size, 4, 60));
  write(kResultRows, RowsOverTime(size, 0.7, 60));
  if (!truth) return;
  cv::Mat masks = Scene(size, 0.7, seed);
  cv::circle(masks, {size.width / 2, size.height / 2}, 40, {0, 220, 0}, 2);
  cv::circle(masks, {size.width / 2 + 3, size.height / 2}, 42, {0, 0, 230}, 2);
  write(kTruthPicture, Scene(size, 0, seed));
  write(kMaskPicture, masks);
  write(kTruthRows, RowsOverTime(size, 0, 60));
}

}  // namespace

void MakePage(const std::filesystem::path& report) {
  const Evaluation evaluation = LargeEvaluation(40);
  for (size_t i = 0; i < evaluation.clips.size(); ++i)
    WritePictures(evaluation.clips[i], report, int(i), true);
  for (const ClipResult& video : evaluation.real) WritePictures(video, report, 3, false);
  dataset::WriteFile(report / "report.html", dataset::AsBytes(EvaluationHtml(evaluation, report)));
}

}  // namespace shimmer::restore::app

int main(int count, char** arguments) {
  if (count != 2) return std::fprintf(stderr, "make_evaluation_page FOLDER\n"), 2;
  shimmer::restore::app::MakePage(arguments[1]);
}
