/* Stands between a program and the system calls that change files: fail_calls.h says what it does. It is
   linked to test_soak, for processes that a test forks, and can be preloaded to the program itself. */
#define _GNU_SOURCE
#include "fail_calls.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

static char root[PATH_MAX], calls[200], mode[20];
static long fail_at;
static int error_number, log_file = -1;
static atomic_long counted;
static pthread_mutex_t log_mutex = PTHREAD_MUTEX_INITIALIZER;

static const char* Variable(const char* name) {
  const char* value = getenv(name);
  return value ? value : "";
}

void fail_calls_configure(void) {
  snprintf(calls, sizeof calls, ",%s,", Variable("SHIMMER_FAIL_CALL"));
  snprintf(mode, sizeof mode, "%s", Variable("SHIMMER_FAIL_MODE"));
  fail_at = atol(Variable("SHIMMER_FAIL_AT"));
  error_number = atoi(Variable("SHIMMER_FAIL_ERRNO"));
  atomic_store(&counted, 0);
  if (log_file >= 0) syscall(SYS_close, log_file);
  log_file = -1;
  const char* log = Variable("SHIMMER_FAIL_LOG");
  if (*log)
    log_file = syscall(SYS_openat, AT_FDCWD, log, O_CREAT | O_TRUNC | O_WRONLY | O_APPEND | O_CLOEXEC, 0666);
  snprintf(root, sizeof root, "%s", Variable("SHIMMER_FAIL_ROOT"));
}

__attribute__((constructor)) static void AtStart(void) { fail_calls_configure(); }

long fail_calls_counted(void) { return atomic_load(&counted); }

/* ---- Which file a call is about ---- */

static int PathOfDescriptor(int descriptor, char* path) {
  char link[64];
  path[0] = 0;
  if (!*root) return 0;
  snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const ssize_t length = readlink(link, path, PATH_MAX - 1);
  path[length < 0 ? 0 : length] = 0;
  return length > 0;
}

/* Of a name in a folder that is open, or in the working directory. Without "." and doubled slashes. */
static void PathOfName(int folder, const char* name, char* path) {
  path[0] = 0;
  if (!*root) return;
  char whole[2 * PATH_MAX] = "";
  if (*name != '/') {
    if (folder == AT_FDCWD) {
      if (!getcwd(whole, PATH_MAX)) whole[0] = 0;
    } else {
      PathOfDescriptor(folder, whole);
    }
    strcat(whole, "/");
  }
  strncat(whole, name, PATH_MAX - 1);
  size_t end = 0;
  for (const char* part = whole; *part;) {
    part += strspn(part, "/");
    const size_t length = strcspn(part, "/");
    if (length > 0 && !(length == 1 && *part == '.') && end + length + 2 < PATH_MAX) {
      path[end++] = '/';
      memcpy(path + end, part, length);
      end += length;
    }
    part += length;
  }
  path[end] = 0;
}

static int IsBelowRoot(const char* path) {
  const size_t length = strlen(root);
  return length > 0 && strncmp(path, root, length) == 0 && (path[length] == '/' || path[length] == 0);
}

/* ---- Whether it fails ---- */

enum Verdict { kPass, kFail, kHalf };

static int IsCounted(const char* call) {
  char named[40];
  snprintf(named, sizeof named, ",%s,", call);
  return strstr(calls, ",all,") || strstr(calls, named);
}

static enum Verdict Judge(const char* call, const char* path) {
  if (!IsBelowRoot(path) || !IsCounted(call)) return kPass;
  const long number = atomic_fetch_add(&counted, 1) + 1;
  if (fail_at <= 0 || number < fail_at) return kPass;
  if (strcmp(mode, "short") == 0) return kHalf;
  if (strcmp(mode, "once") == 0 && number > fail_at) return kPass;
  if (strcmp(mode, "alternate") == 0 && (number - fail_at) % 2 == 1) return kPass;
  if (strcmp(mode, "kill") == 0) syscall(SYS_kill, getpid(), SIGKILL);
  errno = error_number;
  return kFail;
}

/* ---- What is written down ---- */

/* Held from before a call until its line is written, so that the lines are in the order of the calls. */
static int StartLog(const char* path) {
  if (log_file < 0 || !IsBelowRoot(path)) return 0;
  pthread_mutex_lock(&log_mutex);
  return 1;
}

static void EndLog(int logging) {
  if (logging) pthread_mutex_unlock(&log_mutex);
}

static void Log(int logging, const char* what, const char* path, const char* more, const void* data,
                size_t bytes) {
  if (!logging) return;
  const int saved = errno;
  char line[2 * PATH_MAX + 100];
  const int length = snprintf(line, sizeof line, "%s\t%s\t%s\n", what, path, more);
  struct iovec parts[2] = {{line, (size_t)length}, {(void*)data, bytes}};
  syscall(SYS_writev, log_file, parts, data ? 2 : 1);
  errno = saved;
}

/* ---- The calls ---- */

static ssize_t Write(const char* call, int descriptor, const void* data, size_t bytes, off_t place) {
  char path[PATH_MAX], more[60];
  PathOfDescriptor(descriptor, path);
  const enum Verdict verdict = Judge(call, path);
  if (verdict == kFail) return -1;
  if (verdict == kHalf && bytes > 1) bytes /= 2;
  const int logging = StartLog(path);
  const ssize_t written = place >= 0 ? syscall(SYS_pwrite64, descriptor, data, bytes, place)
                                     : syscall(SYS_write, descriptor, data, bytes);
  if (written > 0) {
    const off_t start = place >= 0 ? place : lseek(descriptor, 0, SEEK_CUR) - written;
    snprintf(more, sizeof more, "%lld %lld", (long long)start, (long long)written);
    Log(logging, "write", path, more, data, (size_t)written);
  }
  EndLog(logging);
  return written;
}

ssize_t write(int descriptor, const void* data, size_t bytes) {
  return Write("write", descriptor, data, bytes, -1);
}
ssize_t pwrite(int descriptor, const void* data, size_t bytes, off_t place) {
  return Write("pwrite", descriptor, data, bytes, place);
}
ssize_t pwrite64(int descriptor, const void* data, size_t bytes, off_t place) {
  return Write("pwrite", descriptor, data, bytes, place);
}
ssize_t writev(int descriptor, const struct iovec* parts, int count) {
  ssize_t all = 0;
  for (int i = 0; i < count; ++i) {
    const ssize_t written = Write("writev", descriptor, parts[i].iov_base, parts[i].iov_len, -1);
    if (written < 0) return all > 0 ? all : -1;
    all += written;
    if ((size_t)written < parts[i].iov_len) break;
  }
  return all;
}

/* A call on a descriptor that is logged under a name. */
static int OnDescriptor(const char* call, const char* logged, long number, int descriptor, long argument) {
  char path[PATH_MAX], more[40];
  PathOfDescriptor(descriptor, path);
  if (Judge(call, path) == kFail) return -1;
  const int logging = StartLog(path);
  const int result = (int)syscall(number, descriptor, argument);
  snprintf(more, sizeof more, "%ld", argument);
  if (result == 0 && logged) Log(logging, logged, path, more, NULL, 0);
  EndLog(logging);
  return result;
}

int fsync(int descriptor) { return OnDescriptor("fsync", "sync", SYS_fsync, descriptor, 0); }
int fdatasync(int descriptor) { return OnDescriptor("fdatasync", "sync", SYS_fdatasync, descriptor, 0); }
int syncfs(int descriptor) { return OnDescriptor("syncfs", "syncfs", SYS_syncfs, descriptor, 0); }
int ftruncate(int descriptor, off_t bytes) {
  return OnDescriptor("ftruncate", "truncate", SYS_ftruncate, descriptor, bytes);
}
int ftruncate64(int descriptor, off_t bytes) { return ftruncate(descriptor, bytes); }
int flock(int descriptor, int operation) {
  return OnDescriptor("flock", NULL, SYS_flock, descriptor, operation);
}

/* As Linux does, it closes the file even where it says that it failed. */
int close(int descriptor) {
  char path[PATH_MAX];
  PathOfDescriptor(descriptor, path);
  const int fails = Judge("close", path) == kFail;
  const int result = (int)syscall(SYS_close, descriptor);
  if (!fails) return result;
  errno = error_number;
  return -1;
}

static int Open(int folder, const char* name, int flags, mode_t permissions) {
  char path[PATH_MAX];
  PathOfName(folder, name, path);
  if (Judge(flags & O_DIRECTORY ? "opendir" : "open", path) == kFail) return -1;
  const int logging = StartLog(path);
  const int was_there = logging && syscall(SYS_faccessat, AT_FDCWD, path, F_OK) == 0;
  const int descriptor = (int)syscall(SYS_openat, folder, name, flags, permissions);
  if (descriptor >= 0 && (flags & O_CREAT) && !was_there) Log(logging, "create", path, "", NULL, 0);
  if (descriptor >= 0 && (flags & O_TRUNC) && was_there) Log(logging, "truncate", path, "0", NULL, 0);
  EndLog(logging);
  return descriptor;
}

#define PERMISSIONS_OF(flags)                          \
  mode_t permissions = 0;                              \
  if ((flags) & (O_CREAT | __O_TMPFILE)) {             \
    va_list arguments;                                 \
    va_start(arguments, flags);                        \
    permissions = (mode_t)va_arg(arguments, unsigned); \
    va_end(arguments);                                 \
  }

int open(const char* name, int flags, ...) {
  PERMISSIONS_OF(flags)
  return Open(AT_FDCWD, name, flags, permissions);
}
int open64(const char* name, int flags, ...) {
  PERMISSIONS_OF(flags)
  return Open(AT_FDCWD, name, flags, permissions);
}
int openat(int folder, const char* name, int flags, ...) {
  PERMISSIONS_OF(flags)
  return Open(folder, name, flags, permissions);
}
int openat64(int folder, const char* name, int flags, ...) {
  PERMISSIONS_OF(flags)
  return Open(folder, name, flags, permissions);
}

/* A call on a name in a folder. */
static int OnName(const char* call, long number, int folder, const char* name, long argument) {
  char path[PATH_MAX];
  PathOfName(folder, name, path);
  if (Judge(call, path) == kFail) return -1;
  const int logging = StartLog(path);
  const int result = (int)syscall(number, folder, name, argument);
  if (result == 0) Log(logging, call, path, "", NULL, 0);
  EndLog(logging);
  return result;
}

int mkdirat(int folder, const char* name, mode_t permissions) {
  return OnName("mkdir", SYS_mkdirat, folder, name, permissions);
}
int mkdir(const char* name, mode_t permissions) { return mkdirat(AT_FDCWD, name, permissions); }
char* mkdtemp(char* name) {
  static atomic_long last;
  char* end = name + strlen(name) - 6;
  do {
    const long number = (getpid() * 100L + atomic_fetch_add(&last, 1)) % 1000000;
    for (int i = 0, rest = (int)number; i < 6; ++i, rest /= 10) end[i] = (char)('0' + rest % 10);
    if (mkdir(name, 0700) == 0) return name;
  } while (errno == EEXIST);
  return NULL;
}

/* From one name to another: rename and link. */
static int Between(const char* call, long number, int from_folder, const char* from, int to_folder,
                   const char* to, int flags) {
  char from_path[PATH_MAX], to_path[PATH_MAX];
  PathOfName(from_folder, from, from_path);
  PathOfName(to_folder, to, to_path);
  if (Judge(call, to_path) == kFail) return -1;
  const int logging = StartLog(to_path);
  const int result = (int)syscall(number, from_folder, from, to_folder, to, flags);
  if (result == 0) Log(logging, call, from_path, to_path, NULL, 0);
  EndLog(logging);
  return result;
}

int rename(const char* from, const char* to) {
  return Between("rename", SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0);
}
int renameat(int from_folder, const char* from, int to_folder, const char* to) {
  return Between("rename", SYS_renameat2, from_folder, from, to_folder, to, 0);
}
int link(const char* from, const char* to) {
  return Between("link", SYS_linkat, AT_FDCWD, from, AT_FDCWD, to, 0);
}
int linkat(int from_folder, const char* from, int to_folder, const char* to, int flags) {
  return Between("link", SYS_linkat, from_folder, from, to_folder, to, flags);
}

int unlinkat(int folder, const char* name, int flags) {
  return OnName("unlink", SYS_unlinkat, folder, name, flags);
}
int unlink(const char* name) { return unlinkat(AT_FDCWD, name, 0); }
int rmdir(const char* name) { return unlinkat(AT_FDCWD, name, AT_REMOVEDIR); }
int remove(const char* name) {
  const int result = unlink(name);
  return result < 0 && (errno == EISDIR || errno == EPERM) ? rmdir(name) : result;
}
