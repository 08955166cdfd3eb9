#include "restore/restormer_tensors.h"

#include <set>
#include <stdexcept>

namespace shimmer::restore {
namespace {

constexpr const char *kSampleInput = "sample.input", *kSampleOutput = "sample.output";

class List {
 public:
  explicit List(const RestormerShape& shape) : shape_(shape) {}

  void Add(const std::string& name, std::vector<int64_t> shape) {
    tensors_.push_back({name, std::move(shape)});
  }

  void AddBlocks(const std::string& stage, int blocks, int64_t channels, int heads) {
    const int64_t hidden = shape_.Hidden(static_cast<int>(channels));
    for (int block = 0; block < blocks; ++block) {
      const std::string name = stage + "." + std::to_string(block) + ".";
      AddNorm(name + "norm1", channels);
      Add(name + "attention.temperature", {heads});
      Add(name + "attention.qkv.weight", {3 * channels, channels, 1, 1});
      Add(name + "attention.depthwise.weight", {3 * channels, 1, 3, 3});
      Add(name + "attention.project.weight", {channels, channels, 1, 1});
      AddNorm(name + "norm2", channels);
      Add(name + "feed_forward.project_in.weight", {2 * hidden, channels, 1, 1});
      Add(name + "feed_forward.depthwise.weight", {2 * hidden, 1, 3, 3});
      Add(name + "feed_forward.project_out.weight", {channels, hidden, 1, 1});
    }
  }

  std::vector<TensorShape> Take() { return std::move(tensors_); }

 private:
  void AddNorm(const std::string& name, int64_t channels) {
    Add(name + ".weight", {channels});
    if (shape_.norm_with_bias) Add(name + ".bias", {channels});
  }

  const RestormerShape& shape_;
  std::vector<TensorShape> tensors_;
};

}  // namespace

std::vector<TensorShape> RestormerTensors(const RestormerShape& shape) {
  List list(shape);
  const int64_t image_channels = 3LL * shape.unshuffle * shape.unshuffle;
  const int bottom = shape.Levels() - 1;
  list.Add("embed.weight", {shape.width, image_channels, 3, 3});
  for (int level = 0; level <= bottom; ++level) {
    const size_t l = static_cast<size_t>(level);
    const int64_t channels = shape.Channels(level);
    list.AddBlocks("encoder." + std::to_string(level), shape.blocks[l], channels, shape.heads[l]);
    if (level < bottom) list.Add("down." + std::to_string(level) + ".weight", {channels / 2, channels, 3, 3});
  }
  for (int level = bottom - 1; level >= 0; --level) {
    const size_t l = static_cast<size_t>(level);
    const int64_t channels = shape.Channels(level);
    list.Add("up." + std::to_string(level) + ".weight", {4 * channels, 2 * channels, 3, 3});
    if (level > 0) list.Add("reduce." + std::to_string(level) + ".weight", {channels, 2 * channels, 1, 1});
    list.AddBlocks("decoder." + std::to_string(level), shape.blocks[l], shape.DecoderChannels(level),
                   shape.heads[l]);
  }
  list.AddBlocks("refinement", shape.refinement, shape.DecoderChannels(0), shape.heads[0]);
  list.Add("output.weight", {image_channels, shape.DecoderChannels(0), 3, 3});
  return list.Take();
}

void CheckRestormerTensors(const SafeTensors& file, const RestormerShape& shape) {
  const auto refuse = [&](const std::string& what) { throw std::runtime_error(file.file + ": " + what); };
  std::set<std::string> known{kSampleInput, kSampleOutput};
  for (const auto& [name, wanted] : RestormerTensors(shape)) {
    known.insert(name);
    const auto found = file.tensors.find(name);
    if (found == file.tensors.end())
      refuse("tensor " + name + " is missing, must be " + ShapeText(wanted) + " by the model card");
    if (found->second.shape != wanted)
      refuse("tensor " + name + " is " + ShapeText(found->second.shape) + ", must be " + ShapeText(wanted) +
             " by the model card");
  }
  for (const auto& [name, tensor] : file.tensors)
    if (!known.count(name))
      refuse("tensor " + name + ", " + ShapeText(tensor.shape) + ", is none of the model card's network");
  const bool input = file.tensors.count(kSampleInput), output = file.tensors.count(kSampleOutput);
  if (!input && !output) return;
  for (const char* name : {kSampleInput, kSampleOutput}) {
    if (!file.tensors.count(name)) refuse(std::string("tensor ") + name + " is missing: the other is there");
    const std::vector<int64_t>& shape_of = file.tensors.at(name).shape;
    if (shape_of.size() != 3 || shape_of[0] != 3)
      refuse(std::string("tensor ") + name + " is " + ShapeText(shape_of) + ", must be [3, height, width]");
  }
  if (file.tensors.at(kSampleInput).shape != file.tensors.at(kSampleOutput).shape)
    refuse(std::string("tensor ") + kSampleOutput + " is " + ShapeText(file.tensors.at(kSampleOutput).shape) +
           ", must be as large as " + kSampleInput);
}

}  // namespace shimmer::restore
