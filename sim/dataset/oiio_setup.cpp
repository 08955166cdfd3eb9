#include "sim/dataset/oiio_setup.h"

#include <OpenImageIO/imageio.h>
#include <dlfcn.h>
#include <png.h>

namespace {

// How the picture that this thread has opened last takes note of an error. OpenImageIO's way returns.
thread_local png_error_ptr note = nullptr;

// As libpng wants it: this never returns.
[[noreturn]] void NoteAndEnd(png_structp png, png_const_charp what) {
  if (note) note(png, what);
  png_longjmp(png, 1);
}

}  // namespace

// libpng prints what is wrong with a file when the function that it was given for errors returns, and a
// library must not print. So this stands before libpng's function of the name, and sees to it that none
// returns.
extern "C" void png_set_error_fn(png_structrp png, png_voidp context, png_error_ptr error,
                                 png_error_ptr warning) {
  static const auto set = reinterpret_cast<decltype(&png_set_error_fn)>(dlsym(RTLD_NEXT, "png_set_error_fn"));
  note = error;
  set(png, context, NoteAndEnd, warning);
}

namespace shimmer::dataset {

void SetUpOpenImageIO() {
  static const bool done = OIIO::attribute("threads", 1) && OIIO::attribute("exr_threads", -1);
  (void)done;
}

}  // namespace shimmer::dataset
