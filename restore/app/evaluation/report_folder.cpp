#include "restore/app/evaluation/report_folder.h"

#include <algorithm>
#include <stdexcept>

#include "restore/app/evaluation/report_page.h"
#include "restore/app/evaluation/result_text.h"
#include "sim/dataset/files.h"
#include "sim/dataset/glob.h"

namespace shimmer::restore::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kDescription = "evaluation.json";
constexpr int kFormat = 1;

json ReadJson(const fs::path& path) {
  try {
    return json::parse(dataset::ReadFile(path));
  } catch (const json::exception& error) {
    throw std::runtime_error(path.string() + ": damaged (" + error.what() + ")");
  }
}

void WriteText(const fs::path& path, const std::string& text) {
  dataset::WriteFileAtomically(path, dataset::AsBytes(text));
}

json Described(const Variant& variant) {
  const VariantText text = variant.Text();
  return {{"name", text.name},
          {"kind", NameOf(text.kind)},
          {"settings", text.settings},
          {"identity", variant.Identity()}};
}

VariantKind KindOf(const std::string& name) {
  for (const auto kind : {VariantKind::kInput, VariantKind::kPipeline, VariantKind::kAblation,
                          VariantKind::kBaseline, VariantKind::kMethod})
    if (name == NameOf(kind)) return kind;
  throw std::runtime_error(std::string(kDescription) + ": there is no kind of variant '" + name + "'");
}

// The place of a kind in a report, whatever call brought it.
int Rank(const json& described) { return static_cast<int>(KindOf(described.at("kind"))); }

void RequireSame(const fs::path& folder, const std::string& what, const json& there, const json& wanted) {
  if (there == wanted) return;
  throw std::invalid_argument(folder.string() + ": holds an evaluation of another " + what + " (" +
                              there.dump() + ", now " + wanted.dump() +
                              "), must be a new folder or the same");
}

}  // namespace

ReportFolder::ReportFolder(fs::path folder, const json& set, const std::string& set_name,
                           int64_t clips_of_set, const std::vector<Variant>& variants,
                           const std::map<std::string, std::string>& real, const dataset::Shard& shard)
    : folder_(std::move(folder)), shard_(shard) {
  if (fs::exists(folder_ / kDescription)) {
    description_ = ReadJson(folder_ / kDescription);
    RequireSame(folder_, "format", description_.at("format"), kFormat);
    if (!set.is_null() && !description_.at("set").is_null())
      RequireSame(folder_, "data set", description_.at("set"), set);
  } else {
    if (fs::exists(folder_) && !(fs::is_directory(folder_) && dataset::VisibleEntries(folder_).empty()))
      throw std::invalid_argument("--out " + folder_.string() +
                                  ": is there already and no evaluation, must be new or an empty folder");
    description_ = {{"format", kFormat},         {"set", nullptr},        {"set_name", ""}, {"clips", 0},
                    {"variants", json::array()}, {"real", json::object()}};
  }
  if (!set.is_null()) {
    description_["set"] = set;
    description_["set_name"] = set_name;
    description_["clips"] = clips_of_set;
  }
  for (const Variant& variant : variants) {
    json& known = description_.at("variants");
    const auto same =
        std::ranges::find_if(known, [&](const json& each) { return each.at("name") == variant.name; });
    if (same == known.end())
      known.push_back(Described(variant));
    else
      RequireSame(folder_, "variant '" + variant.name + "'", same->at("identity"), variant.Identity());
  }
  auto sorted = description_.at("variants").get<std::vector<json>>();
  std::ranges::stable_sort(sorted, {}, Rank);
  description_["variants"] = sorted;
  for (const auto& [name, path] : real) {
    json& known = description_.at("real");
    if (known.contains(name)) RequireSame(folder_, "video '" + name + "'", known.at(name), path);
    known[name] = path;
  }
  dataset::MakeFolders(folder_);
  lock_.emplace(folder_, shard_);
  // (shards that begin at once write the same, each beside under a name of its own)
  const std::string text = description_.dump(2) + "\n";
  dataset::WriteFileAtomically(folder_ / kDescription, dataset::AsBytes(text),
                               folder_ / (kDescription + shard_.Suffix() + ".new"));
}

bool ReportFolder::MayWriteResults() {
  if (shard_.whole()) return true;
  lock_.reset();
  try {
    lock_.emplace(folder_, dataset::Shard());
  } catch (const dataset::FolderBusy&) {
    return false;
  }
  return true;
}

fs::path ReportFolder::FileOf(bool is_real, const std::string& clip, const std::string& variant) const {
  return folder_ / (is_real ? kRealFolder : kClipsFolder) / clip / (variant + ".json");
}

bool ReportFolder::IsDone(bool is_real, const std::string& clip, const std::string& variant) const {
  const fs::path file = FileOf(is_real, clip, variant);
  return fs::exists(file) && ReadJson(file).contains("rows");
}

void ReportFolder::Put(bool is_real, const ClipFacts& facts, const std::string& variant,
                       const std::vector<ResultRow>& rows) {
  const fs::path file = FileOf(is_real, facts.name, variant);
  dataset::MakeFolders(file.parent_path());
  WriteText(file, OrderedJson({{"facts", FactsJson(facts)}, {"rows", RowsJson(rows)}}).dump(2) + "\n");
}

void ReportFolder::PutError(bool is_real, const std::string& clip, const std::string& variant,
                            const std::string& error) {
  const fs::path file = FileOf(is_real, clip, variant);
  dataset::MakeFolders(file.parent_path());
  WriteText(file, json({{"error", error}}).dump(2, ' ', false, json::error_handler_t::replace) + "\n");
}

std::vector<ClipResult> ReportFolder::ReadClips(bool is_real,
                                                const std::vector<VariantText>& variants) const {
  std::vector<ClipResult> clips;
  const fs::path all = folder_ / (is_real ? kRealFolder : kClipsFolder);
  if (!fs::exists(all)) return clips;
  for (const fs::path& folder : dataset::VisibleEntries(all)) {
    ClipResult clip;
    clip.facts.name = folder.filename().string();
    for (const VariantText& variant : variants) {
      const fs::path file = FileOf(is_real, clip.facts.name, variant.name);
      if (!fs::exists(file)) continue;
      const json result = ReadJson(file);
      if (result.contains("error")) {
        clip.errors.push_back({variant.name, result.at("error")});
        continue;
      }
      clip.facts = FactsOf(result.at("facts"));
      for (ResultRow& row : RowsOf(result.at("rows"))) clip.rows.push_back(std::move(row));
    }
    clips.push_back(std::move(clip));
  }
  return clips;
}

Evaluation ReportFolder::Read() const {
  Evaluation evaluation{.set = description_.at("set_name"),
                        .variants = {},
                        .clips = {},
                        .real = {},
                        .clips_of_set = description_.at("clips")};
  for (const json& variant : description_.at("variants"))
    evaluation.variants.push_back({variant.at("name"), KindOf(variant.at("kind")), variant.at("settings")});
  evaluation.clips = ReadClips(false, evaluation.variants);
  evaluation.real = ReadClips(true, evaluation.variants);
  return evaluation;
}

void ReportFolder::WriteResults(const Evaluation& evaluation) const {
  WriteText(folder_ / "results.json", ResultsJson(evaluation).dump(1) + "\n");
  WriteText(folder_ / "results.csv", ResultsCsv(evaluation));
  WriteText(folder_ / "report.html", EvaluationHtml(evaluation, folder_));
}

}  // namespace shimmer::restore::app
