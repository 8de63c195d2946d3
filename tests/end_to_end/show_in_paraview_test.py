"""show_in_paraview.py, as far as possible without ParaView: it compiles, finds the files of runs, and reports errors.
If ParaView (pvbatch) is installed with a display (xvfb-run), it draws runs of both formats."""

import importlib.util
import os
import shutil
import subprocess
import types
import unittest

from harness import DISC, SOURCE, TestCase

SCRIPT = SOURCE / "apps" / "ricochet" / "show_in_paraview.py"
SHORT = {"time.end": 0.02, "output.fields_every": 20}


def load():
    spec = importlib.util.spec_from_file_location("show_in_paraview", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class ShowInParaView(TestCase):
    def test_files_of_runs(self):
        script = load()
        for form, names in (("xdmf", ("results.xdmf", "obstacles.xdmf")), ("vtkhdf", ("results.vtkhdf", "obstacles.vtkhdf"))):
            output = self.simulate(DISC, form, {**SHORT, "output.format": form})
            self.assertEqual([os.path.basename(path) for path in script.find_files(str(output))], list(names))
            (output / names[1]).unlink()
            self.assertEqual(script.find_files(str(output))[1], None)
        with self.assertRaisesRegex(script.Problem, "neither results.xdmf nor results.vtkhdf"):
            script.find_files(str(self.folder))

    def test_which_run(self):
        """The named directory, else that of the selected file, else that of the environment."""
        script = load()

        def selected(**properties):
            return types.SimpleNamespace(GetActiveSource=lambda: types.SimpleNamespace(**properties) if properties else None)

        self.assertEqual(script.directory_of_run(selected(), ["out/a"]), "out/a")
        self.assertEqual(script.directory_of_run(selected(FileNames=["/b/results.xdmf"]), []), "/b")
        self.assertEqual(script.directory_of_run(selected(FileName=["/c/results.vtkhdf"]), []), "/c")
        os.environ.pop("RICOCHET_RUN", None)
        for wrong in (selected(), selected(FileName="/c/other.vtkhdf"), selected(Input=3)):
            with self.assertRaisesRegex(script.Problem, "no run is selected"):
                script.directory_of_run(wrong, [])
        os.environ["RICOCHET_RUN"] = "/d"
        self.addCleanup(os.environ.pop, "RICOCHET_RUN")
        self.assertEqual(script.directory_of_run(selected(FileName="/c/other.vtkhdf"), []), "/d")

    @unittest.skipUnless(shutil.which("pvbatch") and shutil.which("xvfb-run") and importlib.util.find_spec("paraview"),
                         "ParaView (paraview, python3-paraview, xvfb) is not installed")
    def test_pictures(self):
        for form in ("xdmf", "vtkhdf"):
            output = self.simulate(DISC, form, {**SHORT, "output.format": form})
            picture = self.folder / f"{form}.png"
            done = subprocess.run(["xvfb-run", "-a", "pvbatch", SCRIPT, output, picture, "0.01"], text=True, check=True,
                                  capture_output=True, timeout=300)
            self.assertIn("von_mises: from", done.stdout)
            self.assertGreater(picture.stat().st_size, 10_000)
        done = subprocess.run(["xvfb-run", "-a", "pvbatch", SCRIPT, self.folder], text=True, check=False, capture_output=True,
                              timeout=300)
        self.assertIn("neither results.xdmf nor", done.stdout + done.stderr)
