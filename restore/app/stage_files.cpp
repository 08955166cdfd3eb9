#include "restore/app/stage_files.h"

#include <stdexcept>

#include "restore/app/plan_text.h"
#include "restore/app/strength_map.h"
#include "sim/dataset/files.h"
#include "sim/dataset/image_io.h"

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
  AddTo("blended", frame.blended);
}

void StageFiles::Finish(const VideoFacts& facts, const RestorePlan& plan, const std::optional<Optics>& optics,
                        const SharpenCounts& counts) {
  for (auto& [name, sink] : sinks_) sink->Finish();
  dataset::MakeFolders(folder_);
  const std::string text = PlanJson(facts, plan, counts).dump(2) + "\n";
  dataset::WriteFileAtomically(folder_ / "plan.json", dataset::AsBytes(text));
  if (!facts.scene) return;
  const TurbulenceStrength& strength = facts.scene->strength;
  const std::string strength_text = StrengthJson(strength, optics, plan).dump(2) + "\n";
  dataset::WriteFileAtomically(folder_ / "strength.json", dataset::AsBytes(strength_text));
  dataset::WriteFileAtomically(folder_ / "strength.exr", StrengthExr(strength, optics));
  dataset::WriteFileAtomically(folder_ / "strength.png",
                               dataset::EncodePng(StrengthPicture(strength, optics), 8));
}

}  // namespace shimmer::restore::app
