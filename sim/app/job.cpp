#include "sim/app/job.h"

#include <algorithm>

#include "sim/app/clean_frames.h"
#include "sim/app/clip_size.h"
#include "sim/dataset/dataset_difference.h"
#include "sim/dataset/dataset_folder.h"
#include "sim/dataset/files.h"

namespace shimmer::app {
namespace {

dataset::Layout LayoutOf(const OutputParams& output, int digits, int64_t clips_per_tar) {
  return {.kind = output.layout,
          .format = EncodingOf(output).format,
          .name = output.name,
          .test_fraction = output.test_fraction,
          .frames_per_clip = output.frames_per_clip,
          .digits = digits,
          .clips_per_tar = clips_per_tar};
}

struct FoundSources {
  SourceList background;
  std::vector<SourceList> objects;
};

FoundSources FindSources(const Config& fixed, const std::filesystem::path& config_folder,
                         const std::filesystem::path& out, const std::atomic<bool>& stop) {
  const auto hashes = std::make_shared<dataset::HashMemory>(out);
  FoundSources found{SourceList::Find(fixed.source, config_folder, out, stop, "/source", hashes), {}};
  for (size_t i = 0; i < fixed.objects.size(); ++i)
    found.objects.push_back(SourceList::Find(fixed.objects[i], config_folder, out, stop,
                                             "/objects/" + std::to_string(i), hashes));
  return found;
}

}  // namespace

ConfigFile ConfigOfDataset(const std::filesystem::path& folder, const Json& description) {
  try {
    return ConfigFile::Parse(description.value("config", Json()).dump());
  } catch (const ConfigError& error) {
    throw std::runtime_error((folder / dataset::kDescriptionName).string() + ":/config" + error.pointer() +
                             ": " + error.what());
  }
}

dataset::Layout LayoutOfDataset(const std::filesystem::path& folder, const Json& description) {
  const OutputParams output = ConfigOfDataset(folder, description).fixed().output;
  try {
    return LayoutOf(output, description.value("pair_digits", 6),
                    description.value("clips_per_tar", int64_t{1}));
  } catch (const Json::exception&) {
    throw std::runtime_error((folder / dataset::kDescriptionName).string() +
                             ": damaged, pair_digits and clips_per_tar must be numbers");
  }
}

dataset::Layout LayoutOfConfig(const ConfigFile& config) {
  const Config& fixed = config.fixed();
  const bool one_clean = fixed.source.video.empty() && fixed.source.sequence.empty() &&
                         fixed.objects.empty() && !fixed.camera.shaken_clean;
  return LayoutOf(fixed.output, dataset::PairDigits(fixed.clips, fixed.output.frames_per_clip),
                  ClipsPerTar(config, one_clean));
}

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
              const std::filesystem::path& out, const std::atomic<bool>& stop) {
  ConfigFile config = LoadConfig(config_path, sets);
  FoundSources found = FindSources(config.fixed(), config_path.parent_path(), out, stop);
  return {std::move(config), std::move(found.background), std::move(found.objects)};
}

Job Job::OfDataset(const std::filesystem::path& folder, const Json& description,
                   const std::filesystem::path& config_folder, const std::atomic<bool>& stop) {
  ConfigFile config = ConfigOfDataset(folder, description);
  FoundSources found;
  try {
    found = FindSources(config.fixed(), config_folder, folder, stop);
  } catch (const ConfigError& error) {
    throw std::runtime_error(folder.string() + ": can't be made again: " + error.pointer() + ": " +
                             error.what());
  }
  Job job{std::move(config), std::move(found.background), std::move(found.objects)};
  const std::vector<std::string> differences = dataset::Differences(description, job.Description());
  if (!differences.empty())
    throw std::runtime_error(folder.string() + ": can't be made again: " + dataset::InOneLine(differences));
  return job;
}

void Job::RememberSources(const std::filesystem::path& out) {
  // One memory is behind all of them.
  sources.Remember(out);
  for (SourceList& list : object_sources) list.Remember(out);
}

bool Job::FromFiles() const {
  return sources.kind() != SourceKind::kDrawn ||
         std::ranges::any_of(object_sources,
                             [](const SourceList& list) { return list.kind() != SourceKind::kDrawn; });
}

Json Job::Description() const {
  Json all_sources = sources.Records();
  for (size_t i = 0; i < object_sources.size(); ++i)
    for (Json record : object_sources[i].Records()) {
      record["object"] = i;
      all_sources.push_back(std::move(record));
    }
  Json description = {{"config", config.resolved()},
                      {"config_hash", config.Hash()},
                      {"engine", kEngine},
                      {"sources", std::move(all_sources)},
                      {"version", kVersion}};
  const dataset::Layout layout = Layout();
  if (layout.IsPairs()) description["pair_digits"] = layout.digits;
  if (layout.IsTars()) description["clips_per_tar"] = layout.clips_per_tar;
  return description;
}

dataset::Layout Job::Layout() const { return LayoutOfConfig(config); }

int KeptFrameCount(const Config& config) {
  const bool pairs =
      config.output.layout == LayoutKind::kPairs || config.output.layout == LayoutKind::kRestormer;
  return pairs ? config.output.frames_per_clip : config.frames;
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
          .colour = decode ? sim::Colour::kLinear : sim::Colour::kStored,
          .sensor = config.sensor,
          .camera = config.camera,
          .objects = static_cast<int>(std::ranges::count_if(config.objects, &ObjectParams::present)),
          .own_distances = std::ranges::any_of(config.objects, [](const ObjectParams& object) {
            return object.present && object.distance != 1;
          })};
}

sim::ClipPlan PlanOf(const Config& config, bool still) {
  return sim::PlanClip(SceneOf(config, still), ShapeOf(config), config.accuracy);
}

}  // namespace shimmer::app
