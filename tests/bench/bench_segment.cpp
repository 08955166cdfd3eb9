// IoU of the masks that segmenting finds in clips of `shimmer generate` with the truth `mask` on disk, by the
// paper's averaged flow and by ours. The frames are stabilised first, where they shook, as the true masks are
// of the steady camera; px that a frame does not see are left out. Arguments: folders of data sets;
// --labels FOLDER: label images of CDnet of the frames, whose unknown px (85 and 170) are left out too;
// --stages FOLDER: write masks.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "restore/border_fill.h"
#include "restore/mask_scores.h"
#include "restore/segment.h"
#include "tests/bench/measure.h"
#include "tests/bench/table.h"

namespace shimmer::bench {
namespace {

namespace fs = std::filesystem;
using namespace shimmer::restore;

std::vector<cv::Mat> Pictures(const fs::path& folder, int flags) {
  std::vector<fs::path> files;
  for (const auto& file : fs::directory_iterator(folder)) files.push_back(file.path());
  std::sort(files.begin(), files.end());
  std::vector<cv::Mat> pictures;
  for (const auto& file : files)
    if (cv::Mat picture = cv::imread(file.string(), flags); !picture.empty()) pictures.push_back(picture);
  return pictures;
}

struct Clip {
  std::vector<SteadyFrame> frames;
  std::vector<FrameShift> shifts;
};

Clip Steadied(const std::vector<cv::Mat>& frames) {
  Clip clip;
  Stabiliser stabiliser;
  for (const cv::Mat& frame : frames)
    for (const FrameShift& shift : stabiliser.Next(frame)) clip.shifts.push_back(shift);
  for (const FrameShift& shift : stabiliser.Rest()) clip.shifts.push_back(shift);
  if (IsSteady(clip.shifts)) {
    for (FrameShift& shift : clip.shifts) shift.px = {};
    for (const cv::Mat& frame : frames)
      clip.frames.push_back({frame, cv::Mat(frame.size(), CV_8UC1, cv::Scalar(255))});
    return clip;
  }
  BorderFill fill;
  for (size_t k = 0; k < frames.size(); ++k)
    if (auto steady = fill.Next(frames[k], clip.shifts[k])) clip.frames.push_back(*steady);
  while (auto steady = fill.Rest()) clip.frames.push_back(*steady);
  return clip;
}

std::vector<cv::Mat> Masks(const std::vector<SteadyFrame>& frames, SegmentMethod method,
                           double& milliseconds) {
  const int count = static_cast<int>(frames.size());
  SegmentSurvey survey(method);
  for (const int k : SurveyPlaces(count)) survey.Add(PlaceAt(k, frames), k);
  Segmenter segmenter(survey.Settings());
  std::vector<cv::Mat> masks;
  const double start = static_cast<double>(cv::getTickCount());
  for (const SteadyFrame& frame : frames)
    if (auto mask = segmenter.Next(frame)) masks.push_back(*mask);
  while (auto mask = segmenter.Rest()) masks.push_back(*mask);
  milliseconds = 1000 * (static_cast<double>(cv::getTickCount()) - start) / cv::getTickFrequency() / count;
  return masks;
}

double MeanIou(const std::vector<cv::Mat>& masks, const std::vector<cv::Mat>& truth,
               const std::vector<cv::Mat>& use) {
  double sum = 0;
  for (size_t k = 0; k < truth.size(); ++k) {
    cv::Mat found = masks[k].clone(), seen = truth[k].clone();
    found.setTo(0, use[k] == 0), seen.setTo(0, use[k] == 0);
    sum += CompareMasks(found, seen).Iou();
  }
  return sum / static_cast<double>(truth.size());
}

}  // namespace
}  // namespace shimmer::bench

int main(int argc, char** argv) {
  using namespace shimmer::bench;
  fs::path labels_folder, stages;
  bool fused_only = false;
  Table table({"clip", "size", "tilt RMS px", "aof", "fused", "aof, known", "fused, known", "fused ms"});
  std::map<double, std::vector<std::pair<double, double>>> by_strength;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--labels") {
      labels_folder = argv[++i];
      continue;
    }
    if (argument == "--fused") {
      fused_only = true;
      continue;
    }
    if (argument == "--stages") {
      stages = argv[++i];
      continue;
    }
    std::map<int, double> strength;
    std::ifstream manifest(fs::path(argument) / "manifest.jsonl");
    for (std::string line; std::getline(manifest, line);) {
      const auto entry = nlohmann::json::parse(line);
      if (entry.contains("clip") && entry.contains("drawn"))
        strength[entry["clip"]] = 0.247 * entry["drawn"].value("tilt.strength_px", 0.0);
    }
    const std::vector<cv::Mat> labels =
        labels_folder.empty() ? std::vector<cv::Mat>{} : Pictures(labels_folder, cv::IMREAD_GRAYSCALE);
    std::vector<fs::path> clips;
    for (const auto& clip : fs::directory_iterator(fs::path(argument) / "clips"))
      clips.push_back(clip.path());
    std::sort(clips.begin(), clips.end());
    for (const auto& path : clips) {
      const Clip clip = Steadied(Pictures(path / "turb", cv::IMREAD_COLOR));
      std::vector<cv::Mat> truth = Pictures(path / "mask", cv::IMREAD_GRAYSCALE), own, known;
      for (size_t k = 0; k < truth.size(); ++k) {
        own.push_back(clip.frames[k].own);
        known.push_back(own[k].clone());
        if (k < labels.size()) known[k].setTo(0, (labels[k] == 85) | (labels[k] == 170));
      }
      double aof_ms = 0, fused_ms = 0;
      const auto aof = fused_only ? truth : Masks(clip.frames, SegmentMethod::kAof, aof_ms);
      const auto fused = Masks(clip.frames, SegmentMethod::kFused, fused_ms);
      if (!stages.empty()) {
        const fs::path folder = stages / path.filename();
        fs::create_directories(folder);
        for (size_t k = 0; k < fused.size(); ++k) {
          char name[32];
          std::snprintf(name, sizeof name, "%04zu", k);
          cv::imwrite((folder / (std::string(name) + "_fused.png")).string(), fused[k]);
          cv::imwrite((folder / (std::string(name) + "_aof.png")).string(), aof[k]);
          cv::imwrite((folder / (std::string(name) + "_frame.png")).string(), clip.frames[k].frame);
        }
      }
      if (truth.empty()) continue;
      const double rms = strength[std::stoi(path.filename().string())];
      const double a = MeanIou(aof, truth, known), f = MeanIou(fused, truth, known);
      by_strength[rms].emplace_back(a, f);
      table.Add({path.parent_path().parent_path().filename() / path.filename(), SizeText(truth[0].size()),
                 Number(rms, 1), Number(MeanIou(aof, truth, own), 3), Number(MeanIou(fused, truth, own), 3),
                 Number(a, 3), Number(f, 3), Number(fused_ms, 1)});
    }
  }
  table.Print();
  for (const auto& [rms, ious] : by_strength) {
    double a = 0, f = 0;
    for (const auto& [x, y] : ious) a += x, f += y;
    const double n = static_cast<double>(ious.size());
    std::printf("tilt RMS %.1f px, %zu clips: aof %.3f, fused %.3f\n", rms, ious.size(), a / n, f / n);
  }
}
