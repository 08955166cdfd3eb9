// Every reader of PNG that is at hand gives back the samples that were written.
#include <OpenImageIO/imageio.h>
#include <png.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "sim/dataset/image_io.h"
#include "sim/dataset/png_write.h"
#include "tests/app/python.h"
#include "tests/dataset/png_pictures.h"
#include "tests/dataset/temp_folder.h"

namespace shimmer::dataset {
namespace {

using Bytes = std::vector<uint8_t>;

struct LibpngSource {
  const Bytes& file;
  size_t at = 0;
  std::string complaints;
};

void ReadForLibpng(png_structp png, png_bytep to, size_t count) {
  auto& source = *static_cast<LibpngSource*>(png_get_io_ptr(png));
  if (count > source.file.size() - source.at) png_error(png, "end of file");
  std::copy_n(source.file.begin() + source.at, count, to);
  source.at += count;
}

void KeepComplaint(png_structp png, png_const_charp text) {
  static_cast<LibpngSource*>(png_get_error_ptr(png))->complaints += std::string(text) + "\n";
}

[[noreturn]] void KeepError(png_structp png, png_const_charp text) {
  KeepComplaint(png, text);
  png_longjmp(png, 1);
}

// The samples as libpng reads them; empty after an error. Warnings are complaints too.
cv::Mat ReadByLibpng(const Bytes& file, std::string& complaints) {
  LibpngSource source{file, 0, {}};
  cv::Mat samples;
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &source, KeepError, KeepComplaint);
  png_infop info = png_create_info_struct(png);
  if (setjmp(png_jmpbuf(png)) == 0) {
    png_set_read_fn(png, &source, ReadForLibpng);
    png_read_png(png, info, PNG_TRANSFORM_SWAP_ENDIAN, nullptr);
    const int depth = png_get_bit_depth(png, info) == 16 ? CV_16U : CV_8U;
    samples.create(static_cast<int>(png_get_image_height(png, info)),
                   static_cast<int>(png_get_image_width(png, info)),
                   CV_MAKETYPE(depth, png_get_channels(png, info)));
    for (int y = 0; y < samples.rows; ++y)
      std::copy_n(png_get_rows(png, info)[y], png_get_rowbytes(png, info), samples.ptr(y));
  }
  png_destroy_read_struct(&png, &info, nullptr);
  if (source.at != file.size()) source.complaints += "does not end at its end\n";
  complaints = source.complaints;
  return samples;
}

TEST(PngReaders, Libpng) {
  ForEachPngPicture([](const cv::Mat& samples) {
    std::string complaints;
    EXPECT_TRUE(SameBits(ReadByLibpng(WritePng(samples), complaints), samples)) << NameOf(samples);
    EXPECT_EQ(complaints, "") << NameOf(samples);
  });
}

// OpenCV has blue first, and repeats a grey that has alpha.
cv::Mat AsOpenCvReads(const cv::Mat& samples) {
  cv::Mat expected(samples.size(), CV_MAKETYPE(samples.depth(), 4));
  switch (samples.channels()) {
    case 1:
      return samples;
    case 2:
      cv::mixChannels({samples}, {expected}, {0, 0, 0, 1, 0, 2, 1, 3});
      return expected;
    case 3:
      cv::cvtColor(samples, expected, cv::COLOR_RGB2BGR);
      return expected;
    default:
      cv::cvtColor(samples, expected, cv::COLOR_RGBA2BGRA);
      return expected;
  }
}

TEST(PngReaders, OpenCv) {
  ForEachPngPicture([](const cv::Mat& samples) {
    const cv::Mat back = cv::imdecode(WritePng(samples), cv::IMREAD_UNCHANGED);
    EXPECT_TRUE(SameBits(back, AsOpenCvReads(samples))) << NameOf(samples);
  });
}

TEST(PngReaders, OpenImageIo) {
  const TempFolder folder;
  ForEachPngPicture([&](const cv::Mat& samples) {
    OIIO::ImageSpec as_stored;
    as_stored["oiio:UnassociatedAlpha"] = 1;
    const auto input = OIIO::ImageInput::open(folder.Put("x.png", WritePng(samples)), &as_stored);
    ASSERT_TRUE(input) << OIIO::geterror();
    const OIIO::ImageSpec& spec = input->spec();
    cv::Mat back(spec.height, spec.width,
                 CV_MAKETYPE(spec.format == OIIO::TypeUInt16 ? CV_16U : CV_8U, spec.nchannels));
    EXPECT_TRUE(input->read_image(0, 0, 0, spec.nchannels, spec.format, back.data)) << input->geterror();
    EXPECT_TRUE(SameBits(back, samples)) << NameOf(samples);
  });
}

// ReadImage knows grey and RGB, and drops alpha.
TEST(PngReaders, OurOwn) {
  const TempFolder folder;
  ForEachPngPicture([&](const cv::Mat& samples) {
    const Picture picture = ReadImage(folder.Put("x.png", WritePng(samples)));
    const int channels = samples.channels();
    EXPECT_EQ(picture.alpha_dropped, channels == 2 || channels == 4);
    std::vector<cv::Mat> planes;
    cv::split(samples, planes);
    planes.resize(channels < 3 ? 1 : 3);
    cv::Mat shown;
    cv::merge(planes, shown);
    EXPECT_TRUE(SameBits(picture.pixels, FromSamples(shown))) << NameOf(samples);
  });
}

// Puts pictures and their samples into the folder, as n.png and n.raw (little-endian), and lists them.
void PutForPython(const TempFolder& folder) {
  std::string list;
  int n = 0;
  ForEachPngPicture([&](const cv::Mat& samples) {
    const std::string name = std::to_string(n++);
    folder.Put(name + ".png", WritePng(samples));
    folder.Put(name + ".raw", {samples.data, samples.total() * samples.elemSize()});
    list += name + (samples.depth() == CV_8U ? " uint8 " : " uint16 ") + std::to_string(samples.rows) + " " +
            std::to_string(samples.cols) + " " + std::to_string(samples.channels()) + "\n";
  });
  folder.Put("list", list);
}

// The names of the pictures that the Python function same(path, samples) does not find the same, and their
// number.
std::string RunOnPictures(const std::string& same) {
  const TempFolder folder;
  PutForPython(folder);
  return app::RunPython("import numpy, sys\n" + same + R"(
folder, count = open(sys.argv[1]).read(), 0
for line in open(folder + "/list"):
    name, dtype, h, w, c = line.split()
    samples = numpy.fromfile(f"{folder}/{name}.raw", dtype).reshape(int(h), int(w), int(c))
    if not same(f"{folder}/{name}.png", samples): print("differs:", line)
    count += 1
print(count > 700)
)",
                        {folder.path().string()});
}

TEST(PngReaders, PythonPillow) {
  if (!app::PythonHas("numpy, PIL"))
    GTEST_SKIP() << "Debian's python3-numpy and python3-pil are not installed";
  // Pillow keeps 16 bits of grey alone, and the high byte of other samples; 16-bit grey with alpha becomes
  // RGBA.
  EXPECT_EQ(RunOnPictures(R"(
from PIL import Image
def same(path, samples):
    picture = Image.open(path)
    if samples.dtype == numpy.uint16 and samples.shape[2] > 1:
        samples = (samples >> 8).astype(numpy.uint8)
    back = numpy.asarray(picture).reshape(samples.shape[:2] + (-1,))
    if samples.shape[2] == 2 and picture.mode == "RGBA": back = back[:, :, [0, 3]]
    return picture.mode in ("L", "LA", "RGB", "RGBA", "I", "I;16") and (back == samples).all()
)"),
            "True\n");
}

TEST(PngReaders, PythonOpenCv) {
  if (!app::PythonHas("numpy, cv2"))
    GTEST_SKIP() << "Debian's python3-numpy and python3-opencv are not installed";
  EXPECT_EQ(RunOnPictures(R"(
import cv2
def same(path, samples):
    back = cv2.imread(path, cv2.IMREAD_UNCHANGED).reshape(samples.shape[:2] + (-1,))
    order = {1: [0], 2: [0, 0, 0, 1], 3: [2, 1, 0], 4: [2, 1, 0, 3]}[samples.shape[2]]
    return back.dtype == samples.dtype and (back == samples[:, :, order]).all()
)"),
            "True\n");
}

}  // namespace
}  // namespace shimmer::dataset
