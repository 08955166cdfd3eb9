#include "cli/process.h"

#include <csignal>
#include <opencv2/core.hpp>

namespace shimmer::cli {
namespace {

std::atomic<bool> stop{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // it is set by a signal

void AskToStop(int) { stop = true; }

void ListenTo(int signal) {
  struct sigaction action = {};
  action.sa_handler = AskToStop;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  sigaction(signal, &action, nullptr);
}

int PrintNothing(int, const char*, const char*, const char*, int, void*) { return 0; }

}  // namespace

const std::atomic<bool>& ListenToSignals() {
  ListenTo(SIGINT);
  ListenTo(SIGTERM);
  return stop;
}

void SilenceOpenCv() { cv::redirectError(PrintNothing); }

}  // namespace shimmer::cli
