#include <algorithm>
#include <map>
#include <stdexcept>

#include "sim/dataset/clip_line.h"
#include "sim/dataset/pixel_hash.h"
#include "sim/dataset/sha256.h"
#include "sim/dataset/tar.h"
#include "sim/dataset/verify.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOtherBytes = "damaged: its SHA-256 is not that of the manifest";

// A library's text begins with the path, which the problem has already.
std::string WithoutPath(const std::string& text, const fs::path& path) {
  const std::string start = path.string() + ": ";
  return text.starts_with(start) ? text.substr(start.size()) : text;
}

std::string SizeText(int64_t bytes, int64_t right) {
  return std::string(bytes < right ? "truncated" : "longer than it was") + ": is " + std::to_string(bytes) +
         " bytes, must be " + std::to_string(right);
}

// One unit on its way.
class UnitCheck {
 public:
  UnitCheck(const Contents& contents, int64_t unit)
      : contents_(contents), folder_(contents.set.folder()), unit_(unit) {}

  UnitFindings Run() {
    const int64_t per_unit = contents_.layout.ClipsPerUnit(), begin = unit_ * per_unit,
                  end = begin + per_unit;
    const std::set<int64_t>&done = contents_.set.clips(), &failed = contents_.set.failed();
    bool whole = true;  // all that is in the tar is known
    std::vector<ClipLine> lines;
    for (int64_t clip = begin; clip < end; ++clip) {
      if (!done.contains(clip)) {
        whole = whole && (clip >= contents_.clips || failed.contains(clip));
        continue;
      }
      clips_ = {clip, clip};
      try {
        lines.push_back(ReadClipLine(contents_, clip));
        if (lines.back().one_clean) findings_.one_clean.push_back(clip);
      } catch (const std::exception& error) {
        whole = false;
        Add(ProblemKind::kManifest, "clip " + std::to_string(clip),
            "its line of the manifest " + std::string(error.what()));
      }
    }
    if (contents_.layout.IsTars())
      Tar(lines, whole);
    else
      for (const ClipLine& line : lines) {
        clips_ = {line.clip, line.clip};
        for (const StoredFile& file : line.files)
          if (LooksRight(file.path)) File(file, line);
      }
    return std::move(findings_);
  }

 private:
  void Add(ProblemKind kind, const std::string& name, std::string text, std::string sha256 = {}) {
    findings_.problems.push_back({kind, name, std::move(text), clips_, std::move(sha256)});
  }

  // The first folder above a path that is a link, which is not followed; empty if there is none.
  std::string LinkAbove(const fs::path& path) {
    if (path.empty()) return "";
    const auto [known, is_new] = link_above_.try_emplace(path.string());
    if (is_new) {
      std::string link = LinkAbove(path.parent_path());
      if (link.empty() && fs::is_symlink(fs::symlink_status(folder_ / path))) link = path.string();
      link_above_[path.string()] = link;
    }
    return link_above_[path.string()];
  }

  // Whether there is a file; or else why not is noted.
  bool LooksRight(const std::string& path) {
    if (const std::string link = LinkAbove(fs::path(path).parent_path()); !link.empty()) {
      Add(ProblemKind::kMissing, path, "missing: " + link + " is a link, must be a folder");
      return false;
    }
    std::error_code error;
    const fs::file_status status = fs::symlink_status(folder_ / path, error);
    switch (status.type()) {
      case fs::file_type::regular:
        return true;
      case fs::file_type::not_found:
        Add(ProblemKind::kMissing, path, "missing");
        return false;
      case fs::file_type::none:
        if (error == std::errc::not_a_directory)  // a file lies where its folder should
          Add(ProblemKind::kMissing, path, "missing");
        else
          Add(ProblemKind::kInTheWay, path, "can't be looked at: " + error.message());
        return false;
      default:
        Add(ProblemKind::kInTheWay, path,
            std::string(status.type() == fs::file_type::symlink     ? "a link"
                        : status.type() == fs::file_type::directory ? "a folder"
                                                                    : "a device or pipe") +
                ", must be a file");
        return false;
    }
  }

  // A file of its own, which is there.
  void File(const StoredFile& file, const ClipLine& line) {
    const fs::path path = folder_ / file.path;
    try {
      const auto bytes = static_cast<int64_t>(fs::file_size(path));
      if (file.bytes < 0 || bytes == file.bytes) return Bytes(ReadFile(path), file, line);
      // Its hash is wanted even so: it may be that of another file.
      Add(bytes < file.bytes ? ProblemKind::kTruncated : ProblemKind::kLonger, file.path,
          SizeText(bytes, file.bytes), Sha256HexOfFile(path));
    } catch (const std::exception& error) {
      Add(ProblemKind::kInTheWay, file.path, WithoutPath(error.what(), path));
    }
  }

  // As many as they should be.
  void Bytes(const std::vector<uint8_t>& bytes, const StoredFile& file, const ClipLine& line) {
    const std::string sha256 = Sha256Hex(bytes), name = file.name();
    if (sha256 != file.sha256) return Add(ProblemKind::kDamaged, name, kOtherBytes, sha256);
    if (file.pixels.empty()) return;
    const fs::path path = folder_ / name;
    cv::Mat samples;
    try {
      samples = StoredSamples(path, bytes);
    } catch (const std::runtime_error& error) {
      return Add(ProblemKind::kDamaged, name, "can't be decoded: " + WithoutPath(error.what(), path));
    }
    if (PixelHashOfSamples(samples) != file.pixels)
      return Add(ProblemKind::kDamaged, name, "damaged: its pixels are not those of the manifest");
    const auto kind = KindOfPath(name);  // what is no frame has channels of its own
    const bool frame = kind == FrameKind::kTurb || kind == FrameKind::kClean;
    const std::vector<int64_t> shape = {samples.cols, samples.rows,
                                        frame ? samples.channels() : line.shape.at(2)};
    if (line.shape != shape)
      Add(ProblemKind::kManifest, name, "its size or channels are not those of its clip's line");
  }

  // lines: of its clips; whole: of all of them.
  void Tar(const std::vector<ClipLine>& lines, bool whole) {
    const int64_t per_unit = contents_.layout.ClipsPerUnit();
    clips_ = {unit_ * per_unit, (unit_ + 1) * per_unit - 1};
    const std::string tar = contents_.layout.TarPath(unit_);
    if (lines.empty() || !LooksRight(tar)) return;
    try {
      if (whole && !TarIsWhole(tar, lines)) return;
      for (const ClipLine& line : lines)
        for (const StoredFile& file : line.files) {
          const std::vector<uint8_t> bytes = contents_.set.Bytes(file);
          if (std::ssize(bytes) == file.bytes)
            Bytes(bytes, file, line);
          else
            Add(ProblemKind::kTruncated, file.name(), SizeText(std::ssize(bytes), file.bytes));
        }
    } catch (const std::exception& error) {
      Add(ProblemKind::kInTheWay, tar, WithoutPath(error.what(), folder_ / tar));
    }
  }

  // Its length, and all of it but its members' bytes. What is wrong is noted.
  bool TarIsWhole(const std::string& tar, const std::vector<ClipLine>& lines) {
    const fs::path path = folder_ / tar;
    std::vector<TarEntry> members;
    int64_t members_bytes = 0;
    for (const ClipLine& line : lines)
      for (const StoredFile& file : line.files) {
        if (file.offset != members_bytes + 512) {
          Add(ProblemKind::kManifest, file.name(),
              "its offset in the manifest is " + std::to_string(file.offset) + ", must be " +
                  std::to_string(members_bytes + 512));
          return false;
        }
        members.push_back({.name = file.member, .offset = file.offset, .bytes = file.bytes});
        members_bytes += TarBytes(file.bytes);
      }
    const auto first = FirstTarMember(path);
    if (first && *first != members.front().name) {
      const std::string clip = first->substr(0, first->find('.'));
      const bool is_clip = clip.size() < 16 && clip.find_first_not_of("0123456789") == std::string::npos;
      const std::string other = is_clip && !clip.empty()
                                    ? contents_.layout.TarPath(contents_.layout.UnitOf(std::stoll(clip)))
                                    : tar;
      if (other != tar) {
        Add(ProblemKind::kSwapped, tar, "swapped: holds what belongs to " + other);
        return false;
      }
    }
    const auto bytes = static_cast<int64_t>(fs::file_size(path)), right = WholeTarBytes(members_bytes);
    if (bytes != right) {
      Add(bytes < right ? ProblemKind::kTruncated : ProblemKind::kLonger, tar, SizeText(bytes, right));
      return false;
    }
    if (const auto place = TarDamage(path, members))
      Add(ProblemKind::kDamaged, tar,
          "damaged: byte " + std::to_string(*place) + ", in a header or between members, is not what it was");
    return true;
  }

  const Contents& contents_;
  const fs::path& folder_;
  int64_t unit_;
  ClipRange clips_{};  // what is looked at
  UnitFindings findings_;
  std::map<std::string, std::string> link_above_;
};

}  // namespace

UnitFindings VerifyUnit(const Contents& contents, int64_t unit) { return UnitCheck(contents, unit).Run(); }

}  // namespace shimmer::dataset
