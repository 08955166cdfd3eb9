#include "sim/app/report_summary.h"

#include <algorithm>
#include <iterator>

#include "cli/html.h"
#include "cli/number_text.h"
#include "cli/page.h"
#include "sim/app/clean_frames.h"
#include "sim/app/job.h"

namespace shimmer::app {
namespace {

constexpr size_t kHashDigits = 12;
constexpr int64_t kMostSizes = 4;

std::string Joined(std::string text, const std::string& word) {
  return text.empty() ? word : std::move(text) + ", " + word;
}

std::string Row(const std::string& name, const std::string& value) {
  return "<div><dt>" + cli::EscapeHtml(name) + "</dt><dd>" + cli::EscapeHtml(value) + "</dd></div>\n";
}

// Of the clips that the config asks for. (An earlier one may have asked for more.)
int64_t Missing(const dataset::DatasetReader& reader, int64_t asked) {
  int64_t there = 0;
  for (const auto* clips : {&reader.clips(), &reader.failed()})
    there += std::distance(clips->begin(), clips->lower_bound(asked));
  return asked - there;
}

// "256x256 px", "48x64, 64x48 px", "12 sizes"
std::string SizesText(const Json& size, const ReportFacts& facts) {
  if (!size.is_object()) return ValueText(size) + " px";
  const auto drawn = facts.drawn.find("size");
  if (drawn == facts.drawn.end()) return "drawn";
  const auto& sizes = drawn->second.others;
  if (std::ssize(sizes) > kMostSizes) return cli::Counted(std::ssize(sizes), "size");
  std::string text;
  for (const auto& [one, clips] : sizes) text = Joined(text, one);
  return text + " px";
}

std::string SourcesText(const Json& sources) {
  if (sources.empty()) return "drawn scenes";
  const auto unread = std::ranges::count_if(sources, [](const Json& source) {
    return source.is_object() && source.value("sha256", Json()).is_null();
  });
  const SourceCounts counts = CountSources(sources);
  std::string text = counts.backgrounds == 0 ? "drawn scenes" : cli::Counted(counts.backgrounds, "file");
  if (counts.masks_and_objects > 0)
    text += " and " + cli::Counted(counts.masks_and_objects, "file") + " of masks and objects";
  return unread == 0 ? text : text + ", " + cli::Grouped(unread) + " can't be read";
}

std::string TruthText(const std::vector<std::string>& truth) {
  std::string text;
  for (const std::string& kind : truth) text = Joined(text, kind);
  return text.empty() ? "not written" : text;
}

std::string TextOf(const Json& description, const char* name) {
  const auto found = description.find(name);
  if (found == description.end()) return "unknown";
  return found->is_string() ? found->get<std::string>() : found->dump();
}

}  // namespace

std::string SummaryHtml(const dataset::DatasetReader& reader, const ConfigFile& file,
                        const ReportFacts& facts) {
  const Config& config = file.fixed();
  const Json& output = file.resolved().at("output");
  const int64_t frames = KeptFrameCount(config), done = std::ssize(reader.clips());
  const int64_t failed = std::ssize(reader.failed());
  std::string html = "<header>\n<p class=\"kind\">Shimmer data set</p>\n<h1>" +
                     cli::EscapeHtml(config.output.name) + "</h1>\n<p class=\"quiet\">" +
                     cli::EscapeHtml("layout " + output.at("layout").get<std::string>() + ", " +
                                     cli::Counted(frames, "frame") + " a clip, " +
                                     std::to_string(EncodingOf(config.output).bits) + "-bit " +
                                     output.at("format").get<std::string>()) +
                     "</p>\n</header>\n<div class=\"tiles\">\n" +
                     cli::Tile("of " + cli::Counted(config.clips, "clip") + " done", cli::Grouped(done)) +
                     cli::Tile("failed", cli::Grouped(failed), failed > 0) +
                     cli::Tile("missing", cli::Grouped(Missing(reader, config.clips))) +
                     cli::Tile("frames", cli::Grouped(done * frames));
  if (facts.file_bytes > 0) html += cli::Tile("on disk", cli::BytesText(facts.file_bytes));
  const Json& description = reader.description();
  return html + "</div>\n<dl class=\"summary\">\n" +
         Row("Frame size", SizesText(file.resolved().at("size"), facts)) +
         Row("Truth", TruthText(config.output.truth)) +
         Row("Sources", SourcesText(description.value("sources", Json::array()))) +
         Row("Seed", std::to_string(config.seed)) +
         Row("Config hash", TextOf(description, "config_hash").substr(0, kHashDigits)) +
         Row("Engine", TextOf(description, "engine")) + Row("Made by", TextOf(description, "version")) +
         "</dl>\n";
}

}  // namespace shimmer::app
