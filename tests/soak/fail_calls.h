/* System calls that fail, end the process or are written down, where a test chooses: fail_calls.c. */
#pragma once

#ifdef __cplusplus
extern "C" {
#endif

// Takes the variables below as they are now, and counts from zero. A program that is started with the library
// preloaded does so at its start.
//
//   SHIMMER_FAIL_ROOT   only calls on what lies below this folder count (no link in its path)
//   SHIMMER_FAIL_CALL   write pwrite writev fsync fdatasync syncfs rename link open opendir close mkdir
//                       ftruncate flock unlink; several with commas between; "all" is all of them. Calls of
//                       the same kind, like renameat and mkdirat, go by these names
//   SHIMMER_FAIL_AT     number of the call that fails, from 1 among those; 0: none
//   SHIMMER_FAIL_ERRNO  number of the error
//   SHIMMER_FAIL_MODE   once
//                       persistent: that call and all after it
//                       alternate: every second from it on
//                       short: from it on half of what shall be written is
//                       kill: the process is killed before it
//   SHIMMER_FAIL_LOG    file that every change below the root is written to, in order (power_cut.h reads it)
void fail_calls_configure(void);

// Calls that counted since.
long fail_calls_counted(void);

#ifdef __cplusplus
}
#endif
