#include "restore/torch_flow.h"

#include <dlfcn.h>

#include <stdexcept>
#include <string>

#include "restore/torch/torch_library.h"

namespace shimmer::restore {
namespace {

namespace fs = std::filesystem;

// Beside the program, where the build puts it.
fs::path LibraryPath() { return fs::read_symlink("/proc/self/exe").parent_path() / kTorchLibrary; }

// Stays loaded once it is: flows that it made may live on.
MakeTorchFlows* Library(const fs::path& network) {
  const fs::path path = LibraryPath();
  if (!fs::exists(path))
    throw std::invalid_argument(network.string() +
                                ": this build has no TorchScript, must be dis, or a build with "
                                "-DSHIMMER_TORCH=ON and Debian's libtorch-dev (scripts/setup.sh --torch)");
  void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* made = library ? dlsym(library, kMakeTorchFlows) : nullptr;
  if (!made)
    throw std::runtime_error(path.string() + ": can't be loaded: " + dlerror() + ". Must be of this build");
  return reinterpret_cast<MakeTorchFlows*>(made);
}

}  // namespace

FlowMaker TorchFlows(const fs::path& network) {
  MakeTorchFlows* const make = Library(network);
  if (!fs::is_regular_file(network))
    throw std::runtime_error(network.string() + ": is not there, must be dis or the file of a network");
  FlowMaker flows;
  make(network, flows);
  return flows;
}

}  // namespace shimmer::restore
