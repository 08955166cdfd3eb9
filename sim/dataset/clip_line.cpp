#include "sim/dataset/clip_line.h"

#include <map>
#include <set>
#include <stdexcept>
#include <string>

#include "sim/dataset/numbered_name.h"

namespace shimmer::dataset {

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
  const std::map<FrameKind, int64_t> right = {{FrameKind::kTurb, contents.frames},
                                              {FrameKind::kClean, line.one_clean ? 1 : contents.frames},
                                              {FrameKind::kTruth, contents.truth ? contents.frames : 0}};
  for (const auto& [kind, files] : right)
    if (count[kind] != files)
      throw std::runtime_error("names " + std::to_string(count[kind]) +
                               (kind == FrameKind::kTurb    ? " turbulent"
                                : kind == FrameKind::kClean ? " clean"
                                                            : " truth") +
                               " files, must be " + std::to_string(files));
  if (layout.IsTars() &&
      !names.contains(layout.TarPath(layout.UnitOf(clip)) + "/" + Padded(clip, 6) + ".json"))
    throw std::runtime_error("does not name its .json in the tar");
  return line;
}

}  // namespace shimmer::dataset
