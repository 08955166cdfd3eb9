// How a program ends: done; failed on the way, or finished with something failed; wrong arguments or input,
// nothing touched; asked to stop.
#pragma once

namespace shimmer::cli {

inline constexpr int kExitDone = 0, kExitFailed = 1, kExitWrongInput = 2, kExitInterrupted = 130;

}  // namespace shimmer::cli
