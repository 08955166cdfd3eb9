#include "sim/dataset/derived_files.h"

#include <algorithm>
#include <stdexcept>

#include "sim/dataset/dataset_folder.h"
#include "sim/dataset/files.h"
#include "sim/dataset/numbered_name.h"
#include "sim/dataset/restormer_options.h"
#include "sim/dataset/tar.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;

struct Shape {
  int64_t width, height, channels;

  std::string Text() const {
    return "(" + std::to_string(height) + "," + std::to_string(width) + "," + std::to_string(channels) + ")";
  }
};

Shape ShapeOf(const Json& line) {
  try {
    return {line.at("size").at(0).get<int64_t>(), line.at("size").at(1).get<int64_t>(),
            line.at("channels").get<int64_t>()};
  } catch (const Json::exception&) {
    throw std::runtime_error("clip " + line.value("clip", Json()).dump() +
                             ": damaged line, must have size and channels");
  }
}

// Calls visit(clip, line) for each clip that is done.
template <class Visit>
void ForEachDone(const DatasetReader& set, const Visit& visit) {
  set.manifest().ForEachLine([&](int64_t clip, const Json& line) {
    if (set.clips().contains(clip)) visit(clip, line);
  });
}

std::map<std::string, std::string> OfRestormer(const DatasetReader& set, const Layout& layout) {
  std::map<std::string, std::string> files;
  int64_t smallest_side = INT64_MAX;
  bool has_test = false;
  ForEachDone(set, [&](int64_t clip, const Json& line) {
    const Shape shape = ShapeOf(line);
    smallest_side = std::min({smallest_side, shape.width, shape.height});
    const bool test = IsTestClip(clip, layout.test_fraction);
    has_test = has_test || test;
    std::string& text = files[layout.name + (test ? "/test" : "/train") + "/meta_info.txt"];
    for (int64_t frame = 0; frame < layout.frames_per_clip; ++frame)
      text += fs::path(layout.Path(FrameKind::kTurb, clip, frame)).filename().string() + " " + shape.Text() +
              "\n";
  });
  // EXR is nothing that Restormer's loader reads: no options are better than some that can't work.
  if (!files.empty() && layout.format == FileFormat::kPng)
    files[layout.name + "/restormer.yml"] = RestormerOptions(layout.name, smallest_side, has_test);
  return files;
}

std::map<std::string, std::string> OfBasicsr(const DatasetReader& set, const Layout& layout) {
  std::map<std::string, std::string> files;
  ForEachDone(set, [&](int64_t clip, const Json& line) {
    const fs::path folder = fs::path(layout.Path(FrameKind::kTurb, clip, 0)).parent_path();  // part001/lq/000
    const fs::path part = folder.parent_path().parent_path();
    files[(part / "meta_info.txt").string()] += folder.filename().string() + " " +
                                                line.value("frames", Json()).dump() + " " +
                                                ShapeOf(line).Text() + "\n";
  });
  return files;
}

std::map<std::string, std::string> OfTars(const DatasetReader& set, const Layout& layout) {
  struct Tar {
    int64_t clips = 0, members_bytes = 0;
  };
  std::map<int64_t, Tar> tars;
  ForEachDone(set, [&](int64_t clip, const Json& line) {
    Tar& tar = tars[layout.UnitOf(clip)];
    ++tar.clips;
    for (const StoredFile& file : FilesOfLine(line)) tar.members_bytes += TarBytes(file.bytes);
  });
  if (tars.empty()) return {};
  Json list = Json::array();
  for (const auto& [unit, tar] : tars)
    list.push_back({{"url", fs::path(layout.TarPath(unit)).filename().string()},
                    {"nsamples", tar.clips},
                    {"filesize", WholeTarBytes(tar.members_bytes)}});
  const Json index = {{"wids_version", 1}, {"shardlist", std::move(list)}};
  return {{fs::path(layout.TarPath(0)).parent_path() / "index.json", index.dump(1) + "\n"}};
}

}  // namespace

std::map<std::string, std::string> DerivedFiles(const DatasetReader& set, const Layout& layout) {
  switch (layout.kind) {
    case LayoutKind::kRestormer:
      return OfRestormer(set, layout);
    case LayoutKind::kBasicsr:
      return OfBasicsr(set, layout);
    case LayoutKind::kWebdataset:
      return OfTars(set, layout);
    case LayoutKind::kSequence:
    case LayoutKind::kPairs:
      break;
  }
  return {};
}

bool IsDerivedPath(const std::string& path, const Layout& layout) {
  const fs::path whole(path);
  const std::string name = whole.filename().string(), folder = whole.parent_path().string();
  switch (layout.kind) {
    case LayoutKind::kRestormer:
      return (name == "meta_info.txt" &&
              (folder == layout.name + "/train" || folder == layout.name + "/test")) ||
             path == layout.name + "/restormer.yml";
    case LayoutKind::kBasicsr:
      return name == "meta_info.txt" && (folder.empty() || NumberedName{"part", 3, ""}.NumberOf(folder));
    case LayoutKind::kWebdataset:
      return path == (fs::path(layout.TarPath(0)).parent_path() / "index.json");
    case LayoutKind::kSequence:
    case LayoutKind::kPairs:
      break;
  }
  return false;
}

void WriteDerivedFiles(const DatasetReader& set, const Layout& layout) {
  for (const auto& [path, text] : DerivedFiles(set, layout))
    WriteDatasetFile(set.folder(), path, AsBytes(text));
}

}  // namespace shimmer::dataset
