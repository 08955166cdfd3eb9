#include "sim/dataset/mapped_memory.h"

#include <sys/mman.h>

#include <memory>
#include <new>

namespace shimmer::dataset {
namespace {

constexpr size_t kLeastBytes = 1 << 20;

class Mapped : public cv::MatAllocator {
 public:
  cv::UMatData* allocate(int dims, const int* sizes, int type, void* data, size_t* steps,
                         cv::AccessFlag access, cv::UMatUsageFlags usage) const override {
    size_t bytes = CV_ELEM_SIZE(type);
    for (int i = 0; i < dims; ++i) bytes *= static_cast<size_t>(sizes[i]);
    if (data || bytes < kLeastBytes)  // whose memory gives back itself
      return cv::Mat::getStdAllocator()->allocate(dims, sizes, type, data, steps, access, usage);
    size_t step = CV_ELEM_SIZE(type);
    for (int i = dims - 1; i >= 0; step *= static_cast<size_t>(sizes[i--])) steps[i] = step;
    auto memory = std::make_unique<cv::UMatData>(this);
    void* const mapped = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (mapped == MAP_FAILED) throw std::bad_alloc();
    memory->data = memory->origdata = static_cast<uchar*>(mapped);
    memory->size = bytes;
    return memory.release();
  }

  bool allocate(cv::UMatData* memory, cv::AccessFlag, cv::UMatUsageFlags) const override {
    return memory != nullptr;
  }

  void deallocate(cv::UMatData* memory) const override {
    munmap(memory->origdata, memory->size);
    delete memory;
  }
};

}  // namespace

cv::MatAllocator* MappedMemory() {
  static Mapped mapped;
  return &mapped;
}

}  // namespace shimmer::dataset
