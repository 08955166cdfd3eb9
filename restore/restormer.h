// Restoration of an image by a Restormer network.
#pragma once

#include <filesystem>
#include <memory>

#include <opencv2/core.hpp>

#include "restore/model_card.h"

namespace shimmer::restore {

// The network of Zamir et al., "Restormer: Efficient Transformer for High-Resolution Image Restoration",
// CVPR 2022, section 3 and figure 2, with weights from a file (restore/restormer_tensors.h lists them) and
// the sizes that the file's model card states. With unshuffle u > 1 all of it works on px of u^2 px each.
//
// Exact: floats all along, without any shortcut. What comes out is off by 2e-6 at most from what PyTorch
// computes in floats with the same weights, or a program in doubles, for networks of ten or so blocks;
// rounding grows with the depth, to 3e-6 for the paper's network of 44 blocks with random weights
// (bench_sharpen).
class Restormer {
 public:
  // Throws std::runtime_error with the file and what is wrong: one that cannot be read, a card or tensors
  // that are not as they must be (ReadSafeTensors, ReadModelCard, CheckRestormerTensors say how), or weights
  // that make of a recorded sample's input anything but its output, to within 1e-4.
  explicit Restormer(const std::filesystem::path& file);
  explicit Restormer(const SafeTensors& file);
  ~Restormer();

  const ModelCard& Card() const;

  // image: RGB in [0, 1], CV_32FC3, 1x1 or larger; it is reflected at the right and bottom up to the
  // network's multiple. The result is as large, and not clamped. On all threads of TBB's arena, with the same
  // bytes on any number of them; may be called from several threads at once. An image of N px takes about
  // 32 N width / u^2 bytes (of 1080p and width 16, u = 2: 280 MB), which are kept for the next one.
  //
  // Throws std::invalid_argument where the image is empty or of another type.
  cv::Mat Run(const cv::Mat& image) const;

 private:
  struct Network;
  void CheckSample(const SafeTensors& file) const;

  std::unique_ptr<const Network> network_;
};

}  // namespace shimmer::restore
