#include "sim/dataset/layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "sim/dataset/numbered_name.h"

namespace shimmer::dataset {
namespace {

constexpr const char* kShakeName = "shake";

std::string ExtensionOf(FrameKind kind, FileFormat frames) {
  switch (kind) {
    case FrameKind::kTurb:
    case FrameKind::kClean:
      return Extension(frames);
    case FrameKind::kMask:
      return "png";
    case FrameKind::kTruth:
    case FrameKind::kFlow:
      return "exr";
    case FrameKind::kShake:
      return "json";
  }
  throw std::logic_error("a frame of no kind");
}

// What a kind of frame is called, by layout: as its training code says.
std::string FolderOf(FrameKind kind, LayoutKind layout) {
  if (kind == FrameKind::kTruth) return "truth";
  if (kind == FrameKind::kMask) return "mask";
  if (kind == FrameKind::kFlow) return "flow";
  if (kind == FrameKind::kShake) return kShakeName;
  const bool turb = kind == FrameKind::kTurb;
  switch (layout) {
    case LayoutKind::kPairs:
      return turb ? "turb" : "noturb";
    case LayoutKind::kRestormer:
    case LayoutKind::kBasicsr:
      return turb ? "lq" : "gt";
    case LayoutKind::kSequence:
    case LayoutKind::kWebdataset:
      break;
  }
  return turb ? "turb" : "clean";
}

// "clips" of the first thousand clips, "clips.001" of the second.
std::string ThousandOf(int64_t clip) {
  const int64_t thousand = clip / kClipsPerFolder;
  return thousand == 0 ? "clips" : "clips." + Padded(thousand, 3);
}

// The first number in a name: 7 of "0007.png", 1 of "part001".
std::optional<int64_t> NumberIn(const std::string& name) {
  constexpr size_t kMostDigits = 15;
  const size_t first = name.find_first_of("0123456789");
  if (first == std::string::npos) return {};
  const size_t end = name.find_first_not_of("0123456789", first);
  const std::string digits = name.substr(first, end == std::string::npos ? end : end - first);
  if (digits.size() > kMostDigits) return {};
  return std::stoll(digits);
}

std::string PartOf(int64_t clip) {
  const int64_t part = clip / kClipsPerFolder;
  return part == 0 ? "" : "part" + Padded(part, 3) + "/";
}

}  // namespace

void Layout::Validate() const {
  if (IsTars() && clips_per_tar < 1) throw std::invalid_argument("clips_per_tar must be at least 1");
  if (!IsPairs()) return;
  if (!IsPlainFolderName(name))
    throw std::invalid_argument("name = \"" + name + "\", must be a plain name of a folder");
  if (!(test_fraction >= 0 && test_fraction <= 1))
    throw std::invalid_argument("test_fraction = " + std::to_string(test_fraction) + ", must be in [0, 1]");
  if (frames_per_clip < 1) throw std::invalid_argument("frames_per_clip must be at least 1");
  if (digits < 6 || digits > 18) throw std::invalid_argument("digits must be in [6, 18]");
}

std::set<FrameKind> TruthKinds(std::span<const std::string> truth) {
  std::set<FrameKind> kinds;
  for (const std::string& name : truth)
    kinds.insert(name == "mask"    ? FrameKind::kMask
                 : name == "flow"  ? FrameKind::kFlow
                 : name == "shake" ? FrameKind::kShake
                                   : FrameKind::kTruth);
  return kinds;
}

int64_t FilesOfKind(FrameKind kind, int64_t frames, bool one_clean) {
  if (kind == FrameKind::kShake || (kind == FrameKind::kClean && one_clean)) return 1;
  return kind == FrameKind::kFlow ? frames - 1 : frames;
}

std::string Layout::Path(FrameKind frame_kind, int64_t clip, int64_t frame) const {
  const std::string extension = ExtensionOf(frame_kind, format), folder = FolderOf(frame_kind, kind);
  const bool of_clip = frame_kind == FrameKind::kShake;  // one file
  if (of_clip) frame = 0;
  switch (kind) {
    case LayoutKind::kSequence:
      if (of_clip) return ClipFolders(clip)[0] + "/" + folder + "." + extension;
      return ClipFolders(clip)[0] + "/" + folder + "/" + Padded(frame, 4) + "." + extension;
    case LayoutKind::kBasicsr:
      return PartOf(clip) + folder + "/" + Padded(clip % kClipsPerFolder, 3) + "/" + Padded(frame, 8) + "." +
             extension;
    case LayoutKind::kWebdataset:
      return TarPath(UnitOf(clip)) + "/" + Padded(clip, 6) + "." + folder +
             (of_clip ? "" : "." + Padded(frame, 4)) + "." + extension;
    case LayoutKind::kPairs:
    case LayoutKind::kRestormer:
      break;
  }
  const std::string half = IsTestClip(clip, test_fraction) ? "test" : "train";
  return name + "/" + half + "/" + folder + "/" + Padded(clip * frames_per_clip + frame, digits) + "." +
         extension;
}

std::optional<Layout::Place> Layout::PlaceOf(const std::string& path) const {
  const auto frame_kind = KindOfPath(path);
  if (!frame_kind) return {};
  const std::filesystem::path whole(path);
  const bool of_clip = frame_kind == FrameKind::kShake;
  const auto number = of_clip && kind == LayoutKind::kSequence ? std::optional<int64_t>(0)
                                                               : NumberIn(whole.filename().string());
  if (!number) return {};
  Place place{*frame_kind, 0, of_clip ? 0 : *number};
  std::optional<int64_t> clip;
  switch (kind) {
    case LayoutKind::kSequence:  // clips.001/001234/turb/0007.png
      clip =
          NumberIn((of_clip ? whole.parent_path() : whole.parent_path().parent_path()).filename().string());
      break;
    case LayoutKind::kBasicsr: {  // part001/lq/234/00000007.png
      clip = NumberIn(whole.parent_path().filename().string());
      const std::string part = whole.begin()->string();
      if (const auto thousand = part.starts_with("part") ? NumberIn(part) : std::nullopt; clip && thousand)
        *clip += *thousand * kClipsPerFolder;
      break;
    }
    case LayoutKind::kWebdataset: {  // shards/000012.tar/000123.turb.0000.png
      const std::string name = whole.filename().string();
      clip = NumberIn(name.substr(0, name.find('.')));
      const auto frame = of_clip ? std::optional<int64_t>(0) : NumberIn(whole.stem().extension().string());
      if (!frame) return {};
      place.frame = *frame;
      break;
    }
    case LayoutKind::kPairs:
    case LayoutKind::kRestormer:
      clip = *number / frames_per_clip;
      place.frame = *number % frames_per_clip;
      break;
  }
  if (!clip) return {};
  place.clip = *clip;
  return Path(place.kind, place.clip, place.frame) == path ? std::optional(place) : std::nullopt;
}

std::optional<int64_t> Layout::UnitOfTar(const std::string& path) const {
  const auto unit = IsTars() ? NumberIn(std::filesystem::path(path).filename().string()) : std::nullopt;
  return unit && TarPath(*unit) == path ? unit : std::nullopt;
}

std::vector<std::string> Layout::ClipFolders(int64_t clip) const {
  if (kind == LayoutKind::kSequence) return {ThousandOf(clip) + "/" + Padded(clip, 6)};
  std::vector<std::string> folders;
  if (kind == LayoutKind::kBasicsr)
    for (const FrameKind frame_kind : kFrameKinds)
      folders.push_back(PartOf(clip) + FolderOf(frame_kind, kind) + "/" + Padded(clip % kClipsPerFolder, 3));
  return folders;
}

std::string Layout::TarPath(int64_t unit) const { return "shards/" + Padded(unit, 6) + ".tar"; }

std::optional<FrameKind> KindOfPath(const std::string& path) {
  constexpr std::array<std::pair<const char*, FrameKind>, 9> kKinds = {{{"turb", FrameKind::kTurb},
                                                                        {"lq", FrameKind::kTurb},
                                                                        {"clean", FrameKind::kClean},
                                                                        {"noturb", FrameKind::kClean},
                                                                        {"gt", FrameKind::kClean},
                                                                        {"truth", FrameKind::kTruth},
                                                                        {"mask", FrameKind::kMask},
                                                                        {"flow", FrameKind::kFlow},
                                                                        {kShakeName, FrameKind::kShake}}};
  const auto named = [&](const std::string& name) -> std::optional<FrameKind> {
    for (const auto& [kind_name, kind] : kKinds)
      if (name == kind_name) return kind;
    return {};
  };
  const std::filesystem::path whole(path);
  if (whole.parent_path().extension() == ".tar") {  // 000123.turb.0000.png
    const std::string name = whole.filename().string();
    const size_t dot = name.find('.'), next = name.find('.', dot + 1);
    return dot == std::string::npos || next == std::string::npos
               ? std::nullopt
               : named(name.substr(dot + 1, next - dot - 1));
  }
  if (whole.stem() == kShakeName && whole.extension() == ".json" && whole.has_parent_path())
    return FrameKind::kShake;
  // The innermost folder that has such a name: output.name may be one too.
  for (auto folder = whole.parent_path(); folder.has_relative_path(); folder = folder.parent_path())
    if (const auto kind = named(folder.filename().string())) return kind;
  return {};
}

bool IsPlainFolderName(const std::string& name) {
  const auto bad = [](unsigned char c) { return c == '/' || c == '\\' || c < 0x20 || c == 0x7F; };
  return !name.empty() && name.size() <= 100 && name[0] != '.' && name[0] != '-' &&
         std::ranges::none_of(name, bad) && name != "clips" && name != "dataset.json" &&
         name != "manifest.jsonl" && name != "report.html";
}

bool IsTestClip(int64_t clip, double test_fraction) {
  // A product like 100 * 0.29 comes out just below the whole number that it is; rounding adds at most 2.3e-7
  // for clips up to 1e9, so a millionth is enough. It moves no share: both sides of the comparison have it.
  constexpr double kRounding = 1e-6;
  const auto test_clips_before = [&](int64_t clips) { return std::floor(clips * test_fraction + kRounding); };
  return test_clips_before(clip + 1) > test_clips_before(clip);
}

int PairDigits(int64_t clips, int64_t frames_per_clip) { return clips > 1'000'000 / frames_per_clip ? 9 : 6; }

}  // namespace shimmer::dataset
