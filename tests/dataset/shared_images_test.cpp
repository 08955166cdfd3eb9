// Odd and damaged files that others collected: PngSuite, libpng's, OpenEXR's. None may crash; damaged ones
// are refused.
#include <algorithm>
#include <cmath>

#include "sim/dataset/image_io.h"
#include "tests/dataset/temp_folder.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;

const fs::path kFormats = fs::path(SHIMMER_SHARED_DIR) / "data" / "formats";

std::vector<fs::path> FilesIn(const fs::path& folder, const std::string& extension) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && (extension.empty() || entry.path().extension() == extension))
      files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

#define SKIP_WITHOUT(folder) \
  if (!fs::exists(folder)) GTEST_SKIP() << "no such test data: " << (folder)

TEST(SharedImages, PngSuite) {
  const fs::path folder = kFormats / "D04_png" / "pngsuite";
  SKIP_WITHOUT(folder);
  int read = 0;
  for (const fs::path& file : FilesIn(folder, ".png")) {
    if (file.filename().string()[0] == 'x') {
      EXPECT_THROW(ReadImage(file), std::runtime_error) << file;
      continue;
    }
    const Picture picture = ReadImage(file);
    // The fourth character says the colour type: 0 and 4 grey, 2, 3 and 6 colour.
    const char colour_type = file.filename().string()[4];
    EXPECT_EQ(picture.pixels.channels(), colour_type == '0' || colour_type == '4' ? 1 : 3) << file;
    EXPECT_FALSE(picture.linear);
    EXPECT_EQ(picture.replaced, 0);
    ++read;
  }
  EXPECT_GT(read, 150);
}

TEST(SharedImages, DepthsOfPngSuiteAgree) {
  const fs::path folder = kFormats / "D04_png" / "pngsuite";
  SKIP_WITHOUT(folder);
  // The same ramp, plain and interlaced, must be the same pixels.
  for (const std::string name :
       {"0g08", "0g16", "2c08", "2c16", "3p08", "4a08", "4a16", "6a08", "6a16", "0g01"})
    EXPECT_TRUE(SameBits(ReadImage(folder / ("basn" + name + ".png")).pixels,
                         ReadImage(folder / ("basi" + name + ".png")).pixels))
        << name;
}

TEST(SharedImages, LibpngsOwn) {
  const fs::path folder = kFormats / "D04_png" / "libpng_testpngs";
  SKIP_WITHOUT(folder);
  for (const fs::path& file : FilesIn(folder, ".png")) EXPECT_NO_THROW(ReadImage(file)) << file;
  for (const fs::path& file : FilesIn(folder / "crashers", ".png")) {
    // Nothing is wrong with this one but a few chunks without content.
    const bool fine = file.filename() == "empty_ancillary_chunks.png";
    EXPECT_EQ(ErrorOf<std::runtime_error>([&] { ReadImage(file); }).empty(), fine) << file;
  }
}

TEST(SharedImages, Exr) {
  const fs::path folder = kFormats / "exr";
  SKIP_WITHOUT(folder);
  for (const fs::path& file : FilesIn(folder, ".exr")) {
    const Picture picture = ReadImage(file);
    EXPECT_TRUE(picture.linear) << file;
    EXPECT_TRUE(cv::checkRange(picture.pixels, true, nullptr, -65504.5, 65504.5)) << file;  // no NaN, no Inf
    const std::string name = file.filename().string();
    EXPECT_EQ(picture.replaced > 0, name == "BrightRingsNanInf.exr") << file;
    EXPECT_EQ(picture.pixels.channels(), name == "GrayRampsHorizontal.exr" ? 1 : 3) << file;
    EXPECT_EQ(picture.alpha_dropped, name == "stripes.exr") << file;
  }
}

TEST(SharedImages, DamagedExr) {
  const fs::path folder = kFormats / "exr_damaged";
  SKIP_WITHOUT(folder);
  const TempFolder copies;
  for (const fs::path& file : FilesIn(folder, "")) {
    EXPECT_THROW(ReadImage(file), std::runtime_error) << file;
    // Found by fuzzing, they have no extension: with one, the EXR reader is asked first.
    const fs::path named = copies / "damaged.exr";
    fs::copy_file(file, named, fs::copy_options::overwrite_existing);
    EXPECT_THROW(ReadImage(named), std::runtime_error) << file;
  }
}

}  // namespace
}  // namespace shimmer::dataset
