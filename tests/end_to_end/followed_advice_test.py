"""Advice is tested: where a message advises a setting, the setting is taken on the case that made it, and the message is gone.

Every message in the sources that advises a setting (advising_messages.py) is in one of three tables below: TRIED, whose advice is
followed here; ELSEWHERE, where another test does that; UNTRIED, which is to become shorter. A new one belongs in TRIED."""

import re
import unittest

from advising_messages import advising_messages
from harness import MESHES, SOURCE, TestCase, block_case, body_case, gravity, run, settings

BLOCK = (block_case().replace("[[material]]", "refine = 2\n[[material]]", 1)
         .replace('scheme = "newmark"\npreset = "trapezoidal"', 'scheme = "midpoint"'))
PLANE = 'type = "plane"\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]'
BALL = BLOCK.replace(PLANE, 'type = "sphere"\ncentre = [0.5, -2.0]\nradius = 2.0')
PRESSED = BLOCK + '[[pressure]]\ngroup = "sides"\nvalue = "1"\n'
JERKED = BLOCK + '[[support]]\ngroup = "sides"\ncomponents = ["x"]\nvalue = "-0.01*min(t/0.1, 1)"\n'
HELD = BLOCK + '[[support]]\ngroup = "sides"\ncomponents = ["y"]\n'
CURVED = BLOCK.replace("quadrilateral_o1", "disc_o2").replace("refine = 2\n", "").replace('"bottom"', '"boundary"')
SOLID = body_case(MESHES / "tetrahedron_o1_msh41_ascii.msh", [0.0, 0.0, -9.0], [0.0, 0.0, 1.0], gravity(0.0, 0.0, -10.0),
                  scheme="reduced-kane", mass="equivalent")
PARALLELOGRAM = MESHES / "quadrilateral_o1_msh41_ascii.msh"
PAIR = f"""[part.one]
file = "{PARALLELOGRAM}"
refine = 2
[part.two]
file = "{PARALLELOGRAM}"
refine = 1
move = [0.0, 1.2]
[[material]]
group = "one.all"
density = 1.0
young = 100.0
poisson = 0.3
[[material]]
group = "two.all"
density = 1.0
young = 100.0
poisson = 0.3
[[contact]]
group = "two.bottom"
against = "one.boundary"
multipliers = "p1"
[[support]]
group = "one.bottom"
components = ["x", "y"]
[time]
step = 1e-3
end = 0.1
"""
# None takes a key out again.
KANE = {"time.scheme": "reduced-kane", "mass.type": "equivalent", "time.preset": None}
NEWMARK = {"time.scheme": "newmark", "time.preset": "trapezoidal"}
EXPLICIT = {"time.scheme": "semi-explicit", "mass.type": "equivalent-lumped", "time.step": 1e-3}
ALL_ROUND = {"mesh.refine": 0, "contact.0.group": "boundary"}
FEWER = [{"mesh.degree": 2}, {"mesh.refine": 2}, {"contact.0.group": "bottom"}]
ADAPTIVE = {"time.step": "adaptive", "time.tolerance": 1e-7, "time.largest": 1e-2, "time.smallest": 5e-3}
GROWS = {"time.scheme": "newmark", "time.beta": 0.1, "time.gamma": 0.5, "time.step": 0.05, "time.end": 40, "mass.type": "lumped",
         "output.fields_every": 0, "check.energy_residual": 0, "check.momentum": 0, "check.angular_momentum": 0}
SLIDES = {**NEWMARK, "contact.0.friction": 0.3, "initial.velocity": "[5.0, 0.0]", "mesh.move": "[0.0, -0.1]", "time.step": 0.05,
          "time.end": 1.0, "mass.type": "lumped", "material.0.lambda": 1e4, "material.0.mu": 1e4}
RELAXES = {"material.0.relaxation.modulus": "[0.5]", "material.0.relaxation.time": "[0.1]"}


def step(found):
    return {"time.step": found[1]}


# A message of a case with settings, in the words of the sources as far as they are the same (a group stands for a number), and what
# is to be set instead, one after the other.
TRIED = [
    (r'set mass.type = "equivalent-lumped", or use scheme "newmark", which takes any mass', BLOCK,
     {**EXPLICIT, "mass.type": "consistent"}, [{"mass.type": "equivalent-lumped"}, NEWMARK]),
    (r'set material damping.stiffness = 0 \(damping.mass is possible\), or use scheme "reduced-kane"', BLOCK,
     {**EXPLICIT, "material.0.damping.stiffness": 1e-4},
     [{"material.0.damping.stiffness": 0}, {"material.0.damping.stiffness": 0, "material.0.damping.mass": 0.1}, {"time.scheme": "reduced-kane"}]),
    (r'set time.step = (\S+) or less, or use scheme "reduced-kane", which is stable', BLOCK, {**EXPLICIT, "time.step": 0.1},
     [step, {"time.scheme": "reduced-kane"}]),
    (r'high frequencies of large amplitude, take (\S+) or less', BLOCK, {**EXPLICIT, "time.step": 0.0065}, [step]),
    (r'set mass.type = "consistent" \(or "lumped"\), or use scheme "reduced-kane" with this mass', BLOCK, {"mass.type": "equivalent"},
     [{"mass.type": "consistent"}, {"mass.type": "lumped"}, {"time.scheme": "reduced-kane"}]),
    (r'set mass.type = "lumped", or use scheme "reduced-kane", which takes the equivalent mass', BLOCK,
     {"time.scheme": "taylor-flanagan", "time.step": 1e-3}, [{"mass.type": "lumped"}, KANE]),
    (r'set mass.type = "equivalent", or use scheme "contact-stabilized"', BLOCK, {"time.scheme": "reduced-kane"},
     [{"mass.type": "equivalent"}, {"time.scheme": "contact-stabilized"}]),
    (r'give time.step as a number, or use scheme "reduced-kane"', BLOCK,
     {"time.scheme": "paoli-schatzman", "mass.type": "lumped", **ADAPTIVE},
     [{"time.step": 1e-3, "time.tolerance": None, "time.largest": None, "time.smallest": None}, KANE]),
    (r'needs the linear material law; "reduced-kane", the default, takes those of finite strain, too', BLOCK,
     {"time.scheme": "moreau-jean", "material.0.law": "neo-hookean"}, [{"material.0.law": "linear"}, KANE]),
    (r'elements of degree 1 lock and are far too stiff; use mesh.degree = 2', BLOCK, {"material.0.lambda": 1e6, "material.0.mu": 1.0},
     [{"mesh.degree": 2}]),
    (r'next to no work on them; use degree 2, or "p1", "dual" or "nodal"', BLOCK, {"contact.0.multipliers": "p0"},
     [{"mesh.degree": 2}, *({"contact.0.multipliers": name} for name in ("p1", "dual", "nodal"))]),
    (r'take friction out, or use scheme "reduced-kane"', BLOCK, {"time.scheme": "nitsche", "contact.0.friction": 0.3},
     [{"contact.0.friction": 0}, KANE]),
    (r'take them out, or use scheme "moreau-jean"', BLOCK, {"time.scheme": "nonsmooth-generalized-alpha", "contact.0.friction": 0.3},
     [{"contact.0.friction": 0}, {"time.scheme": "moreau-jean"}]),
    (r'slips come out wrong; use mass "equivalent"', BLOCK, {**NEWMARK, "contact.0.friction": 0.3}, [{"mass.type": "equivalent"}]),
    (r'take a step of at most (\S+), or scheme "reduced-kane" with mass "equivalent", which takes any', BLOCK,
     {**NEWMARK, "mass.type": "equivalent", "time.step": 0.3}, [step, KANE]),
    (r'takes no friction: its balance of energy has no sign with it; use scheme "reduced-kane"', BLOCK,
     {"time.scheme": "mean-reaction", "mass.type": "equivalent", "contact.0.friction": 0.2}, [{"time.scheme": "reduced-kane"}]),
    (r'does not relax: use "saint-venant-kirchhoff", which is the same for small strains, or', BLOCK, {**KANE, **RELAXES},
     [{"material.0.law": "saint-venant-kirchhoff"}, {"material.0.law": "neo-hookean"}]),
    (r'use scheme "reduced-kane", "mean-reaction" or "reduced-midpoint", or leave material.relaxation out', BLOCK,
     {**EXPLICIT, **RELAXES, "material.0.law": "saint-venant-kirchhoff"},
     [*({"time.scheme": name, "mass.type": "equivalent"} for name in ("reduced-kane", "mean-reaction", "reduced-midpoint")),
      {key: None for key in RELAXES}]),
    (r'some material here has a law of finite strain: set it to 0', BLOCK,
     {**KANE, "material.0.law": "neo-hookean", "material.0.damping.stiffness": 1e-4}, [{"material.0.damping.stiffness": 0}]),
    (r'use scheme "reduced-kane" or "newmark", or a \[\[traction\]\], which keeps its direction', PRESSED,
     {**EXPLICIT, "material.0.law": "neo-hookean"}, [KANE, NEWMARK]),
    (r'gaps are no linear functions of the displacement; set time.restitution = 0', BALL,
     {"time.scheme": "paoli-schatzman", "mass.type": "lumped", "time.step": 1e-3, "time.restitution": 0.5}, [{"time.restitution": 0}]),
    (r'the force is wrong where it does not; take cells a third of the radius in size there', BALL,
     {"obstacle.floor.radius": 0.1, "obstacle.floor.centre": "[0.7, -0.1]"}, [{"mesh.refine": 5}]),
    (r'it can be past it without having touched; take time.step = (\S+) or less', BALL,
     {"initial.velocity": "[0.0, -300.0]", "time.step": 0.01}, [step]),
    (r'make the motion smooth, for example with 0.5\*\(1-cos\(pi\*t/T\)\), and take ten steps or more', JERKED,
     {**NEWMARK, "time.step": 2e-3}, [{"support.0.value": "-0.01*0.5*(1-cos(pi*min(t/0.1, 1)))"}]),
    (r'stretches are 1 \+ principal strain: leave it out, or set material.law', BLOCK, {"output.fields": '["principal_stretch_1"]'},
     [{"output.fields": '["displacement"]'}, {**KANE, "material.0.law": "neo-hookean"}]),
    (r'mass type "equivalent-nodewise": .* refine the mesh there or set mesh.degree = 2, so that', BLOCK,
     {**KANE, **ALL_ROUND, "mass.type": "equivalent-nodewise"}, FEWER),
    (r'mass type "equivalent-compact": .* refine the mesh there or set mesh.degree = 2, so that at least', BLOCK,
     {**KANE, **ALL_ROUND, "mass.type": "equivalent-compact"}, FEWER),
    (r'mass type "equivalent-cellwise": .* refine the mesh there or set mesh.degree = 2, name only facets', BLOCK,
     {**KANE, **ALL_ROUND, "mass.type": "equivalent-cellwise"}, FEWER),
    (r'use mass type "equivalent", which is positive semi-definite by construction, or refine the mesh', BLOCK,
     {**KANE, "mesh.refine": 0, "mass.type": "equivalent-nearest"}, [{"mass.type": "equivalent"}, {"mesh.refine": 2}]),
    (r'they cannot carry its mass, .*; refine the mesh, or use mass type "consistent" or "lumped"', BLOCK,
     {**NEWMARK, **ALL_ROUND, "mass.type": "equivalent-nearest"}, [{"mesh.refine": 3}, {"mass.type": "consistent"}, {"mass.type": "lumped"}]),
    (r'surround its centre of gravity, or use mass type "lumped" \(with an implicit scheme\)', BLOCK,
     {**NEWMARK, **ALL_ROUND, "mass.type": "equivalent-lumped"}, [{"mesh.refine": 2}, {"mass.type": "lumped"}]),
    (r'name only facets that may touch in the contact group, refine the mesh, or set mesh.degree = 2', BLOCK,
     {**KANE, "mesh.refine": 1, "contact.0.group": "boundary", "contact.0.friction": 0.3},
     [{"contact.0.group": "bottom"}, {"mesh.refine": 4}, {"mesh.degree": 2}]),
    (r'angular momentum is kept only to the order h²; use mesh.degree = 2 or a straight mesh', CURVED, {"mesh.move": "[0.0, 2.0]"}, [{"mesh.degree": 2}]),
    (r'stresses near the contact can be wrong by tens of per cent; use "p1"', PAIR, {"contact.0.multipliers": "nodal"},
     [{"contact.0.multipliers": "p1"}]),
    (r'take "p1", or "p0" with a displacement of degree 2', PAIR, {"contact.0.sliding": "large", "contact.0.multipliers": "dual"},
     [{"contact.0.multipliers": "p1"}, {"contact.0.multipliers": "p0", "mesh.degree": 2}]),
    (r'touches itself with sliding = "large" alone; set that, or name a group of another body', PAIR,
     {"contact.0.against": "two.bottom"}, [{"contact.0.sliding": "large"}, {"contact.0.against": "one.boundary"}]),
    (r'use "saint-venant-kirchhoff", which is the same for small strains and sees no rotation', PAIR,
     {"material.0.law": "neo-hookean", "material.1.law": "linear"}, [{"material.1.law": "saint-venant-kirchhoff"}]),
    (r'since friction_bound is a force per area; use multipliers "dual" or "p1"', SOLID,
     {"mesh.degree": 2, "mesh.refine": 1, "contact.0.friction_bound": 1.0},
     [{"contact.0.multipliers": "dual"}, {"contact.0.multipliers": "p1"}]),
    (r'nodal forces of degree 2 have not; set multipliers = "p1" or "dual", or mesh.degree = 1', SOLID,
     {"time.scheme": "nitsche", "mass.type": "consistent", "mesh.degree": 2, "mesh.refine": 1},
     [{"contact.0.multipliers": "p1"}, {"contact.0.multipliers": "dual"}, {"mesh.degree": 1}]),
    (r'from triangle to triangle do next to no work; use "p1", "dual" or "nodal"', SOLID,
     {"contact.0.multipliers": "p0", "mesh.degree": 2, "mesh.refine": 1}, [{"contact.0.multipliers": name} for name in ("p1", "dual", "nodal")]),
    (r'add a \[\[support\]\] in the direction in which it is free to move or turn, or give the displacement by expressions', HELD,
     {**KANE, "initial.displacement": "static", "load.gravity": "[1.0, -10.0]", "contact.0.friction": 0.01},
     [{"support.0.components": '["x"]'}, {"initial.displacement": '["0", "0"]'}]),
]
# Of messages that only a run says.
TRIED_BY_RUNS = [
    (r'make time.smallest shorter, or the tolerance larger', BLOCK, {**KANE, **ADAPTIVE},
     [{"time.smallest": 1e-5}, {"time.tolerance": 1e-2}]),
    (r'has grown beyond all bounds; use a stable scheme \(reduced-kane with mass "equivalent"\)', BLOCK, GROWS,
     [{**KANE, "time.beta": None, "time.gamma": None, "time.end": 1.0}]),
    (r'scheme "reduced-kane" with mass "equivalent" creates none', BLOCK, SLIDES, [KANE]),
    (r'\[\[material\]\] a law that rotations do not change \(law = "neo-hookean"\)', BLOCK,
     {**KANE, "initial.velocity": '["-3*y", "3*x"]', "material.0.mu": 500.0, "material.0.lambda": 500.0, "mesh.move": "[0.0, 5.0]"},
     [{"material.0.law": "neo-hookean"}]),
]
# By the words of the sources: the file, under tests/, and words of the test.
ELSEWHERE = {
    'leave multipliers_on out: with the multipliers on':
        ("end_to_end/multiplier_side_test.py", "leave multipliers_on out: with the multipliers on"),
    'below which no step is refused, or a larger time.tolerance': ("verification/adaptive_onset_test.cpp", "EndWhereTheyDoNotGetOn"),
    'Give the mesh a group of these facets of this body': ("end_to_end/self_penetration_test.py", "test_facets_without_a_group_of_their_own"),
    "smaller time.step and smaller cells lose less":
        ("end_to_end/warnings_test.py", "test_energy_that_long_steps_take"),
    "}}, the time in which a wave crosses a cell":
        ("end_to_end/warnings_test.py", "test_bodies_that_slide_without_damping"),
    "scheme \"{}\" {}; use scheme \"reduced-kane\"":
        ("end_to_end/followed_advice_test.py", "takes no friction: its balance of energy"),
    "take a time.step in which bodies move by less than the obstacle is thick":
        ("end_to_end/shaped_obstacles_test.py", "test_short_ones_do_not"),
    "set sliding = \"large\" in this [[contact]], limit the motion":
        ("end_to_end/two_bodies_test.py", "test_sliding_beyond_half_a_facet_is_told_once"),
}
# By the words of the sources: nobody has followed these. The list is to become shorter, not longer.
UNTRIED = [
    'which it is the same as "{}": name that, or set material.law',
    'a rigid body that moves by the forces on it: give its mass or density, too',
    'choose a unit of time in which steps are nearer to 1',
    'separate them by at least one facet, give them the same, or use multipliers "p0", whose friction is per facet',
    'let the other surface follow (multipliers_on of the tie), or take multipliers "p1"',
    'friction bound has no meaning for its force; use multipliers "dual" or "p1"',
    'apart: it can go in between them unseen; take smaller cells there',
    'gaps are off by a part of that; take a smaller edge_radius',
    'take a time.step that is',
    'entries, more than CHOLMOD can count: set solver.method = "iterative"',
    'refine the mesh, or use mass type "lumped" (with an implicit scheme)',
    'together, to carry them with positive masses; refine the mesh where rotation matters',
    'improve the mesh around the contact boundary, or use mass type "consistent" or "lumped"',
    'give the displacement at which the bodies begin to touch, or set initial_gap = "closed" where surfaces that to',
    'contact, as curved facets are seen edge-on there; refine the mesh at the rim of the contact',
    'use a mesh of second order (mesh.degree = 2 makes one of a geometry)',
    'move the bodies apart, set initial_gap = "closed" where surfaces that touch overlap since their facets are fla',
    'give its mass, inertia and centre_of_mass (a ball, a ring or a closed surface, seen from outside, has them fro',
    'the mesh, set mesh.degree = 2, or name only facets that may touch in the contact group',
    'needs a linear material law: set material.law = "linear"',
    'take a time.step below the time in which a wave crosses a cell, and see that no body starts inside an obstacle',
    'take a smaller time.step, or scheme "reduced-kane" with mass "equivalent", whose friction creates none',
    'only facets that may touch in the contact group, or use scheme "reduced-kane"',
    'start it slightly above the obstacle with damping, or use scheme "reduced-kane", which rests',
    'or less, as it may fall further, or use scheme "reduced-kane", which is stable for any',
    'apply less, add a [[support]], or let the loads act from a start at rest',
    'add a [[support]] in the direction in which it is free to move or turn',
    'give the flat side facets as small as what is to touch it',
    'beyond it goes into the obstacle unhindered; add the boundary beyond it to the group',
    'extend the groups, or pair them with pair_at where they meet',
    'set sliding = "large", pair them with pair_at where they meet, or let them move less',
    'let the obstacle rest, leave friction out, or give the displacement by expressions',
    'add a [[support]] that holds it in the direction in which it moves or turns',
    'magnitude or very slender bodies are likely causes; give the displacement by expressions instead',
    'use scheme "reduced-kane" with mass "equivalent", or fixed steps',
    'friction_bound alone a step need not have a solution: give a friction coefficient beside it',
    'than the time in which a wave crosses a cell: take shorter ones, or scheme "reduced-kane"',
    'set solver.method = "direct" if memory allows',
    'set solver.method = "direct" or take a smaller time.step',
    'contact zone is too coarse to trust the force: refine the mesh there',
    'the energy that this restitution says was lost: take a smaller time.step, and smaller cells',
    'to trust the largest force and the duration; refine the mesh there',
    'refine it less often',
]


class FollowedAdvice(TestCase):
    def said(self, text, values, command):
        case = self.write("case.toml", text)
        output = ["-o", self.folder / "out", "--force", "--quiet"] if command == "run" else []
        return run(command, case, *output, *settings({key: value for key, value in values.items() if value is not None}))

    def follow(self, tried, command):
        for message, text, values, advice in tried:
            found = re.search(message, self.said(text, values, command).stderr)
            self.assertIsNotNone(found, f"nothing says: {message}")
            for taken in advice:
                taken = taken(found) if callable(taken) else taken
                with self.subTest(message=message, taken=taken):
                    after = self.expect_status(0, self.said(text, {**values, **taken}, command))
                    self.assertNotRegex(after.stderr, message)

    def test_before_a_run(self):
        self.follow(TRIED, "validate")

    def test_of_runs(self):
        self.follow(TRIED_BY_RUNS, "run")

    def test_every_message_is_in_a_table(self):
        messages = advising_messages()
        self.assertGreater(len(messages), 50, "the sources are where they were")
        patterns = [pattern for pattern, *_ in TRIED + TRIED_BY_RUNS]
        fragments = [*ELSEWHERE, *UNTRIED]
        for file, message in messages:
            with self.subTest(file):
                known = any(covers(pattern, message) for pattern in patterns) or any(fragment in message for fragment in fragments)
                self.assertTrue(known, f"{file} advises a setting, and no test takes it (TRIED above): {message}")
        for fragment in fragments:
            self.assertTrue(any(fragment in message for _, message in messages), f"no message says any more: {fragment}")

    def test_other_tests_are_there(self):
        for fragment, (file, name) in ELSEWHERE.items():
            self.assertIn(name, (SOURCE / "tests" / file).read_text(encoding="utf-8"), fragment)


def covers(pattern, message):
    """Whether the words of a pattern, in pieces between what stands for numbers, are those of a message."""
    words = [re.sub(r"\\(.)", r"\1", piece) for piece in re.split(r"\(\\S\+\)|\.\*", pattern)]
    return all(piece.strip() in message for piece in words)


if __name__ == "__main__":
    unittest.main()
