#include <csignal>
#include <opencv2/core.hpp>

#include "sim/app/commands.h"

namespace {

std::atomic<bool> stop{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // it is set by a signal

void AskToStop(int) { stop = true; }

// The first Ctrl-C ends the run in good order; the second ends it at once.
void ListenTo(int signal) {
  struct sigaction action = {};
  action.sa_handler = AskToStop;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  sigaction(signal, &action, nullptr);
}

const std::atomic<bool>& ListenToSignals() {
  ListenTo(SIGINT);
  ListenTo(SIGTERM);
  return stop;
}

// OpenCV prints what it also throws.
int PrintNothing(int, const char*, const char*, const char*, int, void*) { return 0; }

}  // namespace

int main(int argc, char** argv) {
  cv::redirectError(PrintNothing);
  return shimmer::app::RunShimmer(argc, argv, ListenToSignals);
}
