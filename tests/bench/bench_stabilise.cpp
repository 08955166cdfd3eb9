// Errors of the shifts that stabilising finds in clips of `shimmer generate` with the truth `shake` on disk:
// of ours and of the paper's plain method, in px. Arguments: folders of data sets; --ours leaves the plain
// method out.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "restore/stabilise.h"
#include "tests/bench/measure.h"
#include "tests/bench/plain_stabilise.h"
#include "tests/bench/table.h"

namespace shimmer::bench {
namespace {

namespace fs = std::filesystem;

std::vector<double> Errors(const std::vector<cv::Point2d>& found, const std::vector<cv::Point2d>& truth) {
  std::vector<double> errors;
  for (size_t k = 1; k < truth.size(); ++k) errors.push_back(cv::norm(found[k] - truth[k]));
  return errors;
}

void AddClip(const fs::path& clip, bool plain, Table& table, std::vector<double>& all) {
  const nlohmann::json shake = nlohmann::json::parse(std::ifstream(clip / "shake.json"));
  std::vector<cv::Point2d> truth, found;
  for (const auto& shift : shake.at("shifts_px")) truth.emplace_back(shift.at(0), shift.at(1));
  double most = 0;
  for (const cv::Point2d& shift : truth) most = std::max({most, std::abs(shift.x), std::abs(shift.y)});
  std::vector<fs::path> files;
  for (const auto& file : fs::directory_iterator(clip / "turb")) files.push_back(file.path());
  std::sort(files.begin(), files.end());
  std::vector<cv::Mat> frames;
  for (const auto& file : files) frames.push_back(cv::imread(file.string()));
  restore::Stabiliser stabiliser;
  int lost = 0;
  double least_correlation = 1, least_clearness = 1e9, scatter = 0, claimed = 0;
  std::vector<restore::FrameShift> shifts;
  for (const cv::Mat& frame : frames) std::ranges::copy(stabiliser.Next(frame), std::back_inserter(shifts));
  std::ranges::copy(stabiliser.Rest(), std::back_inserter(shifts));
  for (const restore::FrameShift& shift : shifts) {
    lost += shift.match != restore::Match::kFound;
    found.push_back(shift.px);
    least_correlation = std::min(least_correlation, shift.correlation);
    if (found.size() == 1) continue;
    least_clearness = std::min(least_clearness, shift.clearness);
    scatter = std::max(scatter, shift.scatter_px), claimed = std::max(claimed, shift.error_px);
  }
  std::vector<double> errors = Errors(found, truth), plain_errors = {0};
  if (plain) {
    std::vector<cv::Mat> grey;
    for (const cv::Mat& frame : frames) {
      cv::cvtColor(frame, grey.emplace_back(), cv::COLOR_BGR2GRAY);
      grey.back().convertTo(grey.back(), CV_32F);
    }
    plain_errors =
        Errors(PlainShifts(grey, std::min(std::max(50, cvCeil(most)), frames[0].rows * 2 / 5)), truth);
  }
  table.Add({clip.parent_path().parent_path().filename() / clip.filename(), SizeText(frames[0].size()),
             Number(most, 0), Number(Median(errors), 3), Number(std::ranges::max(errors), 3),
             Number(Median(plain_errors), 2), Number(std::ranges::max(plain_errors), 2), std::to_string(lost),
             Number(least_correlation, 2), Number(least_clearness, 1), Number(scatter, 2),
             Number(claimed, 3)});
  all.insert(all.end(), errors.begin(), errors.end());
}

}  // namespace
}  // namespace shimmer::bench

int main(int argc, char** argv) {
  using namespace shimmer::bench;
  Table table({"clip", "size", "most shift", "median", "max", "plain median", "plain max", "lost",
               "correlation", "clearness", "scatter", "error claimed"});
  std::vector<double> all;
  bool plain = true;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--ours") {
      plain = false;
      continue;
    }
    std::vector<fs::path> clips;
    for (const auto& clip : fs::directory_iterator(fs::path(argv[i]) / "clips")) clips.push_back(clip.path());
    std::sort(clips.begin(), clips.end());
    for (const auto& clip : clips) AddClip(clip, plain, table, all);
  }
  table.Print();
  if (!all.empty())
    std::printf("all %zu frames: median %.3f, max %.3f px\n", all.size(), Median(all), std::ranges::max(all));
}
