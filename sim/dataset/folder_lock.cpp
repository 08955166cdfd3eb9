#include "sim/dataset/folder_lock.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <fstream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "sim/dataset/files.h"
#include "sim/dataset/glob.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

std::string HostName() {
  char name[256] = {};
  gethostname(name, sizeof name - 1);
  return name;
}

// When a process began, in the kernel's ticks since boot: a number that is used again belongs to another one.
std::string StartOf(pid_t process) {
  std::ifstream stat("/proc/" + std::to_string(process) + "/stat");
  std::string text((std::istreambuf_iterator<char>(stat)), {});
  const size_t name_end = text.rfind(')');
  if (name_end == std::string::npos) return "";
  text.erase(0, name_end + 2);
  for (int field = 3; field < 22; ++field) text.erase(0, text.find(' ') + 1);
  return text.substr(0, text.find(' '));
}

struct Holder {
  std::string host, start;
  pid_t process = 0;

  static Holder Self() { return {HostName(), StartOf(getpid()), getpid()}; }

  static std::optional<Holder> Of(const fs::path& file) {
    std::ifstream stream(file);
    const Json json = Json::parse(stream, nullptr, /*allow_exceptions=*/false);
    if (!json.is_object()) return {};
    const Json host = json.value("host", Json()), process = json.value("process", Json()),
               start = json.value("start", Json());
    if (!host.is_string() || !process.is_number_integer() || !start.is_string()) return {};
    return Holder{host.get<std::string>(), start.get<std::string>(), process.get<pid_t>()};
  }

  std::string Text() const {
    return Json{{"host", host}, {"process", process}, {"start", start}}.dump() + "\n";
  }
  bool IsSelf() const {
    const Holder self = Self();
    return host == self.host && process == self.process && start == self.start;
  }
};

// By the clock of the file system, which the hosts that share it may not agree with.
double AgeSeconds(const fs::path& file, const fs::path& just_written) {
  struct stat of_file = {}, now = {};
  if (stat(file.c_str(), &of_file) != 0 || stat(just_written.c_str(), &now) != 0) return 0;
  return std::difftime(now.st_mtime, of_file.st_mtime);
}

// Without locks: whether the holder that the file names is at work.
bool IsAlive(const fs::path& file, const Holder& holder, const fs::path& just_written) {
  if (holder.host == HostName()) return StartOf(holder.process) == holder.start && !holder.start.empty();
  return AgeSeconds(file, just_written) < kStaleSeconds;
}

[[noreturn]] void Busy(const fs::path& folder, const fs::path& lock) {
  std::string who = "another process";
  if (const auto holder = Holder::Of(lock))
    who = "process " + std::to_string(holder->process) + " on " + holder->host;
  const std::string name = lock.filename().string();
  const std::string what =
      name == kLockName ? "this data set" : "shard " + name.substr(std::string(kLockName).size() + 1);
  throw FolderBusy(folder.string() + ": " + who + " writes to " + what +
                   "; wait for it to end (generate --wait does)");
}

// Without locks: who looks whether a folder is free and then takes it does so alone. Lives for a moment; that
// of a process which was killed in it is nobody's after kStaleSeconds.
class Claim {
 public:
  Claim(const fs::path& folder, const fs::path& lock)
      : path_(folder / (".lock-claim" + lock.filename().string().substr(std::string(kLockName).size()))) {
    if (Make()) return;
    const auto age = fs::file_time_type::clock::now() - fs::last_write_time(path_, error_);
    if (error_ || age < std::chrono::seconds(kStaleSeconds)) Busy(folder, lock);
    fs::remove(path_, error_);
    if (!Make()) Busy(folder, lock);
  }
  ~Claim() { fs::remove(path_, error_); }
  Claim(const Claim&) = delete;

  const fs::path& path() const { return path_; }  // just made, by the file system's clock

 private:
  // One at a time can, over a network too.
  bool Make() {
    const bool made = fs::create_directory(path_, error_);
    if (error_) throw std::runtime_error(path_.string() + ": can't be made: " + error_.message());
    return made;
  }

  fs::path path_;
  std::error_code error_;
};

}  // namespace

class FolderLock::Held {
 public:
  Held(const fs::path& folder, const Shard& shard)
      : path_(folder / (kLockName + shard.Suffix())), file_(path_, O_CREAT | O_RDWR) {
    const Lock lock = file_.TryLock();
    if (lock == Lock::kTaken) Busy(folder, path_);
    if (lock == Lock::kNone) {
      const Claim claim(folder, path_);
      const auto named = Holder::Of(path_);
      if (named && !named->IsSelf() && IsAlive(path_, *named, claim.path())) Busy(folder, path_);
      WriteHolder();
    } else {
      WriteHolder();
    }
    try {
      RefuseOthers(folder, shard);
    } catch (...) {
      GiveUp();
      throw;
    }
    if (lock == Lock::kNone) renewal_ = std::jthread([this](std::stop_token stop) { Renew(stop); });
  }
  ~Held() {
    renewal_ = {};
    GiveUp();
  }

 private:
  void WriteHolder() {
    file_.Truncate(0);
    FileHandle(path_, O_WRONLY).WriteAll(AsBytes(Holder::Self().Text()));
  }

  void GiveUp() {
    try {
      file_.Truncate(0);  // its lock goes with the handle; without locks, an empty file is nobody's
    } catch (const std::exception&) {
    }
  }

  // Whoever else may not write while this one does. Each takes its own lock first and looks at the others'
  // then, so of two that begin at the same moment at least one sees the other.
  void RefuseOthers(const fs::path& folder, const Shard& shard) const {
    std::vector<fs::path> others = ExpandGlob(folder, std::string(kLockName) + ".*-of-*");
    if (!shard.whole()) {
      const std::string count = shard.Suffix().substr(shard.Suffix().find("-of-"));
      std::erase_if(others, [&](const fs::path& other) { return other.string().ends_with(count); });
      others.push_back(folder / kLockName);
    }
    for (const fs::path& other : others) {
      if (!fs::exists(other)) continue;
      FileHandle file(other, O_RDWR);
      const Lock lock = file.TryLock(LockKind::kShared);  // several may look at the same moment
      const auto named = Holder::Of(other);
      if (lock == Lock::kTaken || (lock == Lock::kNone && named && IsAlive(other, *named, path_)))
        Busy(folder, other);
    }
  }

  void Renew(const std::stop_token& stop) const {
    std::mutex mutex;
    std::condition_variable_any waker;
    std::unique_lock guard(mutex);
    while (!waker.wait_for(guard, stop, std::chrono::seconds(kRenewSeconds),
                           [&] { return stop.stop_requested(); }))
      utimensat(AT_FDCWD, path_.c_str(), nullptr, 0);
  }

  fs::path path_;
  FileHandle file_;
  std::jthread renewal_;
};

FolderLock::FolderLock(const fs::path& folder, const Shard& shard)
    : held_(std::make_unique<Held>(folder, shard)) {}
FolderLock::~FolderLock() = default;
FolderLock::FolderLock(FolderLock&&) noexcept = default;

std::unique_ptr<FolderLock> LockToRead(const fs::path& folder) {
  try {
    return std::make_unique<FolderLock>(folder, Shard{});
  } catch (const FolderBusy&) {
    throw;
  } catch (const std::runtime_error&) {
    if (access(folder.c_str(), W_OK) == 0) throw;
    return nullptr;
  }
}

}  // namespace shimmer::dataset
