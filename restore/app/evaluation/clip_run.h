// One clip restored in several ways, each measured against the truth as it comes out.
#pragma once

#include <atomic>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "restore/app/evaluation/results.h"
#include "restore/app/evaluation/true_clip.h"
#include "restore/app/evaluation/variants.h"

namespace shimmer::restore::app {

// Turbulent frames of a clip, and the time that reading them took.
class TurbFrames : public Frames {
 public:
  TurbFrames(TrueClip& clip, const std::atomic<bool>& stop) : clip_(clip), stop_(stop) {}
  int64_t count() override { return clip_.facts().frames; }
  cv::Mat Read(int64_t frame) override;  // throws dataset::Interrupted once stop is set
  double seconds() const { return seconds_; }

 private:
  TrueClip& clip_;
  const std::atomic<bool>& stop_;
  double seconds_ = 0;
};

class ClipRun {
 public:
  // is_real: nothing is known of the clip; what is held against the result are its steadied frames.
  // pictures: the folder for those of the report (pictures.h).
  ClipRun(TrueClip& clip, bool is_real, std::filesystem::path pictures, const std::atomic<bool>& stop);

  // The rows of one variant; of a real video the full pipeline's bring those of the input. tools: opened by
  // its settings. Throws what restoring and reading throw, dataset::Interrupted once stop is set.
  std::vector<ResultRow> Run(const Variant& variant, const RestoreTools& tools);

 private:
  struct Look {
    LookedAt looked;
    double seconds = 0;  // without reading
  };
  // Once for all variants that look in the same way.
  const Look& LookBy(const RestoreSettings& settings, const RestoreTools& tools);

  std::vector<ResultRow> RunInput();
  std::vector<ResultRow> RunPipeline(const Variant& variant, const RestoreTools& tools);
  std::vector<ResultRow> RunBaseline(const Variant& variant, const RestoreTools& tools);
  std::vector<ResultRow> RunMethod(const Variant& variant);

  TrueClip& clip_;
  bool is_real_;
  std::filesystem::path pictures_;
  const std::atomic<bool>& stop_;
  TurbFrames video_;
  std::map<std::string, Look> looks_;  // by what of the settings they depend on
};

// Where the results of a method are: FOLDER/CLIP, or FOLDER/CLIP.mp4 or another video; or FOLDER/clips/CLIP.
// Throws std::invalid_argument where there is none, or where it has not as many frames as the clip.
std::filesystem::path FindResults(const std::filesystem::path& folder, const std::string& clip);

}  // namespace shimmer::restore::app
