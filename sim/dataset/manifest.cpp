#include "sim/dataset/manifest.h"

#include <fcntl.h>

#include <fstream>
#include <stdexcept>

namespace shimmer::dataset {
namespace {

// Text from outside (a file's name) may be no UTF-8, which JSON can't hold: such bytes become U+FFFD.
std::string OneLine(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

Manifest::Manifest(std::filesystem::path path) : path_(std::move(path)) {
  if (!std::filesystem::exists(path_)) return;
  std::ifstream file(path_, std::ios::binary);
  if (!file) throw std::runtime_error(path_.string() + ": can't be read");
  int64_t line_number = 0;
  for (std::string line; std::getline(file, line);) {
    ++line_number;
    const bool has_newline = !file.eof();
    if (!has_newline) return;  // torn
    try {
      Note(line, whole_bytes_);
    } catch (const std::exception& error) {
      if (dynamic_cast<const Json::parse_error*>(&error) && file.peek() == std::ifstream::traits_type::eof())
        return;
      throw std::runtime_error(path_.string() + ":" + std::to_string(line_number) + ": damaged line (" +
                               error.what() + ")");
    }
    whole_bytes_ += line.size() + 1;
  }
}

void Manifest::Note(const std::string& line, uint64_t offset) {
  const Json json = Json::parse(line);
  const Json& number = json.at("clip");
  if (!number.is_number_unsigned())
    throw std::runtime_error("\"clip\" is " + number.dump() + ", must be a number from 0");
  const auto clip = number.get<int64_t>();
  const auto status = json.at("status").get<std::string>();
  if (status != "done" && status != "failed")
    throw std::runtime_error("\"status\" is \"" + status + "\", must be \"done\" or \"failed\"");
  offsets_[clip] = offset;
  done_.erase(clip);
  failed_.erase(clip);
  (status == "done" ? done_ : failed_).insert(clip);
}

Json Manifest::Line(int64_t clip) const {
  const auto offset = offsets_.find(clip);
  if (offset == offsets_.end())
    throw std::runtime_error(path_.string() + ": has no clip " + std::to_string(clip));
  std::ifstream file(path_, std::ios::binary);
  file.seekg(static_cast<std::streamoff>(offset->second));
  std::string line;
  std::getline(file, line);
  Json json = Json::parse(line, nullptr, /*allow_exceptions=*/false);
  if (!file || !json.is_object() || json.value("clip", int64_t{-1}) != clip)
    throw std::runtime_error(path_.string() + ": has changed since it was read");
  return json;
}

ManifestWriter::ManifestWriter(const std::filesystem::path& path, uint64_t whole_bytes)
    : file_(path, O_CREAT | O_WRONLY | O_APPEND), whole_bytes_(whole_bytes) {
  file_.Truncate(whole_bytes);
  file_.Sync();
  SyncFolder(path.parent_path());
}

void ManifestWriter::Append(const Json& line) {
  const std::string text = OneLine(line);
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
