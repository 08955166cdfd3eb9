#include "sim/dataset/clip_line.h"

#include <map>
#include <set>
#include <stdexcept>
#include <string>

#include "sim/dataset/numbered_name.h"

namespace shimmer::dataset {
namespace {

const char* WordFor(FrameKind kind) {
  switch (kind) {
    case FrameKind::kTurb:
      return "turbulent";
    case FrameKind::kClean:
      return "clean";
    case FrameKind::kTruth:
      return "truth";
    case FrameKind::kMask:
      return "mask";
    case FrameKind::kFlow:
      return "flow";
    case FrameKind::kShake:
      return "shake";
  }
  return "";
}

}  // namespace

ClipLine ReadClipLine(const Contents& contents, int64_t clip) {
  const Json json = contents.set.Line(clip);
  const Layout& layout = contents.layout;
  ClipLine line{.clip = clip, .files = FilesOfLine(json), .shape = {}, .one_clean = false};
  try {
    line.shape = {json.at("size").at(0).get<int64_t>(), json.at("size").at(1).get<int64_t>(),
                  json.at("channels").get<int64_t>()};
    if (const auto frames = json.at("frames").get<int64_t>(); frames != contents.frames)
      throw std::runtime_error("says " + std::to_string(frames) + " frames, must be " +
                               std::to_string(contents.frames));
  } catch (const Json::exception&) {
    throw std::runtime_error("must have size, channels and frames");
  }
  std::map<FrameKind, int64_t> count;
  std::set<std::string> names;
  for (const StoredFile& file : line.files) {
    const std::string name = file.name();
    if (!names.insert(name).second) throw std::runtime_error("names " + name + " twice");
    if (file.sha256.empty()) throw std::runtime_error("has no sha256 of " + name);
    if (layout.IsTars() && file.member == Padded(clip, 6) + ".json" &&
        file.path == layout.TarPath(layout.UnitOf(clip)))
      continue;
    const auto place = layout.PlaceOf(name);
    if (!place || place->clip != clip || place->frame >= contents.frames)
      throw std::runtime_error("names " + name + ", which is no file of this clip");
    ++count[place->kind];
  }
  line.one_clean = layout.OneCleanFile() && count[FrameKind::kClean] == 1;
  for (const FrameKind kind : kFrameKinds) {
    const int64_t right = contents.FilesOf(kind, line.one_clean);
    if (count[kind] != right)
      throw std::runtime_error("names " + std::to_string(count[kind]) + " " + WordFor(kind) +
                               " files, must be " + std::to_string(right));
  }
  if (layout.IsTars() &&
      !names.contains(layout.TarPath(layout.UnitOf(clip)) + "/" + Padded(clip, 6) + ".json"))
    throw std::runtime_error("does not name its .json in the tar");
  return line;
}

}  // namespace shimmer::dataset
