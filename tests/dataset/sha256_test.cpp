#include "sim/dataset/sha256.h"

#include "tests/dataset/temp_folder.h"

namespace shimmer::dataset {
namespace {

// FIPS 180-4 examples.
constexpr const char* kOfNothing = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";
constexpr const char* kOfAbc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";

TEST(Sha256, KnownVectors) {
  EXPECT_EQ(Sha256Hex({}), kOfNothing);
  EXPECT_EQ(Sha256Hex(AsBytes("abc")), kOfAbc);
  EXPECT_EQ(Sha256Hex(AsBytes(std::string(1000000, 'a'))),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, PiecesAreAsTheWhole) {
  Sha256 hash;
  hash.Add(AsBytes("a"));
  hash.Add({});
  hash.Add(AsBytes("bc"));
  EXPECT_EQ(hash.Hex(), kOfAbc);
}

TEST(Sha256, OfAFile) {
  const TempFolder folder;
  EXPECT_EQ(Sha256HexOfFile(folder.Put("abc", "abc")), kOfAbc);
  EXPECT_EQ(Sha256HexOfFile(folder.Put("nothing", "")), kOfNothing);
  const std::string long_text(1000000, 'a');  // more than is read at once
  EXPECT_EQ(Sha256HexOfFile(folder.Put("long", long_text)), Sha256Hex(AsBytes(long_text)));
}

TEST(Sha256, AFileThatIsNotThere) {
  const TempFolder folder;
  EXPECT_TRUE(Contains(ErrorOf<std::runtime_error>([&] { Sha256HexOfFile(folder / "no"); }), "No such file"));
  EXPECT_TRUE(
      Contains(ErrorOf<std::runtime_error>([&] { Sha256HexOfFile(folder.path()); }), "Is a directory"));
}

}  // namespace
}  // namespace shimmer::dataset
