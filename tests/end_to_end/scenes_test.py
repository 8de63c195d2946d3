"""Some of the random scenes of ./dev bench scenes, judged as there, and faults that it must find."""

import os
import pathlib
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ["RICOCHET_SOURCE_DIR"])
sys.path.insert(0, str(SOURCE / "bench" / "scenes"))

import run as scenes  # noqa: E402
import energy  # noqa: E402
import properties  # noqa: E402
from draw import FAMILIES, scene_of  # noqa: E402
from history import deviations  # noqa: E402
from quantities import Frame  # noqa: E402

# One of each family, with a rotating obstacle, a pair and finite strain among them.
SEEDS = (6001, 6004, 6005, 6006, 6009, 6011, 6036)
PAIR_WHOSE_FACETS_ARE_RENUMBERED = 6110
STICKS_TO_A_TURNING_OBSTACLE = 6044


class Scenes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="ricochet-scenes-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def examine(self, seed, wanted=None):
        _, base, touches, found, names, _ = scenes.examine(seed, self.folder / str(seed), wanted)
        self.assertEqual(found, [], f"scene {seed}")
        self.assertEqual(base.status, 0, base.error())
        self.assertTrue(touches)
        return names

    def test_seeds_draw_what_their_names_say(self):
        """A new kind of obstacle or law changes what a seed draws: take other seeds then."""
        scenes_of_seeds = [scene_of(seed) for seed in SEEDS]
        self.assertEqual({scene.family for scene in scenes_of_seeds}, set(FAMILIES))
        self.assertTrue(any("rotation" in obstacle.keys for scene in scenes_of_seeds for obstacle in scene.obstacles()))
        self.assertTrue(any("law" in scene.section("material").keys for scene in scenes_of_seeds))
        pair = scene_of(PAIR_WHOSE_FACETS_ARE_RENUMBERED)
        self.assertEqual((pair.family, pair.section("material").keys["law"]), ("pair", "neo-hookean"))
        turning = scene_of(STICKS_TO_A_TURNING_OBSTACLE)
        [obstacle] = turning.obstacles()
        self.assertEqual((obstacle.keys["type"], "rotation" in obstacle.keys), ("torus", True))
        self.assertGreater(turning.section("contact").keys["friction"], 0.0)

    def test_observers_descriptions_and_accounts_agree(self):
        for seed in SEEDS:
            self.assertGreater(len(self.examine(seed)), 2)

    # Directions of pairs at finite strain were fitted with edges of the facet that came first in the file: 2e-5 of the
    # forces.
    def test_the_order_of_facets_says_nothing(self):
        self.assertEqual(self.examine(PAIR_WHOSE_FACETS_ARE_RENUMBERED, ["renumbered"]), ["renumbered"])

    def test_what_sticks_to_a_turning_obstacle_does_no_work(self):
        self.examine(STICKS_TO_A_TURNING_OBSTACLE, ["heavy"])

    def test_faults_are_found(self):
        scene = scene_of(STICKS_TO_A_TURNING_OBSTACLE)
        twins = properties.Twins(scene, scenes.PROGRAM, self.folder)
        run, scale = twins.base, twins.base.energy_scale()
        self.assertEqual(energy.findings(scene, run), [])
        # A rise in a column that can only fall, in one row and all that follow.
        for column, expected in (("friction_work", "friction work"), ("contact_work", "contact work"), ("total_energy", "account")):
            kept = list(run.columns[column])
            run.columns[column] = [v + (scale if k > len(kept) // 2 else 0.0) for k, v in enumerate(kept)]
            self.assertIn(expected, [name for name, _, _ in energy.findings(scene, run)])
            run.columns[column] = kept
        # An observer whose frame is rotated slightly more than the scene.
        d, small = scene.dimension, 1e-3
        rows = [[float(i == j) for j in range(d)] for i in range(d)]
        rows[0][1], rows[1][0] = -small, small
        _, (worst, _) = deviations(scene, run, run, Frame(tuple(map(tuple, rows)), (0.0,) * d))
        self.assertGreater(worst, 1e-4)


if __name__ == "__main__":
    unittest.main()
