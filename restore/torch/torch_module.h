// A network that is saved as TorchScript, loaded and run: what flow and sharpening share of torch.
#pragma once

#include <torch/script.h>

#include <exception>
#include <string>
#include <vector>

namespace shimmer::restore {

// Torch says on many lines where in its own code and in the network's something failed: the line that says
// what. Of what fails in a network's code it is the last.
std::string WhatTorchSays(const std::exception& error);

// Sets torch up, and loads a network for the CPU. extra: files of the archive by name, which are filled in.
// Throws what torch throws.
torch::jit::Module LoadModule(const std::string& path, torch::jit::ExtraFilesMap& extra);

// On the calling thread, as the network is written. For any number of threads at a time. Throws what torch
// throws.
c10::IValue Run(const torch::jit::Module& network, std::vector<c10::IValue> inputs);

}  // namespace shimmer::restore
