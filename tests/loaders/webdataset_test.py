#!/usr/bin/python3
"""Layout webdataset, read by the rules of webdataset and wids (webdataset/webdataset).

webdataset reads a tar from its start: names that begin with two underscores and end with two are skipped; a name's key
is all up to the first dot after its last slash, the rest (in small letters) its extension; files that follow each
other with one key are one sample, in which no extension comes twice. wids reads the index, {"wids_version": 1,
"shardlist": [{"url", "nsamples"}]} with urls relative to the index, and finds members by their 512-byte headers: name
in the first 100 bytes, size in octal.

  webdataset_test.py SHIMMER
"""

import json
import re
import sys
import tarfile

sys.dont_write_bytecode = True

import sets


def webdataset_samples(path):
    """Samples of a tar: [{"__key__": "000123", "turb.0000.png": bytes, ...}]."""
    samples = []
    with tarfile.open(path, "r|") as stream:
        for member in stream:
            if not member.isreg() or re.match(r"__[^/]*__($|/)", member.name):
                continue
            found = re.match(r"^((?:.*/|)[^.]+)[.]([^/]*)$", member.name)
            if not found:
                continue
            key, extension = found[1], found[2].lower()
            if not samples or samples[-1]["__key__"] != key:
                samples.append({"__key__": key})
            assert extension not in samples[-1], f"{member.name} comes twice"
            samples[-1][extension] = stream.extractfile(member).read()
    return samples


def wids_members(path):
    """Members of a tar as wids' memory-mapped reader finds them: [(name, offset of the data, bytes)]."""
    data, at, members = path.read_bytes(), 0, []
    while at < len(data):
        header = data[at:at + 500]
        name, size, kind = header[:100].decode().strip("\0"), header[124:136].decode(), header[156:157].strip(b"\0")
        if not size.strip("\0"):
            break
        if name and name != "././@PaxHeader" and kind in (b"0", b""):
            members.append((name, at + 512, int(size[:-1], 8)))
        at += 512 + (int(size.strip("\0"), 8) + 511) // 512 * 512
    return members


def decoded(data):
    """A PNG's samples, [y][x][r, g, b]."""
    import cv2
    import numpy
    return cv2.imdecode(numpy.frombuffer(data, numpy.uint8), cv2.IMREAD_UNCHANGED)[:, :, ::-1]


class WebDataset(sets.SetsTest):
    def shards(self, folder):
        index = json.loads((folder / "shards/index.json").read_text())
        self.assertEqual(index["wids_version"], 1)
        return [(folder / "shards" / shard["url"], shard) for shard in index["shardlist"]]

    def test_a_sample_is_a_clip_with_its_pixels(self):
        folder = self.make("set", "webdataset", self.moving_source(3), clips=5)
        lines = sets.lines_of(folder)
        samples = [sample for path, _ in self.shards(folder) for sample in webdataset_samples(path)]
        self.assertEqual([sample["__key__"] for sample in samples], [f"{clip:06}" for clip in range(5)])
        for clip, sample in enumerate(samples):
            kinds = ("turb.%04d.png", "clean.%04d.png", "truth.%04d.exr")
            self.assertEqual(set(sample), {"__key__", "json"} | {kind % k for kind in kinds for k in range(3)})
            for kind in ("turb", "clean"):
                for k, file in enumerate(sets.files_of(lines[clip], kind)):
                    self.assertEqual(sets.pixel_hash(decoded(sample[f"{kind}.{k:04}.png"])), file["pixels"])
            told = json.loads(sample["json"])
            self.assertEqual(told, {key: value for key, value in lines[clip].items() if key != "files"})

    def test_a_still_clip_has_one_clean_frame(self):
        folder = self.make("set", "webdataset", clips=2)
        sample = webdataset_samples(self.shards(folder)[0][0])[1]
        self.assertEqual([key for key in sample if key.startswith("clean")], ["clean.0000.png"])

    def test_the_index_tells_each_shard(self):
        folder = self.make("set", "webdataset", clips=5, frames=2, size=[256, 256], output_truth=[], output_tar_mb=1)
        shards = self.shards(folder)
        self.assertGreater(len(shards), 1)
        self.assertEqual(sorted(path for path, _ in shards), sorted((folder / "shards").glob("*.tar")))
        for path, shard in shards:
            self.assertEqual(shard["nsamples"], len(webdataset_samples(path)))
            self.assertEqual(shard["filesize"], path.stat().st_size)
            self.assertNotIn("/", shard["url"])

    def test_the_manifest_and_wids_find_the_same_bytes(self):
        folder = self.make("set", "webdataset", clips=3, size=[256, 256], output_tar_mb=1)
        named = {(file["path"], file["member"], file["offset"], file["bytes"])
                 for line in sets.lines_of(folder).values() for file in line["files"]}
        found = {(str(path.relative_to(folder)), *member) for path, _ in self.shards(folder)
                 for member in wids_members(path)}
        self.assertEqual(named, found)


if __name__ == "__main__":
    sets.main("cv2")
