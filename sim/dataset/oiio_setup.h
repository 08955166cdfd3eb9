// OpenImageIO as this program wants it. Only sim/dataset's own .cpp files include this.
#pragma once

namespace shimmer::dataset {

// No threads of its own. Called before any other use of OpenImageIO.
void SetUpOpenImageIO();

}  // namespace shimmer::dataset
