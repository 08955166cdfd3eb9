#include "tests/restore/random_network.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "restore/restormer_tensors.h"

namespace shimmer::restore {
namespace {

bool EndsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

}  // namespace

std::string CardText(const RestormerShape& shape) {
  return nlohmann::json{{"format", 1},
                        {"network", "restormer"},
                        {"name", "random"},
                        {"width", shape.width},
                        {"blocks", shape.blocks},
                        {"heads", shape.heads},
                        {"refinement", shape.refinement},
                        {"expansion", shape.expansion},
                        {"norm", shape.norm_with_bias ? "with_bias" : "bias_free"},
                        {"unshuffle", shape.unshuffle},
                        {"tile", 256},
                        {"overlap", 32}}
      .dump();
}

SafeTensors RandomNetwork(const RestormerShape& shape, uint64_t seed) {
  SafeTensors file{"random.safetensors", {{"card", CardText(shape)}}, {}};
  cv::RNG random(seed);
  for (const auto& [name, wanted] : RestormerTensors(shape)) {
    size_t count = 1, inputs = 1;  // inputs: of one output
    for (size_t axis = 0; axis < wanted.size(); ++axis) {
      count *= static_cast<size_t>(wanted[axis]);
      if (axis > 0) inputs *= static_cast<size_t>(wanted[axis]);
    }
    double mean = 0, sd = 1 / std::sqrt(static_cast<double>(inputs));
    if (EndsWith(name, "norm1.weight") || EndsWith(name, "norm2.weight") || EndsWith(name, "temperature"))
      mean = 1, sd = 0.2;
    else if (EndsWith(name, ".bias"))
      sd = 0.1;
    else if (name == "output.weight")
      sd *= 0.1;
    Tensor tensor{wanted, std::vector<float>(count)};
    for (float& value : tensor.values) value = static_cast<float>(mean + random.gaussian(sd));
    file.tensors.emplace(name, std::move(tensor));
  }
  return file;
}

double MultiplyAdds(const RestormerShape& shape, cv::Size image) {
  const auto rounded = [&](int px) {
    return (px + shape.SizeMultiple() - 1) / shape.SizeMultiple() * shape.SizeMultiple() / shape.unshuffle;
  };
  const double px = static_cast<double>(rounded(image.width)) * rounded(image.height);
  const auto at = [&](int level) { return px / std::pow(4.0, level); };
  const auto block = [&](int channels, int heads) {
    const double c = channels, hidden = shape.Hidden(channels);
    return 4 * c * c + 27 * c + 2 * c * c / heads + 3 * hidden * c + 18 * hidden;
  };
  double sum = 0;
  for (int l = 0; l < shape.Levels(); ++l) {
    const size_t i = static_cast<size_t>(l);
    sum += at(l) * shape.blocks[i] * block(shape.Channels(l), shape.heads[i]);
    if (l + 1 == shape.Levels()) continue;
    sum += at(l) * shape.blocks[i] * block(shape.DecoderChannels(l), shape.heads[i]);
    const double c = shape.Channels(l);
    sum += at(l) * 9 * c * c / 2 + at(l + 1) * 9 * 8 * c * c + (l > 0 ? at(l) * 2 * c * c : 0);
  }
  sum += px * shape.refinement * block(2 * shape.width, shape.heads[0]);
  return sum + px * 9 * 3 * shape.unshuffle * shape.unshuffle * 3 * shape.width;
}

double ParameterCount(const RestormerShape& shape) {
  double sum = 0;
  for (const TensorShape& tensor : RestormerTensors(shape)) {
    double count = 1;
    for (const int64_t length : tensor.shape) count *= static_cast<double>(length);
    sum += count;
  }
  return sum;
}

cv::Mat RandomImage(cv::Size size, uint64_t seed) {
  cv::Mat image(size, CV_32FC3);
  cv::RNG random(seed);
  random.fill(image, cv::RNG::UNIFORM, 0, 1);
  return image;
}

}  // namespace shimmer::restore
