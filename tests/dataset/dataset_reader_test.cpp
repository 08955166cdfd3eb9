#include "sim/dataset/dataset_reader.h"

#include "sim/dataset/pixel_hash.h"
#include "tests/dataset/small_set.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kTilt = {"dx", "dy"}, kSigma = {"sigma"}, kBoth = {"dx", "dy", "sigma"};

struct Frame {
  cv::Mat turb, clean, truth;
};

// A clip of real pictures. still: one clean file. truth_channels empty: no truth.
std::vector<Frame> WriteClip(DatasetWriter& writer, const Layout& layout, int64_t clip, int frames,
                             bool still, const std::vector<std::string>& truth_channels,
                             Encoding encoding = {}) {
  std::vector<Frame> written;
  std::vector<ClipFile> files;
  for (int t = 0; t < frames; ++t) {
    const auto seed = static_cast<uint32_t>(clip * 1000 + t);
    Frame frame{RandomImage({7, 5}, 3, seed), RandomImage({7, 5}, 3, still ? 9 : seed + 500), {}};
    files.push_back({layout.Path(FrameKind::kTurb, clip, t), EncodeImage(frame.turb, encoding),
                     PixelHash(frame.turb, encoding)});
    if (t == 0 || !still)
      files.push_back({layout.Path(FrameKind::kClean, clip, t), EncodeImage(frame.clean, encoding),
                       PixelHash(frame.clean, encoding)});
    if (!truth_channels.empty()) {
      frame.truth = RandomImage({7, 5}, static_cast<int>(truth_channels.size()), seed, -8, 8);
      files.push_back({layout.Path(FrameKind::kTruth, clip, t), EncodeExr(frame.truth, 32, truth_channels),
                       PixelHash(frame.truth, {FileFormat::kExr, 32})});
    }
    written.push_back({Quantise(frame.turb, encoding), Quantise(frame.clean, encoding), frame.truth});
  }
  CommitNow(writer, clip, files, {{"note", clip}});
  return written;
}

TEST(DatasetReader, ReadsBothLayoutsBack) {
  for (const Layout& layout : {Sequence(), Pairs()}) {
    const TempFolder folder;
    DatasetWriter writer(folder.path(), layout, Description());
    const auto first = WriteClip(writer, layout, 0, 2, /*still=*/false, kBoth);
    const auto second = WriteClip(writer, layout, 1, 2, false, {});
    FailNow(writer, 2, {{"error", "bad source"}});

    const DatasetReader reader(folder.path());  // while it is being written
    EXPECT_EQ(reader.description(), Description());
    EXPECT_EQ(reader.clips(), (std::set<int64_t>{0, 1}));
    EXPECT_EQ(reader.failed(), std::set<int64_t>{2});
    EXPECT_EQ(reader.Line(1)["note"], 1);
    EXPECT_EQ(reader.Line(2)["error"], "bad source");
    EXPECT_EQ(reader.FrameCount(0), 2);
    for (int t = 0; t < 2; ++t) {
      EXPECT_TRUE(SameBits(reader.Turb(0, t).pixels, first[t].turb));
      EXPECT_TRUE(SameBits(reader.Clean(0, t).pixels, first[t].clean));
      EXPECT_TRUE(SameBits(reader.Turb(1, t).pixels, second[t].turb));
      const cv::Mat tilt = reader.TruthTilt(0, t).value(), sigma = reader.TruthSigma(0, t).value();
      ASSERT_EQ(tilt.type(), CV_32FC2);
      ASSERT_EQ(sigma.type(), CV_32FC1);
      const cv::Vec3f truth = first[t].truth.at<cv::Vec3f>(4, 6);
      EXPECT_EQ(tilt.at<cv::Vec2f>(4, 6), cv::Vec2f(truth[0], truth[1]));
      EXPECT_EQ(sigma.at<float>(4, 6), truth[2]);
      EXPECT_FALSE(reader.TruthTilt(1, t));
      EXPECT_FALSE(reader.TruthSigma(1, t));
    }
  }
}

TEST(DatasetReader, OneCleanFileForAllFrames) {
  const TempFolder folder;
  DatasetWriter writer(folder.path(), Sequence(), Description());
  const auto frames = WriteClip(writer, Sequence(), 0, 3, /*still=*/true, kTilt, {FileFormat::kPng, 16});
  const DatasetReader reader(folder.path());
  EXPECT_EQ(reader.Files(0).clean.size(), 1u);
  EXPECT_TRUE(SameBits(reader.Clean(0, 2).pixels, frames[0].clean));
  EXPECT_TRUE(reader.TruthTilt(0, 2));
  EXPECT_FALSE(reader.TruthSigma(0, 2));
  EXPECT_THROW(reader.Clean(0, 3), std::invalid_argument);
}

TEST(DatasetReader, SigmaAlone) {
  const TempFolder folder;
  DatasetWriter writer(folder.path(), Sequence(), Description());
  const auto frames = WriteClip(writer, Sequence(), 0, 1, true, kSigma);
  const DatasetReader reader(folder.path());
  EXPECT_FALSE(reader.TruthTilt(0, 0));
  EXPECT_TRUE(SameBits(reader.TruthSigma(0, 0).value(), frames[0].truth));
}

TEST(DatasetReader, FramesAreInTheOrderOfTheirNumbers) {
  const TempFolder folder;
  DatasetWriter writer(folder.path(), Sequence(), Description());
  std::vector<ClipFile> files;
  for (const int64_t frame : {10001, 2, 9999, 10000})
    files.push_back({Sequence().Path(FrameKind::kTurb, 0, frame), {1}, ""});
  CommitNow(writer, 0, files, {});
  std::vector<std::string> names;
  for (const StoredFile& file : DatasetReader(folder.path()).Files(0).turb) names.push_back(file.name());
  EXPECT_EQ(names, (std::vector<std::string>{"clips/000000/turb/0002.png", "clips/000000/turb/9999.png",
                                             "clips/000000/turb/10000.png", "clips/000000/turb/10001.png"}));
}

TEST(DatasetReader, WhatIsMissing) {
  const TempFolder folder;
  EXPECT_TRUE(
      Contains(ErrorOf<std::runtime_error>([&] { DatasetReader reader(folder.path()); }), "not a data set"));
  EXPECT_TRUE(
      Contains(ErrorOf<std::runtime_error>([&] { DatasetReader reader(folder / "no"); }), "not a data set"));
  {
    DatasetWriter writer(folder.path(), Sequence(), Description());
    WriteClip(writer, Sequence(), 0, 2, false, kBoth);
  }
  fs::remove(folder / "clips/000000/turb/0001.png");
  const DatasetReader reader(folder.path());
  EXPECT_NO_THROW(reader.Turb(0, 0));
  const std::string error = ErrorOf<std::runtime_error>([&] { reader.Turb(0, 1); });
  EXPECT_TRUE(Contains(error, (folder / "clips/000000/turb/0001.png").string() + ": no such file")) << error;
  EXPECT_THROW(reader.Turb(0, 2), std::invalid_argument);
  EXPECT_THROW(reader.Turb(0, -1), std::invalid_argument);
  EXPECT_THROW(reader.Turb(1, 0), std::invalid_argument);
  folder.Put("dataset.json", "[");
  EXPECT_TRUE(Contains(ErrorOf<std::runtime_error>([&] { DatasetReader again(folder.path()); }), "damaged"));
}

TEST(DatasetReader, DamagedDescription) {
  for (const char* text :
       {"", "7", "{}", "{\"config\":5}", "{\"config\":{},\"sources\":{}}", "{\"config\":{}"}) {
    const TempFolder folder;
    folder.Put("dataset.json", text);
    EXPECT_TRUE(
        Contains(ErrorOf<std::runtime_error>([&] { DatasetReader(folder.path()); }), "dataset.json: damaged"))
        << text;
  }
}

TEST(DatasetReader, DamagedManifestLines) {
  const TempFolder folder;
  folder.Put("dataset.json", "{\"config\":{}}");
  folder.Put("manifest.jsonl", "{\"clip\":0,\"status\":\"done\",\"files\":[{\"path\":7}]}\n");
  const DatasetReader reader(folder.path());
  EXPECT_TRUE(Contains(ErrorOf<std::runtime_error>([&] { reader.Files(0); }), "must have a path"));
}

}  // namespace
}  // namespace shimmer::dataset
