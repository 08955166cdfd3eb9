#include "restore/restormer.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <stdexcept>

#include "restore/convolution.h"
#include "restore/pixel_shuffle.h"
#include "restore/planes.h"
#include "restore/restormer_block.h"
#include "restore/restormer_tensors.h"

namespace shimmer::restore {
namespace {

using Blocks = std::vector<RestormerBlock>;

constexpr double kSampleError = 1e-4;  // samples are recorded by other programs, maybe on other machines

Panels RunBlocks(const Blocks& blocks, Panels x, Workspace& workspace) {
  if (blocks.empty()) return x;
  Panels spare_a(x.Channels(), x.Size(), workspace), spare_b(x.Channels(), x.Size(), workspace);
  for (const RestormerBlock& block : blocks) block.Run(x, spare_a, spare_b, workspace);
  return x;
}

// first * a + second * b: a 1x1 convolution of both one after the other, without putting them together.
struct Reduction {
  PackedMatrix first, second;

  Panels Run(const Panels& a, const Panels& b, Workspace& workspace) const {
    Panels out(first.Rows(), a.Size(), workspace);
    tbb::parallel_for(0, a.Size().height, [&](int y) {
      const RowPlace to{out.At(y, 0), out.PanelStride(), kPanelPx};
      Multiply(first, a.At(y, 0), 0, a.Size().width, to);
      Multiply(second, b.At(y, 0), 0, a.Size().width, to, to.data);
    });
    return out;
  }
};

}  // namespace

struct Restormer::Network {
  struct Level {  // but for the bottom all of it
    Blocks encoder, decoder;
    Convolution down, up;
    Reduction reduce;  // level 0 has none
  };

  ModelCard card;
  Convolution embed, output;
  std::vector<Level> levels;
  Blocks refinement;
  mutable Workspace workspace;

  explicit Network(const SafeTensors& file) : card(ReadModelCard(file)) {
    const RestormerShape& shape = card.shape;
    CheckRestormerTensors(file, shape);
    const auto convolution = [&](const std::string& name) {
      return Convolution(file.tensors.at(name + ".weight"));
    };
    const auto blocks = [&](const std::string& name, int count) {
      Blocks made;
      for (int i = 0; i < count; ++i) made.emplace_back(file, name + "." + std::to_string(i), shape);
      return made;
    };
    embed = convolution("embed");
    for (int l = 0; l < shape.Levels(); ++l) {
      const std::string at = "." + std::to_string(l);
      const int count = shape.blocks[static_cast<size_t>(l)], channels = shape.Channels(l);
      Level level;
      level.encoder = blocks("encoder" + at, count);
      if (l + 1 < shape.Levels()) {
        level.down = convolution("down" + at);
        level.up = convolution("up" + at);
        level.decoder = blocks("decoder" + at, count);
      }
      if (l > 0 && l + 1 < shape.Levels()) {
        const float* weights = file.tensors.at("reduce" + at + ".weight").values.data();
        const size_t stride = 2 * static_cast<size_t>(channels);
        level.reduce = {PackedMatrix(weights, channels, channels, stride),
                        PackedMatrix(weights + channels, channels, channels, stride)};
      }
      levels.push_back(std::move(level));
    }
    refinement = blocks("refinement", shape.refinement);
    output = convolution("output");
  }

  // What comes out of level l's decoder, of what comes into its encoder; the bottom has no decoder.
  Panels RunLevel(size_t l, Panels x, Workspace& workspace) const {
    const Level& level = levels[l];
    x = RunBlocks(level.encoder, std::move(x), workspace);
    if (l + 1 == levels.size()) return x;
    Panels below = Unshuffled(level.down.Run(x, workspace), workspace);
    below = level.up.Run(RunLevel(l + 1, std::move(below), workspace), workspace);
    Panels up(l == 0 ? 2 * x.Channels() : x.Channels(), x.Size(), workspace);
    Shuffle(below, up);
    if (l == 0)
      CopyChannels(x, x.Channels(), up);
    else
      up = level.reduce.Run(up, x, workspace);
    x.Free();
    below.Free();
    return RunBlocks(level.decoder, std::move(up), workspace);
  }
};

Restormer::Restormer(const std::filesystem::path& file) : Restormer(ReadSafeTensors(file)) {}

Restormer::Restormer(const SafeTensors& file) : network_(std::make_unique<Network>(file)) {
  if (file.tensors.count("sample.input")) CheckSample(file);
}

Restormer::~Restormer() = default;

const ModelCard& Restormer::Card() const { return network_->card; }

cv::Mat Restormer::Run(const cv::Mat& image) const {
  if (image.empty() || image.type() != CV_32FC3)
    throw std::invalid_argument("an image for a Restormer is " +
                                (image.empty() ? "empty" : cv::typeToString(image.type())) +
                                ", must be CV_32FC3 of 1x1 px or more");
  const RestormerShape& shape = network_->card.shape;
  Workspace& workspace = network_->workspace;
  Panels x = UnshuffledImage(image, shape.unshuffle, shape.SizeMultiple(), workspace);
  x = network_->RunLevel(0, network_->embed.Run(x, workspace), workspace);
  x = RunBlocks(network_->refinement, std::move(x), workspace);
  return ChangedImage(image, network_->output.Run(x, workspace), shape.unshuffle);
}

void Restormer::CheckSample(const SafeTensors& file) const {
  const Tensor &input = file.tensors.at("sample.input"), &output = file.tensors.at("sample.output");
  const cv::Size size(static_cast<int>(input.shape[2]), static_cast<int>(input.shape[1]));
  const cv::Mat made = Run(PictureOfPlanes(input.values.data(), size)),
                expected = PictureOfPlanes(output.values.data(), size);
  const double error = cv::checkRange(made) ? cv::norm(made, expected, cv::NORM_INF) : INFINITY;
  if (!(error <= kSampleError))
    throw std::runtime_error(file.file + ": its network makes of sample.input something that is off by " +
                             std::to_string(error) + " from sample.output, must be 0.0001 at most");
}

}  // namespace shimmer::restore
