"""What the pages take for granted in the reader's folder: photographs in photos/ and a video, road.mp4."""

import shutil
import subprocess
import tempfile

WIDTH, HEIGHT, FRAMES = 160, 120, 24


def make(folder, program):
    photographs(folder / "photos", program)
    video(folder / "road.mp4")


def photographs(photos, program):
    """Drawn scenes stand for them: clean frames of clips without tilt or blur."""
    photos.mkdir()
    with tempfile.TemporaryDirectory(prefix="shimmer-docs-") as name:
        command = [program, "generate", photos.parent / "configs/demo_drawn.json", "--out", f"{name}/set", "--quiet"]
        for value in ("clips=5", "frames=1", "size=[520,400]", "tilt.strength_px=0", "blur.max_sigma_px=0"):
            command += ["--set", value]
        subprocess.run(command, check=True)
        for clip in range(5):
            shutil.copy(f"{name}/set/clips/{clip:06}/clean/0000.png", photos / f"photo{clip}.png")


def video(path):
    """A ramp of grey that moves 3 px a frame: raw YUV4MPEG2, which FFmpeg knows by its content, whatever its name."""
    chroma = bytes([128]) * (WIDTH * HEIGHT // 2)
    with open(path, "wb") as file:
        file.write(b"YUV4MPEG2 W%d H%d F25:1 Ip A1:1 C420\n" % (WIDTH, HEIGHT))
        for frame in range(FRAMES):
            row = bytes(16 + (x + 3 * frame) % 220 for x in range(WIDTH))
            file.write(b"FRAME\n" + row * HEIGHT + chroma)
