#include "cli/process.h"
#include "sim/app/commands.h"

int main(int argc, char** argv) {
  shimmer::cli::SilenceOpenCv();
  return shimmer::app::RunShimmer(argc, argv, shimmer::cli::ListenToSignals);
}
