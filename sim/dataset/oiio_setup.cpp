#include "sim/dataset/oiio_setup.h"

#include <OpenImageIO/imageio.h>

namespace shimmer::dataset {

void SetUpOpenImageIO() {
  static const bool done = OIIO::attribute("threads", 1) && OIIO::attribute("exr_threads", -1);
  (void)done;
}

}  // namespace shimmer::dataset
