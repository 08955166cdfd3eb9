#include "restore/torch/torch_library.h"

#include <dlfcn.h>

#include <stdexcept>
#include <string>

namespace shimmer::restore {

namespace fs = std::filesystem;

void* TorchFunction(const char* name, const fs::path& file, const char* instead) {
  const fs::path path = fs::read_symlink("/proc/self/exe").parent_path() / kTorchLibrary;
  if (!fs::exists(path))
    throw std::invalid_argument(
        file.string() + ": this build has no TorchScript, must be " + instead +
        ", or a build with -DSHIMMER_TORCH=ON and Debian's libtorch-dev (scripts/setup.sh "
        "--torch)");
  void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* function = library ? dlsym(library, name) : nullptr;
  if (!function)
    throw std::runtime_error(path.string() + ": can't be loaded: " + dlerror() + ". Must be of this build");
  return function;
}

}  // namespace shimmer::restore
