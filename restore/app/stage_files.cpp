#include "restore/app/stage_files.h"

#include <stdexcept>

#include "restore/app/plan_text.h"
#include "sim/dataset/files.h"

namespace shimmer::restore::app {

StageFiles::StageFiles(std::filesystem::path folder) : folder_(std::move(folder)) {
  if (std::filesystem::exists(folder_) &&
      !(std::filesystem::is_directory(folder_) && std::filesystem::is_empty(folder_)))
    throw std::invalid_argument("--stages " + folder_.string() +
                                ": is there already, must be new or an empty folder");
}

void StageFiles::AddTo(const std::string& name, const cv::Mat& picture) {
  if (picture.empty()) return;
  std::unique_ptr<FrameSink>& sink = sinks_[name];
  if (!sink) sink = OpenSink(folder_ / name, /*frames_per_s=*/1);
  sink->Add(picture);
}

void StageFiles::Add(const FrameOnWay& frame) {
  AddTo("stabilised", frame.steady);
  AddTo("own", frame.own);
  AddTo("mask", frame.mask);
  AddTo("background", frame.background);
}

void StageFiles::Finish(const VideoFacts& facts, const RestorePlan& plan) {
  for (auto& [name, sink] : sinks_) sink->Finish();
  dataset::MakeFolders(folder_);
  const std::string text = PlanJson(facts, plan).dump(2) + "\n";
  dataset::WriteFileAtomically(folder_ / "plan.json", dataset::AsBytes(text));
}

}  // namespace shimmer::restore::app
