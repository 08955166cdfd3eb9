#include "sim/app/job.h"

#include "sim/app/clean_frames.h"
#include "sim/dataset/files.h"

namespace shimmer::app {
ConfigFile LoadConfig(const std::filesystem::path& path, std::span<const std::string> sets) {
  std::vector<uint8_t> bytes;
  try {
    bytes = dataset::ReadFile(path);
  } catch (const std::runtime_error& error) {
    throw std::invalid_argument(error.what());
  }
  return ConfigFile::Parse(std::string(bytes.begin(), bytes.end()), sets);
}

Job Job::Load(const std::filesystem::path& config_path, std::span<const std::string> sets,
              const std::filesystem::path& out) {
  ConfigFile config = LoadConfig(config_path, sets);
  SourceList sources = SourceList::Find(config.fixed().source, config_path.parent_path(), out);
  return {std::move(config), std::move(sources)};
}

Json Job::Description() const {
  Json description = {{"config", config.resolved()},
                      {"config_hash", config.Hash()},
                      {"engine", kEngine},
                      {"sources", sources.Records()},
                      {"version", kVersion}};
  const dataset::Layout layout = Layout();
  if (layout.kind == dataset::LayoutKind::kPairs) description["pair_digits"] = layout.digits;
  return description;
}

dataset::Layout Job::Layout() const {
  const OutputParams& output = config.fixed().output;
  return {.kind = output.layout == LayoutKind::kPairs ? dataset::LayoutKind::kPairs
                                                      : dataset::LayoutKind::kSequence,
          .format = EncodingOf(output).format,
          .name = output.name,
          .test_fraction = output.test_fraction,
          .frames_per_clip = output.frames_per_clip,
          .digits = dataset::PairDigits(config.fixed().clips, output.frames_per_clip)};
}

int KeptFrameCount(const Config& config) {
  return config.output.layout == LayoutKind::kPairs ? config.output.frames_per_clip : config.frames;
}

sim::ClipShape ShapeOf(const Config& config) {
  return {.size = config.size, .frames = KeptFrameCount(config), .first_frame = config.first_frame};
}

sim::Scene SceneOf(const Config& config, bool still) {
  // Frames that are linear light already need no decoding around the simulation.
  const bool decode = config.colour == sim::Colour::kLinear && !OutputIsLinear(config);
  return {.tilt = config.tilt,
          .blur = config.blur,
          .still = still,
          .colour = decode ? sim::Colour::kLinear : sim::Colour::kStored};
}

sim::ClipPlan PlanOf(const Config& config, bool still) {
  return sim::PlanClip(SceneOf(config, still), ShapeOf(config), config.accuracy);
}

}  // namespace shimmer::app
