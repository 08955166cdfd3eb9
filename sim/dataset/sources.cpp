#include "sim/dataset/sources.h"

#include <algorithm>
#include <functional>
#include <stdexcept>

#include "sim/dataset/glob.h"
#include "sim/dataset/image_io.h"
#include "sim/dataset/numbered_name.h"
#include "sim/dataset/pattern_list.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kVideoExtensions = {"3g2", "3gp", "avi", "flv",  "m2ts", "m4v",
                                                   "mj2", "mkv", "mov", "mp4",  "mpeg", "mpg",
                                                   "mts", "ogv", "ts",  "webm", "wmv",  "y4m"};

bool HasExtension(const fs::path& path, const std::vector<std::string>& extensions) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  return !extension.empty() && std::ranges::count(extensions, extension.substr(1)) > 0;
}

// What one pattern means below one base; empty where it means nothing.
using Lookup = std::function<std::vector<fs::path>(const fs::path& base, const std::string& pattern)>;

// The matches below the first of bases that has any. Throws with the places looked in where none has; what is
// what the error says of the pattern.
std::vector<fs::path> FirstMatches(const std::string& pattern, std::span<const fs::path> bases,
                                   const Lookup& lookup, const std::string& what) {
  std::vector<std::string> places;
  for (const fs::path& base : bases) {
    std::vector<fs::path> matches = lookup(base, pattern);
    if (!matches.empty()) return matches;
    if (fs::path(pattern).is_absolute()) break;
    const std::string place = fs::absolute(base.empty() ? "." : base).lexically_normal().string();
    if (std::ranges::find(places, place) == places.end()) places.push_back(place);
  }
  std::string error = "'" + pattern + "': " + what;
  for (const std::string& place : places) error += (place == places[0] ? "; looked in " : " and ") + place;
  throw std::runtime_error(error);
}

std::vector<fs::path> FindPattern(const std::string& pattern, std::span<const fs::path> bases,
                                  const Lookup& lookup) {
  return FirstMatches(pattern, bases, lookup, "nothing found");
}

// What the patterns of a list mean.
std::vector<fs::path> FindListed(const std::string& pattern, std::span<const fs::path> bases,
                                 const Lookup& lookup) {
  const auto as_file = [](const fs::path& base, const std::string& name) {
    const fs::path path = base / name;
    return fs::is_regular_file(path) ? std::vector{path} : std::vector<fs::path>();
  };
  const fs::path list = FirstMatches(pattern, bases, as_file,
                                     "no such list, a name that ends in .txt must be that of a text file "
                                     "with one pattern a line")[0];
  std::vector<fs::path> all_bases = {list.parent_path()};
  all_bases.insert(all_bases.end(), bases.begin(), bases.end());
  std::vector<fs::path> found;
  for (const ListedPattern& listed : ReadPatternList(list)) {
    try {
      const std::vector<fs::path> matches = FindPattern(listed.pattern, all_bases, lookup);
      found.insert(found.end(), matches.begin(), matches.end());
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(list.string() + ":" + std::to_string(listed.line) + ": " + error.what() +
                               "; a # before a line skips it");
    }
  }
  return found;
}

std::vector<fs::path> Find(std::span<const std::string> patterns, std::span<const fs::path> bases,
                           const Lookup& lookup) {
  std::vector<fs::path> found;
  for (const std::string& pattern : patterns) {
    const auto find = NamesList(pattern) ? FindListed : FindPattern;
    for (const fs::path& match : find(pattern, bases, lookup)) found.push_back(match.lexically_normal());
  }
  std::ranges::sort(found, {}, [](const fs::path& path) -> const std::string& { return path.native(); });
  const auto repeats = std::ranges::unique(found);
  found.erase(repeats.begin(), repeats.end());
  return found;
}

}  // namespace

std::vector<fs::path> FindFiles(std::span<const std::string> patterns, std::span<const fs::path> bases,
                                FileKind kind) {
  const auto& extensions = kind == FileKind::kPicture ? PictureExtensions() : kVideoExtensions;
  return Find(patterns, bases, [&](const fs::path& base, const std::string& pattern) {
    const fs::path path = base / pattern;
    std::vector<fs::path> files;
    if (fs::is_directory(path)) {
      files = FilesBelow(path);
      std::erase_if(files, [&](const fs::path& file) { return !HasExtension(file, extensions); });
    } else if (fs::exists(path)) {
      files = {path};
    } else if (HasWildcards(pattern)) {
      files = ExpandGlob(base, pattern);
      std::erase_if(files, [](const fs::path& file) { return fs::is_directory(file); });
    }
    return files;
  });
}

std::vector<fs::path> FindSequences(std::span<const std::string> patterns, std::span<const fs::path> bases) {
  return Find(patterns, bases, [](const fs::path& base, const std::string& pattern) {
    const fs::path path = base / pattern;
    std::vector<fs::path> sequences;
    if (fs::is_directory(path)) {
      sequences = {path};
    } else if (const auto name = NumberedName::Parse(path.filename().string())) {
      if (!NumbersIn(path.parent_path(), *name).empty()) sequences = {path};
    } else if (HasWildcards(pattern)) {
      sequences = ExpandGlob(base, pattern);
      std::erase_if(sequences, [](const fs::path& folder) { return !fs::is_directory(folder); });
    }
    return sequences;
  });
}

std::vector<fs::path> SequenceFiles(const fs::path& sequence) {
  std::vector<fs::path> files;
  if (fs::is_directory(sequence)) {
    for (const fs::path& entry : VisibleEntries(sequence))
      if (!fs::is_directory(entry) && HasExtension(entry, PictureExtensions())) files.push_back(entry);
    std::ranges::stable_sort(files, [](const fs::path& a, const fs::path& b) {
      return LastNumberLess(a.stem().string(), b.stem().string());
    });
    if (files.empty()) throw std::runtime_error(sequence.string() + ": no pictures in this folder");
    return files;
  }
  const auto name = NumberedName::Parse(sequence.filename().string());
  if (!name)
    throw std::runtime_error(sequence.string() +
                             ": not a sequence, must be a folder or a name with one %d or %06d");
  const std::vector<int64_t> numbers = NumbersIn(sequence.parent_path(), *name);
  if (numbers.empty()) throw std::runtime_error(sequence.string() + ": no frame of this name");
  for (const int64_t number : numbers) {
    const int64_t expected = numbers[0] + static_cast<int64_t>(files.size());
    if (number != expected)
      throw std::runtime_error((sequence.parent_path() / name->Of(expected)).string() +
                               ": missing, but frame " + std::to_string(number) + " exists");
    files.push_back(sequence.parent_path() / name->Of(number));
  }
  return files;
}

}  // namespace shimmer::dataset
