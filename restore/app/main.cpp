#include "cli/process.h"
#include "restore/app/commands.h"

int main(int argc, char** argv) {
  shimmer::cli::SilenceOpenCv();
  return shimmer::restore::app::RunUnshimmer(argc, argv, shimmer::cli::ListenToSignals);
}
