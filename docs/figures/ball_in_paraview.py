"""The picture of the ball in ParaView: pvbatch docs/figures/ball_in_paraview.py RESULTS.xdmf PICTURE.png [FRAME]
(Debian: python3-paraview; without a display: xvfb-run)."""

import sys

from paraview.simple import *

results, picture = sys.argv[1:3]
reader = XDMFReader(FileNames=[results])
frame = int(sys.argv[3]) if len(sys.argv) > 3 else len(reader.TimestepValues) // 3
time = reader.TimestepValues[frame]
reader.UpdatePipeline(time)

view = GetActiveViewOrCreate("RenderView")
view.ViewSize = [1100, 700]
view.ViewTime = time
view.UseColorPaletteForBackground = 0
view.Background = [1, 1, 1]
view.OrientationAxesVisibility = 0

obstacles = ExtractBlock(Input=reader, Selectors=["/Root/obstacles"])
obstacles.UpdatePipeline(time)
surface = MergeBlocks(Input=obstacles)
surface.UpdatePipeline(time)
shown = Show(surface, view)
ColorBy(shown, None)
shown.DiffuseColor = shown.AmbientColor = [0.9, 0.9, 0.88]
shown.Ambient = 0.4

block = ExtractBlock(Input=reader, Selectors=["/Root/body"])
block.UpdatePipeline(time)
body = MergeBlocks(Input=block)
body.UpdatePipeline(time)
moved = WarpByVector(Input=body, Vectors=["POINTS", "displacement"])
moved.UpdatePipeline(time)
clip = Clip(Input=moved)
clip.ClipType = "Plane"
clip.ClipType.Normal = [0, 1, 0]
clip.Invert = 0
clip.UpdatePipeline(time)
shown = Show(clip, view)
shown.Representation = "Surface"
shown.Ambient = 0.35
ColorBy(shown, ("POINTS", "nodal_von_mises"))
shown.RescaleTransferFunctionToDataRange(False, True)
shown.SetScalarBarVisibility(view, True)
bar = GetScalarBar(GetColorTransferFunction("nodal_von_mises"), view)
bar.Title, bar.ComponentTitle = "von Mises stress", ""
bar.TitleColor = bar.LabelColor = [0, 0, 0]
bar.WindowLocation = "Any Location"
bar.Position = [0.84, 0.25]
bar.ScalarBarLength = 0.5

Render(view)
bounds = clip.GetDataInformation().GetBounds()
size = bounds[1] - bounds[0]
view.CameraFocalPoint = [0.5 * (bounds[0] + bounds[1]), 0, 0.5 * (bounds[4] + bounds[5])]
view.CameraPosition = [0.75 * size, -2.9 * size, 1.1 * size]
view.CameraViewUp = [0, 0, 1]
Render(view)
SaveScreenshot(picture, view)
