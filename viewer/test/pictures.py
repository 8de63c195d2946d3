"""Puts the screenshots of pictures.mjs into docs/figures: phones side by side, frames as a GIF."""

import pathlib
import sys

from PIL import Image

taken, figures = map(pathlib.Path, sys.argv[1:])


def save(image, name):
    image.convert("RGB").save(figures / name, optimize=True)
    print(f"docs/figures/{name}: {(figures / name).stat().st_size / 1e3:.0f} kB")


for name in ("report-disc.png", "report-friction-dark.png", "report-ball.png", "report-contact-zone.png", "report-pair.png", "report-study.png"):
    save(Image.open(taken / name), name)
light, dark = (Image.open(taken / f"phone-{theme}.png") for theme in ("light", "dark"))
both = Image.new("RGB", (light.width + dark.width + 20, light.height), "white")
both.paste(light, (0, 0))
both.paste(dark, (light.width + 20, 0))
save(both, "report-phone.png")

frames = [Image.open(path).convert("RGB") for path in sorted((taken / "frames").iterdir())]
# One palette for all frames, from six of them side by side.
sample = Image.new("RGB", (frames[0].width, 6 * frames[0].height))
for k in range(6):
    sample.paste(frames[k * (len(frames) - 1) // 5], (0, k * frames[0].height))
palette = sample.quantize(64)
small = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
small[0].save(figures / "disc.gif", save_all=True, append_images=small[1:], duration=90, loop=0, optimize=True)
print(f"docs/figures/disc.gif: {(figures / 'disc.gif').stat().st_size / 1e3:.0f} kB")
