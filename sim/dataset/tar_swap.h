// A tar that takes the place of another one, together with the manifest's lines that say where its members
// lie. The two can't change at once: the tar before stays beside until the manifest names the new one, and
// whoever finds it there afterwards keeps the one that the manifest names.
#pragma once

#include <filesystem>

namespace shimmer::dataset {

// Keeps what is there under a tar's name beside, as staging / "NAME.before", if anything is. Durable when it
// returns.
void KeepTar(const std::filesystem::path& tar, const std::filesystem::path& staging);

// The manifest names the new ones: those before them may go.
void DropKeptTars(const std::filesystem::path& staging);

// After a kill or an error: a tar that was kept gets its place back if it is the one that the manifests of
// the data set name. Then none is kept any more. Throws std::runtime_error.
void SettleKeptTars(const std::filesystem::path& folder, const std::filesystem::path& staging);

}  // namespace shimmer::dataset
