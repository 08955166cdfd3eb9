// Files that training code wants beside the pictures, each a function of the clips that are done:
//
//   restormer    NAME/train/meta_info.txt, NAME/test/meta_info.txt: a line a pair, "000000.png (h,w,c)"
//                NAME/restormer.yml: options for Restormer's own training code (restormer_options.h)
//   basicsr      meta_info.txt, part001/meta_info.txt: a line a clip, "000 100 (h,w,c)"
//   webdataset   shards/index.json: {"wids_version": 1, "shardlist": [{"url", "nsamples", "filesize"}]}
#pragma once

#include <map>
#include <string>

#include "sim/dataset/dataset_reader.h"
#include "sim/dataset/layout.h"

namespace shimmer::dataset {

// By path, relative to the data set's folder. Throws std::runtime_error where a line of the manifest is
// damaged.
std::map<std::string, std::string> DerivedFiles(const DatasetReader& set, const Layout& layout);

// Whether a file of such a name may be one of them, in a set of any clips.
bool IsDerivedPath(const std::string& path, const Layout& layout);

// Writes those that are not there or say something else.
void WriteDerivedFiles(const DatasetReader& set, const Layout& layout);

}  // namespace shimmer::dataset
