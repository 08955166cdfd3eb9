// A file system that is soon full.
#pragma once

#include <gtest/gtest.h>
#include <sys/mount.h>

#include <filesystem>
#include <string>

namespace shimmer::app {

// In memory, gone with its content; not there if that is not permitted. limits: "size=64k", "nr_inodes=20".
class SmallDisk {
 public:
  SmallDisk(const std::filesystem::path& path, const std::string& limits) : path_(path) {
    std::filesystem::create_directory(path);
    mounted_ = mount("tmpfs", path.c_str(), "tmpfs", 0, limits.c_str()) == 0;
  }
  ~SmallDisk() {
    if (mounted_) umount(path_.c_str());
  }
  SmallDisk(const SmallDisk&) = delete;
  bool mounted() const { return mounted_; }
  void Enlarge(const std::string& limits) {
    ASSERT_EQ(mount("tmpfs", path_.c_str(), "tmpfs", MS_REMOUNT, limits.c_str()), 0);
  }

 private:
  std::filesystem::path path_;
  bool mounted_;
};

}  // namespace shimmer::app
