// What an evaluation leaves on disk, so that the next run goes on with it:
//
//   REPORT/evaluation.json        what is evaluated: the set and the variants, each by what tells it from
//   others REPORT/clips/CLIP/VARIANT.json, REPORT/real/NAME/VARIANT.json    rows of one variant of one clip,
//   or its error REPORT/pictures/CLIP/, REPORT/pictures/real/NAME/                pictures.h
//   REPORT/results.json, results.csv, report.html                    all of these together
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "restore/app/evaluation/results.h"
#include "restore/app/evaluation/variants.h"
#include "sim/dataset/folder_lock.h"
#include "sim/dataset/shard.h"

namespace shimmer::restore::app {

inline constexpr const char *kClipsFolder = "clips", *kRealFolder = "real";

class ReportFolder {
 public:
  // Creates it, or takes up what is there. set: its identity, null for none; set_name: as it was given; real:
  // the videos' paths by name. Throws std::invalid_argument, with nothing touched, where the folder holds
  // something else, another set's results, or those of other variants or videos of these names; and
  // dataset::FolderBusy while another process writes there (this shard, or all of it).
  ReportFolder(std::filesystem::path folder, const nlohmann::json& set, const std::string& set_name,
               int64_t clips_of_set, const std::vector<Variant>& variants,
               const std::map<std::string, std::string>& real, const dataset::Shard& shard);

  const std::filesystem::path& path() const { return folder_; }

  // Whether its rows are there. What failed before is to be tried again.
  bool IsDone(bool is_real, const std::string& clip, const std::string& variant) const;
  void Put(bool is_real, const ClipFacts& facts, const std::string& variant,
           const std::vector<ResultRow>& rows);
  void PutError(bool is_real, const std::string& clip, const std::string& variant, const std::string& error);

  // All that is there, of this run and others.
  Evaluation Read() const;
  // Ends the writing of clips. Whether this process may write the report: not while other shards are at work.
  bool MayWriteResults();
  // results.json, results.csv and report.html.
  void WriteResults(const Evaluation& evaluation) const;

 private:
  std::filesystem::path FileOf(bool is_real, const std::string& clip, const std::string& variant) const;
  std::vector<ClipResult> ReadClips(bool is_real, const std::vector<VariantText>& variants) const;

  std::filesystem::path folder_;
  dataset::Shard shard_;
  std::optional<dataset::FolderLock> lock_;
  nlohmann::json description_;  // evaluation.json
};

}  // namespace shimmer::restore::app
