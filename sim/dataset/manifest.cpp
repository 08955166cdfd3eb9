#include "sim/dataset/manifest.h"

#include <fcntl.h>

#include <algorithm>
#include <fstream>
#include <stdexcept>

#include "sim/dataset/dataset_folder.h"
#include "sim/dataset/glob.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;

// Text from outside (a file's name) may be no UTF-8, which JSON can't hold: such bytes become U+FFFD.
std::string OneLine(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

// The object's value of this name, if it has one of this type.
template <class Value>
Value ValueOr(const Json& object, const char* name, Value otherwise) {
  const auto found = object.find(name);
  if (found == object.end()) return otherwise;
  return found->get<Value>();
}

}  // namespace

Json ToJson(const StoredFile& file) {
  Json json = {{"path", file.path}, {"bytes", file.bytes}, {"sha256", file.sha256}};
  if (!file.pixels.empty()) json["pixels"] = file.pixels;
  if (!file.member.empty()) json.update({{"member", file.member}, {"offset", file.offset}});
  return json;
}

std::vector<StoredFile> FilesOfLine(const Json& line) {
  std::vector<StoredFile> files;
  try {
    for (const Json& json : line.value("files", Json::array()))
      files.push_back({.path = json.at("path").get<std::string>(),
                       .member = ValueOr<std::string>(json, "member", ""),
                       .offset = ValueOr<int64_t>(json, "offset", 0),
                       .bytes = ValueOr<int64_t>(json, "bytes", -1),
                       .sha256 = ValueOr<std::string>(json, "sha256", ""),
                       .pixels = ValueOr<std::string>(json, "pixels", "")});
  } catch (const Json::exception&) {
    throw std::runtime_error("clip " + line.value("clip", Json()).dump() +
                             ": damaged line, each of its files must have a path");
  }
  for (const StoredFile& file : files)
    if (!file.member.empty() && (file.offset < 0 || file.bytes < 0))
      throw std::runtime_error("clip " + line.value("clip", Json()).dump() +
                               ": damaged line, a file in a tar must have offset and bytes");
  return files;
}

std::vector<fs::path> ManifestsIn(const fs::path& folder) {
  std::vector<fs::path> paths = {folder / kManifestName};
  if (!fs::is_directory(folder)) return paths;
  std::vector<fs::path> shards = ExpandGlob(folder, "manifest.*-of-*.jsonl");
  std::ranges::sort(shards);
  paths.insert(paths.end(), shards.begin(), shards.end());
  return paths;
}

Manifest::Manifest(std::vector<fs::path> paths, const Damaged& damaged)
    : paths_(std::move(paths)), whole_bytes_(paths_.size(), 0) {
  for (uint32_t file = 0; file < paths_.size(); ++file) Read(file, damaged);
}

void Manifest::Read(uint32_t file_index, const Damaged& damaged) {
  const fs::path& path = paths_[file_index];
  uint64_t& whole_bytes = whole_bytes_[file_index];
  if (!fs::exists(path)) return;
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path.string() + ": can't be read");
  int64_t line_number = 0;
  for (std::string line; std::getline(file, line);) {
    ++line_number;
    const bool has_newline = !file.eof();
    if (!has_newline || line.find('\0') != std::string::npos) return;  // torn
    try {
      Note(line, {file_index, whole_bytes});
    } catch (const std::exception& error) {
      if (dynamic_cast<const Json::parse_error*>(&error) && file.peek() == std::ifstream::traits_type::eof())
        return;
      const std::string what =
          path.string() + ":" + std::to_string(line_number) + ": damaged line (" + error.what() + ")";
      if (!damaged) throw std::runtime_error(what);
      damaged(what);
    }
    whole_bytes += line.size() + 1;
  }
  // Lines that can't be read are not lines that are not there.
  if (file.bad()) throw std::runtime_error(path.string() + ": can't be read to its end");
}

void Manifest::Note(const std::string& line, Place place) {
  const Json json = Json::parse(line);
  const Json& number = json.at("clip");
  if (!number.is_number_unsigned())
    throw std::runtime_error("\"clip\" is " + number.dump() + ", must be a number from 0");
  const auto clip = number.get<int64_t>();
  const auto status = json.at("status").get<std::string>();
  if (status != "done" && status != "failed")
    throw std::runtime_error("\"status\" is \"" + status + "\", must be \"done\" or \"failed\"");
  // What failed for one process may be done by another.
  const auto known = places_.find(clip);
  if (known != places_.end() && known->second.file != place.file && status == "failed" &&
      done_.contains(clip))
    return;
  places_[clip] = place;
  done_.erase(clip);
  failed_.erase(clip);
  (status == "done" ? done_ : failed_).insert(clip);
}

uint64_t Manifest::whole_bytes(const fs::path& path) const {
  const auto found = std::ranges::find(paths_, path);
  return found == paths_.end() ? 0 : whole_bytes_[static_cast<size_t>(found - paths_.begin())];
}

Json Manifest::Line(int64_t clip) const {
  const auto place = places_.find(clip);
  if (place == places_.end())
    throw std::runtime_error(paths_.front().string() + ": has no clip " + std::to_string(clip));
  std::ifstream file(paths_[place->second.file], std::ios::binary);
  return LineAt(file, clip, place->second);
}

Json Manifest::LineAt(std::ifstream& file, int64_t clip, Place place) const {
  file.seekg(static_cast<std::streamoff>(place.offset));
  std::string line;
  std::getline(file, line);
  if (!file.is_open()) throw std::runtime_error(paths_[place.file].string() + ": can't be read");
  Json json = Json::parse(line, nullptr, /*allow_exceptions=*/false);
  if (!file || !json.is_object() || json.value("clip", int64_t{-1}) != clip)
    throw std::runtime_error(paths_[place.file].string() + ": has changed since it was read");
  return json;
}

void Manifest::ForEachLine(const std::function<void(int64_t, const Json&)>& visit) const {
  constexpr size_t kMostOpen = 64;  // of perhaps thousands of shards'
  std::map<uint32_t, std::ifstream> files;
  for (const auto& [clip, place] : places_) {
    if (!files.contains(place.file)) {
      if (files.size() == kMostOpen) files.clear();
      files[place.file].open(paths_[place.file], std::ios::binary);
    }
    visit(clip, LineAt(files.at(place.file), clip, place));
  }
}

ManifestWriter::ManifestWriter(const fs::path& path, uint64_t whole_bytes)
    : file_(path, O_CREAT | O_WRONLY | O_APPEND), whole_bytes_(whole_bytes) {
  // Nothing is changed, not even its date, where there is nothing to cut.
  if (std::filesystem::file_size(path) != whole_bytes) file_.Truncate(whole_bytes);
  file_.Sync();
  SyncFolder(path.parent_path());
}

void ManifestWriter::Append(std::span<const Json> lines) {
  std::string text;
  for (const Json& line : lines) text += OneLine(line);
  try {
    file_.WriteAll(AsBytes(text));
    file_.Sync();
  } catch (...) {
    file_.Truncate(whole_bytes_);  // a torn line must stay the last one: nothing is appended after it
    throw;
  }
  whole_bytes_ += text.size();
}

}  // namespace shimmer::dataset
