// The whole step, memory to memory, 8 bit RGB, at the default budget: time, scaling over threads and sizes,
// memory, what skipping saves, and how others do beside it in the same run.
#include <CLI/CLI.hpp>
#include <fstream>

#include "tests/bench/step_sections.h"

namespace shimmer::bench {
namespace {

struct Section {
  const char* name;
  Json (*run)(const StepOptions& options);
};
constexpr std::array kSections{Section{"step", StepSection}, Section{"examples", ExamplesSection},
                               Section{"peers", PeersSection}, Section{"sizes", SizesSection},
                               Section{"skips", SkipsSection}};

std::vector<std::string> SectionNames() {
  std::vector<std::string> names;
  for (const Section& section : kSections) names.push_back(section.name);
  return names;
}

void RunSections(const StepOptions& options, const std::string& only, const std::string& json_file) {
  std::ofstream file;
  if (!json_file.empty()) file.open(json_file);  // now, not after minutes of measuring
  if (!file) throw std::runtime_error(json_file + " can't be written");
  Json json;
  for (const Section& section : kSections)
    if (only.empty() || only == section.name) json[section.name] = section.run(options);
  if (!json_file.empty() && !(file << json.dump(2) << std::endl))
    throw std::runtime_error(json_file + " can't be written");
}

}  // namespace
}  // namespace shimmer::bench

int main(int argc, char** argv) {
  using namespace shimmer::bench;
  CLI::App app("The whole step: time, memory, scaling, and what skipping saves");
  StepOptions options;
  std::string only, json_file;
  app.add_flag("--quick", options.quick, "tiny frames, one run each: does it work at all?");
  app.add_option("--picture", options.picture, "degrade this photograph, not a drawn scene")
      ->type_name("FILE");
  app.add_option("--json", json_file, "write all figures to this file")->type_name("FILE");
  app.add_option("--only", only, "one section")->check(CLI::IsMember(SectionNames()));
  CLI11_PARSE(app, argc, argv);
  try {
    cv::setNumThreads(1);  // of OpenCV's own: ours are oneTBB's, and others are measured on one core
    RunSections(options, only, json_file);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_step: %s\n", error.what());
    return 1;
  }
}
