// A small data set of real pictures in any layout, what verifying it finds, and ways to do it harm.
#pragma once

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "sim/dataset/derived_files.h"
#include "sim/dataset/numbered_name.h"
#include "sim/dataset/pixel_hash.h"
#include "sim/dataset/verify.h"
#include "tests/dataset/small_set.h"

namespace shimmer::dataset {

inline constexpr int64_t kPictureClips = 5, kPictureFrames = 2;

// Five clips of two frames. Clips 0 and 2 have clean frames that are all the same, clip 3 has failed if
// wanted.
class PictureSet {
 public:
  PictureSet(LayoutKind kind, Encoding encoding, bool with_failed = false)
      : layout_{.kind = kind,
                .format = encoding.format,
                .name = "set",
                .test_fraction = 0.4,
                .frames_per_clip = kPictureFrames,
                .clips_per_tar = 2} {
    Json description = Description();
    description["config"]["clips"] = kPictureClips;
    DatasetWriter writer(folder(), layout_, description);
    for (int64_t clip = 0; clip < kPictureClips; ++clip) {
      if (with_failed && clip == 3)
        writer.Fail(clip, {{"error", "bad source"}});
      else
        WriteClip(writer, clip, encoding);
    }
    writer.Flush();
    WriteDerivedFiles(DatasetReader(folder()), layout_);
  }

  const std::filesystem::path& folder() const { return temp_.path(); }
  const Layout& layout() const { return layout_; }
  std::filesystem::path operator/(const std::string& name) const { return folder() / name; }

  // Every file of every clip that is done, as the manifest names it.
  std::vector<StoredFile> Files() const {
    std::vector<StoredFile> files;
    DatasetReader(folder()).manifest().ForEachLine([&](int64_t, const Json& line) {
      for (const StoredFile& file : FilesOfLine(line)) files.push_back(file);
    });
    return files;
  }

  // "NAME: TEXT" of each problem, sorted.
  std::vector<std::string> Problems() const {
    std::vector<std::string> lines;
    for (const Problem& problem : Found()) lines.push_back(problem.name + ": " + problem.text);
    std::ranges::sort(lines);
    return lines;
  }

  std::vector<Problem> Found() const {
    std::vector<Problem> problems;
    const DatasetReader set(folder(), [&](const std::string& what) {
      problems.push_back({ProblemKind::kManifest, "line", what});
    });
    const Contents contents{
        .set = set,
        .layout = layout_,
        .clips = kPictureClips,
        .frames = kPictureFrames,
        .truth = {FrameKind::kTruth, FrameKind::kMask, FrameKind::kFlow, FrameKind::kShake}};
    std::set<int64_t> units, one_clean;
    for (const int64_t clip : set.clips()) units.insert(layout_.UnitOf(clip));
    const auto add = [&](const std::vector<Problem>& more) {
      problems.insert(problems.end(), more.begin(), more.end());
    };
    for (const int64_t unit : units) {
      const UnitFindings findings = VerifyUnit(contents, unit);
      add(findings.problems);
      one_clean.insert(findings.one_clean.begin(), findings.one_clean.end());
    }
    NameSwapped(set, problems);
    add(VerifyManifest(contents, problems));
    add(FindSurplus(contents, one_clean));
    return problems;
  }

  // Lines of the manifest, each changed by the call.
  template <class Change>
  void ChangeLines(const Change& change) const {
    std::ifstream file(folder() / "manifest.jsonl");
    std::string text;
    for (std::string line; std::getline(file, line);) {
      Json json = Json::parse(line);
      change(json);
      if (!json.is_null()) text += json.dump() + "\n";
    }
    WriteFile(folder() / "manifest.jsonl", AsBytes(text));
  }

 private:
  void WriteClip(DatasetWriter& writer, int64_t clip, Encoding encoding) const {
    static const std::vector<std::string> kTruth = {"dx", "dy", "sigma"}, kFlow = {"u", "v"};
    const bool still = clip % 2 == 0;
    const int channels = clip == 1 ? 1 : 3;
    StagedClip staged = writer.Stage(clip);
    for (int64_t t = 0; t < kPictureFrames; ++t) {
      const auto seed = static_cast<uint32_t>(clip * 100 + t);
      const cv::Mat turb = RandomImage({7, 5}, channels, seed),
                    clean = RandomImage({7, 5}, channels,
                                        still ? static_cast<uint32_t>(clip) + 7000 : seed + 5000),
                    truth = RandomImage({7, 5}, 3, seed, -8, 8);
      staged.Add(
          {layout_.Path(FrameKind::kTurb, clip, t), EncodeImage(turb, encoding), PixelHash(turb, encoding)});
      if (t == 0 || !still || !layout_.OneCleanFile())
        staged.Add({layout_.Path(FrameKind::kClean, clip, t), EncodeImage(clean, encoding),
                    PixelHash(clean, encoding)});
      staged.Add({layout_.Path(FrameKind::kTruth, clip, t), EncodeExr(truth, 32, kTruth),
                  PixelHash(truth, {FileFormat::kExr, 32})});
      const cv::Mat mask = RandomImage({7, 5}, 1, seed + 9000), flow = RandomImage({7, 5}, 2, seed, -8, 8);
      staged.Add({layout_.Path(FrameKind::kMask, clip, t), EncodePng(mask, 8), PixelHash(mask, {})});
      if (t + 1 < kPictureFrames)
        staged.Add({layout_.Path(FrameKind::kFlow, clip, t), EncodeExr(flow, 32, kFlow),
                    PixelHash(flow, {FileFormat::kExr, 32})});
    }
    const std::string shake = R"({"shifts_px": [[0, 0], [1, 2]]})" + std::to_string(clip);
    staged.Add({layout_.Path(FrameKind::kShake, clip, 0), {shake.begin(), shake.end()}, ""});
    writer.Commit(std::move(staged), {{"size", {7, 5}}, {"channels", channels}, {"frames", kPictureFrames}});
  }

  TempFolder temp_;
  Layout layout_;
};

inline void FlipBit(const std::filesystem::path& path, size_t byte, int bit) {
  std::vector<uint8_t> bytes = ReadFile(path);
  bytes.at(byte) ^= static_cast<uint8_t>(1 << bit);
  WriteFile(path, bytes);
}

inline void Swap(const std::filesystem::path& a, const std::filesystem::path& b) {
  const std::filesystem::path beside = a.string() + ".swap";
  Rename(a, beside);
  Rename(b, a);
  Rename(beside, b);
}

}  // namespace shimmer::dataset
