#include "sim/dataset/image_io.h"
#include "sim/dataset/pixel_hash.h"

#include <OpenImageIO/imageio.h>

#include <cmath>
#include <limits>
#include <thread>

#include "tests/dataset/temp_folder.h"

namespace shimmer::dataset {
namespace {

const std::vector<cv::Size> kSizes = {{1, 1}, {1, 17}, {17, 1}, {31, 33}};
const std::vector<Encoding> kEncodings = {{FileFormat::kPng, 8},
                                          {FileFormat::kPng, 16},
                                          {FileFormat::kPng, 8, PngWriter::kOpenImageIo},
                                          {FileFormat::kPng, 16, PngWriter::kOpenImageIo},
                                          {FileFormat::kExr, 16},
                                          {FileFormat::kExr, 32}};

// Written by OpenImageIO itself, to have what our own writers never make.
std::filesystem::path PutWithOiio(const TempFolder& folder, const std::string& name, OIIO::ImageSpec spec,
                                  const void* samples) {
  const std::filesystem::path path = folder / name;
  auto output = OIIO::ImageOutput::create(path.string());
  EXPECT_TRUE(output && output->open(path.string(), spec) && output->write_image(spec.format, samples) &&
              output->close());
  return path;
}

TEST(ImageIo, ReadingGivesBackTheQuantisedPicture) {
  const TempFolder folder;
  for (const Encoding encoding : kEncodings)
    for (const cv::Size size : kSizes)
      for (const int channels : {1, 3}) {
        // Beyond the range on both sides, so that clamping is part of it.
        const cv::Mat image = RandomImage(size, channels, 1, -0.2f, 1.2f);
        const auto path =
            folder.Put(std::string("x.") + Extension(encoding.format), EncodeImage(image, encoding));
        const Picture back = ReadImage(path);
        EXPECT_TRUE(SameBits(back.pixels, Quantise(image, encoding)))
            << Extension(encoding.format) << encoding.bits << " " << size << " x " << channels;
        EXPECT_EQ(back.linear, encoding.format == FileFormat::kExr);
        EXPECT_FALSE(back.alpha_dropped);
        EXPECT_EQ(back.replaced, 0);
        // As samples it is what the file holds; halves are read as floats.
        const cv::Mat samples = ReadSamples(path).pixels;
        EXPECT_TRUE(SameBits(samples,
                             encoding.format == FileFormat::kPng ? ToSamples(image, encoding) : back.pixels));
      }
}

// Whose memory is mapped: it stays with every header that points to it, and a matrix made anew on such a
// header.
TEST(ImageIo, LargePictures) {
  const TempFolder folder;
  const cv::Mat image = RandomImage({700, 600}, 3, 1), samples = ToSamples(image, {});
  OIIO::ImageSpec spec(600, 700, 3, OIIO::TypeUInt8);
  spec["Orientation"] = 5;  // rows and columns swapped
  const auto path = PutWithOiio(folder, "turned.tif", spec, cv::Mat(samples.t()).data);
  cv::Mat part;
  {
    Picture picture = ReadSamples(path);
    EXPECT_TRUE(SameBits(picture.pixels, samples));
    part = picture.pixels({100, 200, 300, 50});
    picture.pixels.create(900, 800, CV_8UC3);
    picture.pixels.setTo(7);
    picture.pixels.create(3, 2, CV_8U);
  }
  EXPECT_TRUE(SameBits(part, samples({100, 200, 300, 50})));
}

TEST(ImageIo, EveryLevelComesBackAndQuantisingTwiceIsOnce) {
  for (const Encoding encoding : kEncodings) {
    const int levels = encoding.bits == 8 ? 256 : 65536;
    cv::Mat image(1, levels, CV_32F);
    for (int i = 0; i < levels; ++i) image.at<float>(0, i) = i / static_cast<float>(levels - 1);
    const cv::Mat once = Quantise(image, encoding);
    EXPECT_TRUE(SameBits(Quantise(once, encoding), once)) << Extension(encoding.format) << encoding.bits;
    EXPECT_TRUE(encoding.format == FileFormat::kExr || SameBits(once, image)) << encoding.bits;
  }
}

TEST(ImageIo, RoundsToNearestAndTiesToEven) {
  // k + 0.5 levels, exact in float: 0.5 / 255 is not, so 255 levels are spread over [0, 255/256].
  const cv::Mat halves =
      (cv::Mat_<float>(1, 4) << 0.5f, 0.25f, 0.75f, 0.125f);  // 127.5, 63.75, 191.25, 31.875
  const cv::Mat samples = ToSamples(halves, {FileFormat::kPng, 8});
  EXPECT_EQ(samples.at<uint8_t>(0, 0), 128);  // 127.5: 128 is the even one
  EXPECT_EQ(samples.at<uint8_t>(0, 1), 64);
  EXPECT_EQ(samples.at<uint8_t>(0, 2), 191);
  EXPECT_EQ(samples.at<uint8_t>(0, 3), 32);
  EXPECT_EQ(ToSamples(halves, {FileFormat::kPng, 16}).at<uint16_t>(0, 0), 32768);  // of 32767.5
}

TEST(ImageIo, SamplesOutsideTheRangeWhenWriting) {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  const cv::Mat odd = (cv::Mat_<float>(1, 6) << nan, inf, -inf, 70000, -70000, -1);
  const cv::Mat png = Quantise(odd, {FileFormat::kPng, 8}), half = Quantise(odd, {FileFormat::kExr, 16});
  EXPECT_TRUE(SameBits(png, (cv::Mat_<float>(1, 6) << 0, 1, 0, 1, 0, 0)));
  EXPECT_TRUE(SameBits(half, (cv::Mat_<float>(1, 6) << 0, 65504, -65504, 65504, -65504, -1)));
  EXPECT_TRUE(SameBits(Quantise(odd, {FileFormat::kExr, 32}), half));
}

TEST(ImageIo, NonFiniteSamplesAreReplacedAndCounted) {
  const TempFolder folder;
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> samples = {nan, inf, -inf, 65504, -65504, 65505, 1e38f, 1e-45f};
  const auto path = PutWithOiio(folder, "odd.exr", OIIO::ImageSpec(4, 2, 1, OIIO::TypeFloat), samples.data());
  const Picture picture = ReadImage(path);
  EXPECT_EQ(picture.replaced, 5);
  EXPECT_TRUE(SameBits(picture.pixels,
                       (cv::Mat_<float>(2, 4) << 0, 65504, -65504, 65504, -65504, 65504, 65504, 1e-45f)));
}

TEST(ImageIo, AlphaIsDroppedAndColourNotMultipliedByIt) {
  const TempFolder folder;
  OIIO::ImageSpec rgba(1, 1, 4, OIIO::TypeUInt8), grey(1, 1, 2, OIIO::TypeUInt8);
  rgba["oiio:UnassociatedAlpha"] = 1;
  grey["oiio:UnassociatedAlpha"] = 1;
  grey.channelnames = {"Y", "A"};
  grey.alpha_channel = 1;
  const std::vector<uint8_t> rgba_pixel = {200, 100, 50, 10}, grey_pixel = {200, 10};
  const Picture colour = ReadImage(PutWithOiio(folder, "rgba.png", rgba, rgba_pixel.data()));
  EXPECT_TRUE(colour.alpha_dropped);
  ASSERT_EQ(colour.pixels.type(), CV_32FC3);
  EXPECT_EQ(colour.pixels.at<cv::Vec3f>(0, 0), cv::Vec3f(200 / 255.f, 100 / 255.f, 50 / 255.f));
  const Picture one = ReadImage(PutWithOiio(folder, "ya.png", grey, grey_pixel.data()));
  EXPECT_TRUE(one.alpha_dropped);
  ASSERT_EQ(one.pixels.type(), CV_32FC1);
  EXPECT_EQ(one.pixels.at<float>(0, 0), 200 / 255.f);
}

TEST(ImageIo, ChannelsByNameOrTheFirstThree) {
  const TempFolder folder;
  OIIO::ImageSpec named(1, 1, 5, OIIO::TypeUInt16), nameless(1, 1, 5, OIIO::TypeUInt16),
      two(1, 1, 2, OIIO::TypeFloat);
  named.channelnames = {"a", "B", "G", "depth", "R"};
  const std::vector<uint16_t> pixel = {1, 2, 3, 4, 5};
  // TIFF keeps the order, and no names; EXR keeps names.
  OIIO::ImageSpec named_exr = named;
  named_exr.set_format(OIIO::TypeFloat);
  const std::vector<float> float_pixel = {1, 2, 3, 4, 5};
  EXPECT_EQ(
      ReadImage(PutWithOiio(folder, "named.exr", named_exr, float_pixel.data())).pixels.at<cv::Vec3f>(0, 0),
      cv::Vec3f(5, 3, 2));
  EXPECT_EQ(ReadImage(PutWithOiio(folder, "nameless.tif", nameless, pixel.data())).pixels.at<cv::Vec3f>(0, 0),
            cv::Vec3f(1 / 65535.f, 2 / 65535.f, 3 / 65535.f));
  two.channelnames = {"dx", "dy"};
  two.alpha_channel = -1;
  const auto path = PutWithOiio(folder, "two.exr", two, float_pixel.data());
  EXPECT_TRUE(Contains(ErrorOf<std::runtime_error>([&] { ReadImage(path); }), "two channels"));
}

TEST(ImageIo, NamedChannelsOfTruth) {
  const TempFolder folder;
  const cv::Mat truth = RandomImage({5, 3}, 3, 2, -64, 64);
  const std::vector<std::string> names = {"dx", "dy", "sigma"}, tilt = {"dx", "dy"}, swapped = {"dy", "dx"},
                                 sigma = {"sigma"}, absent = {"dx", "depth"};
  const auto path = folder.Put("truth.exr", EncodeExr(truth, 32, names));
  EXPECT_TRUE(SameBits(ReadChannels(path, names), truth));
  EXPECT_EQ(ReadChannels(path, tilt).at<cv::Vec2f>(2, 4)[1], truth.at<cv::Vec3f>(2, 4)[1]);
  EXPECT_EQ(ReadChannels(path, swapped).at<cv::Vec2f>(2, 4)[1], truth.at<cv::Vec3f>(2, 4)[0]);
  EXPECT_EQ(ReadChannels(path, sigma).at<float>(0, 0), truth.at<cv::Vec3f>(0, 0)[2]);
  EXPECT_TRUE(ReadChannels(path, absent).empty());
}

TEST(ImageIo, GreyAsRgbStaysRgb) {
  const TempFolder folder;
  const cv::Mat grey(3, 3, CV_32FC3, cv::Scalar(0.2, 0.2, 0.2));
  EXPECT_EQ(ReadImage(folder.Put("x.png", EncodePng(grey, 8))).pixels.type(), CV_32FC3);
}

TEST(ImageIo, TheOrientationTagIsObeyed) {
  const TempFolder folder;
  // 2 wide, 3 high; as seen when upright:  1 2 / 3 4 / 5 6. Stored as orientation n says (TIFF 6.0, tag 274).
  const std::vector<std::pair<int, std::vector<uint8_t>>> stored = {
      {1, {1, 2, 3, 4, 5, 6}}, {2, {2, 1, 4, 3, 6, 5}}, {3, {6, 5, 4, 3, 2, 1}}, {4, {5, 6, 3, 4, 1, 2}},
      {5, {1, 3, 5, 2, 4, 6}}, {6, {2, 4, 6, 1, 3, 5}}, {7, {6, 4, 2, 5, 3, 1}}, {8, {5, 3, 1, 6, 4, 2}}};
  for (const auto& [orientation, samples] : stored) {
    const bool turned = orientation >= 5;
    OIIO::ImageSpec spec(turned ? 3 : 2, turned ? 2 : 3, 1, OIIO::TypeUInt8);
    spec["Orientation"] = orientation;
    const cv::Mat upright = ReadImage(PutWithOiio(folder, "turned.tif", spec, samples.data())).pixels * 255;
    const cv::Mat seen = (cv::Mat_<float>(3, 2) << 1, 2, 3, 4, 5, 6);
    EXPECT_LT(cv::norm(upright, seen, cv::NORM_INF), 1e-5) << orientation;  // rounding of / 255 * 255
  }
}

TEST(ImageIo, TheSameBytesAgain) {
  const cv::Mat image = RandomImage({40, 30}, 3, 3);
  const auto encode_all = [&] {
    std::vector<std::vector<uint8_t>> files;
    for (const Encoding encoding : kEncodings) files.push_back(EncodeImage(image, encoding));
    return files;
  };
  const auto first = encode_all();
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // a time of day in a file has seconds
  EXPECT_EQ(encode_all(), first);
}

// Half floats always; floats where it helps: planes of one value, and values of 8 bits, but not noise.
TEST(ImageIo, ExrIsCompressedByZipsWhereItHelps) {
  const TempFolder folder;
  const auto compression_of = [&](const cv::Mat& image, int bits) {
    const auto path = folder.Put("x.exr", EncodeImage(image, {FileFormat::kExr, bits}));
    EXPECT_TRUE(SameBits(ReadImage(path).pixels, Quantise(image, {FileFormat::kExr, bits})));
    const auto input = OIIO::ImageInput::open(path.string());
    EXPECT_EQ(input->spec().format, bits == 16 ? OIIO::TypeHalf : OIIO::TypeFloat);
    return input->spec().get_string_attribute("compression");
  };
  for (const cv::Size size : {cv::Size(64, 1), cv::Size(40, 15), cv::Size(50, 200)}) {
    const cv::Mat noise = RandomImage(size, 3, 4);
    cv::Mat one_plane = noise.clone(), few_levels;
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) one_plane.at<cv::Vec3f>(y, x)[1] = 0;
    noise.convertTo(few_levels, CV_8U, 10);
    few_levels.convertTo(few_levels, CV_32F, 1 / 255.0);
    EXPECT_EQ(compression_of(noise, 16), "zips") << size;
    EXPECT_EQ(compression_of(noise, 32), "none") << size;
    EXPECT_EQ(compression_of(one_plane, 32), "zips") << size;
    EXPECT_EQ(compression_of(few_levels, 32), "zips") << size;
  }
}

// Samples need not be made of floats: those of a PNG are written as they are, also from within a larger
// picture.
TEST(ImageIo, WritesAPngsOwnSamples) {
  for (const Encoding& encoding : kEncodings) {
    if (encoding.format != FileFormat::kPng) continue;
    const cv::Mat samples = ToSamples(RandomImage({21, 13}, 3, 5), encoding);
    for (const cv::Mat& part : {samples, cv::Mat(samples(cv::Rect(3, 2, 9, 7)))}) {
      EXPECT_EQ(EncodeImage(part, encoding), EncodeImage(FromSamples(part), encoding));
      EXPECT_EQ(PixelHash(part, encoding), PixelHash(FromSamples(part), encoding));
    }
  }
}

// Also from a part of a larger picture, whose rows are not side by side. Full-colour detail survives, as it would not
// with colour at half the resolution.
TEST(ImageIo, JpegsForPeopleLookLikeThePicture) {
  const TempFolder folder;
  cv::Mat sheet(40, 60, CV_8UC3, cv::Scalar(200, 30, 60));
  for (int x = 0; x < sheet.cols; x += 2) sheet.col(x).setTo(cv::Scalar(60, 30, 200));
  const cv::Mat part = sheet(cv::Rect(3, 5, 33, 21));
  const std::vector<uint8_t> bytes = EncodeJpeg(part, 90);
  EXPECT_EQ(bytes, EncodeJpeg(part, 90));
  const Picture picture = ReadImage(folder.Put("a.jpg", bytes));
  cv::Mat expected;
  part.convertTo(expected, CV_32F, 1 / 255.0);
  ASSERT_EQ(picture.pixels.size(), part.size());
  EXPECT_LT(cv::norm(picture.pixels, expected, cv::NORM_L1) / double(part.total() * 3), 4 / 255.0);
  EXPECT_THROW(EncodeJpeg(expected, 90), std::invalid_argument);
  EXPECT_THROW(EncodeJpeg(part, 0), std::invalid_argument);
}

TEST(ImageIo, FromWithinALargerPicture) {
  const cv::Mat part = RandomImage({21, 13}, 3, 6)(cv::Rect(3, 2, 9, 7));
  ASSERT_FALSE(part.isContinuous());
  for (const Encoding encoding : kEncodings)
    EXPECT_EQ(EncodeImage(part, encoding), EncodeImage(part.clone(), encoding)) << Extension(encoding.format);
}

TEST(ImageIo, WrongArguments) {
  const cv::Mat image = RandomImage({2, 2}, 3, 5), two = RandomImage({2, 2}, 2, 5);
  const std::vector<std::string> names = {"R", "G"};
  EXPECT_THROW(EncodePng(image, 12), std::invalid_argument);
  EXPECT_THROW(EncodePng(image, 32), std::invalid_argument);
  EXPECT_THROW(EncodePng(two, 8, PngWriter::kOpenImageIo), std::invalid_argument);
  EXPECT_THROW(EncodePng(RandomImage({2, 2}, 5, 5), 8), std::invalid_argument);
  EXPECT_THROW(EncodePng(cv::Mat(), 8), std::invalid_argument);
  EXPECT_THROW(EncodePng(cv::Mat(2, 2, CV_8UC3), 16), std::invalid_argument);
  EXPECT_THROW(EncodePng(cv::Mat(2, 2, CV_16UC3), 8), std::invalid_argument);
  EXPECT_THROW(EncodeExr(cv::Mat(2, 2, CV_16UC2), 16, names), std::invalid_argument);
  EXPECT_THROW(EncodeExr(image, 8, names), std::invalid_argument);
  EXPECT_THROW(EncodeExr(image, 32, names), std::invalid_argument);
}

// As of a file in a tar, where there is no file of that name.
TEST(ReadImage, TakesBytesThatAreInMemory) {
  for (const Encoding encoding : {Encoding{FileFormat::kPng, 8}, Encoding{FileFormat::kExr, 16}}) {
    const cv::Mat image = RandomImage({9, 4}, 3, 1);
    const std::string name = std::string("nowhere/a.tar/picture.") + Extension(encoding.format);
    const std::vector<uint8_t> bytes = EncodeImage(image, encoding);
    EXPECT_TRUE(SameBits(ReadImage(name, bytes).pixels, Quantise(image, encoding)));
    EXPECT_TRUE(SameBits(StoredSamples(name, bytes), ToSamples(image, encoding)));
    const auto half = std::span(bytes).first(bytes.size() / 2);
    EXPECT_TRUE(Contains(ErrorOf<std::runtime_error>([&] { ReadImage(name, half); }), name));
    EXPECT_TRUE(Contains(ErrorOf<std::runtime_error>([&] { StoredSamples(name, half); }), name));
  }
}

TEST(StoredSamples, AreWhatWasEncoded) {
  const TempFolder folder;
  for (const Encoding encoding : {Encoding{FileFormat::kPng, 8}, Encoding{FileFormat::kPng, 16},
                                  Encoding{FileFormat::kExr, 16}, Encoding{FileFormat::kExr, 32}})
    for (const int channels : {1, 3}) {
      const cv::Mat image = RandomImage({9, 4}, channels, 1);
      const auto path =
          folder.Put(std::string("a.") + Extension(encoding.format), EncodeImage(image, encoding));
      EXPECT_TRUE(SameBits(StoredSamples(path), ToSamples(image, encoding)));
    }
}

}  // namespace
}  // namespace shimmer::dataset
