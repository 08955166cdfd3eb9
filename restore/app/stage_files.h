// What each stage makes, in a folder of its own, for people who want to see it.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "restore/app/frame_sink.h"
#include "restore/plan.h"
#include "restore/stages.h"

namespace shimmer::restore::app {

// FOLDER/stabilised/0000.png, own/0000.png and so on, for those stages that the plan has; FOLDER/plan.json;
// and, where the turbulence was measured, FOLDER/strength.json, .exr and .png (strength_map.h).
class StageFiles {
 public:
  // Throws std::invalid_argument where the folder is there, and not empty.
  explicit StageFiles(std::filesystem::path folder);

  void Add(const FrameOnWay& frame);
  // counts: of the tiles that were sharpened.
  void Finish(const VideoFacts& facts, const RestorePlan& plan, const std::optional<Optics>& optics,
              const SharpenCounts& counts);

 private:
  void AddTo(const std::string& name, const cv::Mat& picture);

  std::filesystem::path folder_;
  std::map<std::string, std::unique_ptr<FrameSink>> sinks_;
};

}  // namespace shimmer::restore::app
