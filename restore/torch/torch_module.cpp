#include "restore/torch/torch_module.h"

#include <ATen/Parallel.h>
#include <torch/csrc/jit/runtime/graph_executor.h>
#include <torch/csrc/jit/runtime/print_handler.h>

#include <sstream>
#include <utility>

namespace shimmer::restore {
namespace {

// Warnings are for who made the network.
class NoWarnings {
 private:
  class Silent : public c10::WarningHandler {
    void process(const c10::SourceLocation&, const std::string&, bool) override {}
  };
  Silent silent_;
  c10::Warning::WarningHandlerGuard guard_{&silent_};
};

}  // namespace

std::string WhatTorchSays(const std::exception& error) {
  const auto* torchs = dynamic_cast<const c10::Error*>(&error);
  std::istringstream text(torchs ? torchs->what_without_backtrace() : error.what());
  std::string first, last;
  for (std::string line; std::getline(text, line);) {
    if (line.find_first_not_of(" \t") == std::string::npos) continue;
    if (first.empty()) first = line;
    last = line;
  }
  return "torch says: " + (first.starts_with("The following operation failed") ? last : first);
}

torch::jit::Module LoadModule(const std::string& path, torch::jit::ExtraFilesMap& extra) {
  torch::jit::setPrintHandler([](const std::string&) {});
  // Torch's own threads wait for one another without letting the processor go: beside others, ours too, two
  // are several times as slow as one. And what one computes does not depend on how many there are.
  at::set_num_threads(1);
  const NoWarnings no_warnings;
  torch::jit::Module module = torch::jit::load(path, torch::kCPU, extra);
  module.eval();
  return module;
}

c10::IValue Run(const torch::jit::Module& network, std::vector<c10::IValue> inputs) {
  // All of this is the calling thread's. Were torch to optimise what it has seen run, the second result would
  // be computed otherwise than the first.
  const torch::NoGradGuard no_gradients;
  const torch::jit::GraphOptimizerEnabledGuard as_written(false);
  const NoWarnings no_warnings;
  at::init_num_threads();
  torch::jit::Module module = network;
  return module.forward(std::move(inputs));
}

}  // namespace shimmer::restore
