#include "sim/dataset/merge.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "sim/dataset/dataset_difference.h"
#include "sim/dataset/dataset_folder.h"
#include "sim/dataset/dataset_reader.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;

// Clips that are made durable at once.
constexpr size_t kClipsAtOnce = 500;

// Of the lines of a unit in another set, those that are to be taken over.
std::vector<Json> WorthTaking(std::vector<Json> unit, const DatasetReader& other, const DatasetWriter& writer,
                              const std::set<int64_t>& done, const std::set<int64_t>& failed) {
  const auto clip_of = [](const Json& line) { return line.at("clip").get<int64_t>(); };
  const auto is_in = [&](const std::set<int64_t>& clips) {
    return [&](const Json& line) { return clips.contains(clip_of(line)); };
  };
  const int64_t per_unit = writer.layout().ClipsPerUnit(),
                first = writer.layout().UnitOf(clip_of(unit.front())) * per_unit;
  const auto done_here = std::distance(done.lower_bound(first), done.lower_bound(first + per_unit));
  const auto done_there = std::ranges::count_if(unit, is_in(other.clips()));
  const bool has_all = std::ranges::count_if(unit, [&](const Json& line) {
                         return is_in(other.clips())(line) && is_in(done)(line);
                       }) == done_here;
  if (done_there > done_here && has_all) return unit;
  if (done_here > 0 || done_there > 0) return {};
  std::erase_if(unit, is_in(failed));
  return unit;
}

}  // namespace

void RequireSameDataset(const fs::path& from, const Json& description, const fs::path& described) {
  const std::vector<std::string> differences = Differences(description, ReadDescription(from));
  if (!differences.empty())
    throw std::invalid_argument(from.string() + ": is made from something else than " + described.string() +
                                ": " + InOneLine(differences));
}

void Adopt(DatasetWriter& writer, const fs::path& from) {
  RequireSameDataset(from, ReadDescription(writer.folder()), writer.folder());
  const auto lock = LockToRead(from);
  const DatasetReader other(from);
  const std::set<int64_t> done = writer.done(), failed = writer.failed();
  std::vector<Json> lines, unit;
  const auto end_unit = [&] {
    if (unit.empty()) return;
    std::ranges::move(WorthTaking(std::move(unit), other, writer, done, failed), std::back_inserter(lines));
    unit.clear();
  };
  const auto take_over = [&] {
    writer.Adopt(from, lines);
    lines.clear();
  };
  other.manifest().ForEachLine([&](int64_t clip, const Json& line) {
    const auto unit_of = [&](int64_t any) { return writer.layout().UnitOf(any); };
    if (!unit.empty() && unit_of(unit.front().at("clip").get<int64_t>()) != unit_of(clip)) {
      end_unit();
      if (lines.size() >= kClipsAtOnce) take_over();
    }
    unit.push_back(line);
  });
  end_unit();
  take_over();
}

}  // namespace shimmer::dataset
