"""A rubber ring falls on a floor: its mesh comes from Gmsh's Python module.

Physics: the impulse of the floor and that of the weight change the momentum: the sum of F dt is m (v_1 - v_0) + m g t, to rounding.
Without friction the total energy is constant. Until it touches the floor, the ring falls freely: v = v_0 - g t.

The example shows: rc.Mesh.from_gmsh with physical groups, gravity, momentum and energy in the history, a picture of the body.
"""

import pathlib
import sys

import gmsh
import matplotlib.pyplot as plt
import numpy as np

import ricochet as rc

out = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "out/04-mesh-of-gmsh")

outer, inner, gap = 0.05, 0.035, 1e-3
gmsh.initialize()
gmsh.option.setNumber("General.Verbosity", 2)
ring, _ = gmsh.model.occ.cut([(2, gmsh.model.occ.addDisk(0, outer, 0, outer, outer))],
                             [(2, gmsh.model.occ.addDisk(0, outer, 0, inner, inner))])
gmsh.model.occ.synchronize()
gmsh.model.setPhysicalName(2, gmsh.model.addPhysicalGroup(2, [tag for _, tag in ring]), "ring")
skin = [tag for _, tag in gmsh.model.getBoundary(ring, oriented=False)
        if gmsh.model.getBoundingBox(1, tag)[3] > 0.5 * (inner + outer)]
gmsh.model.setPhysicalName(1, gmsh.model.addPhysicalGroup(1, skin), "skin")
gmsh.option.setNumber("Mesh.MeshSizeMax", 3e-3)
gmsh.model.mesh.generate(2)
mesh = rc.Mesh.from_gmsh()
gmsh.finalize()

density, g, v = 1100.0, 9.81, 1.0
case = {
    "title": "A ring falls on a floor",
    "material": [{"group": "ring", "density": density, "young": 2e7, "poisson": 0.4}],
    "obstacle": {"floor": {"type": "plane", "point": [0, -gap], "normal": [0, 1]}},
    "contact": [{"group": "skin", "obstacle": "floor"}],
    "load": {"gravity": [0, -g]},
    "initial": {"velocity": [0, -v]},
    "time": {"step": 1e-5, "end": 0.012},
    "output": {"fields_every": 20},
}
run = rc.run(case, out, mesh=mesh, force=True)
history, time = run.history, run.time
mass = -history["momentum_y"][0] / v
exact = density * np.pi * (outer**2 - inner**2)
# Forces in the history are those at the ends of steps. The impulse of an impact is that of the forces that acted over the steps.
impulse = run.impacts[0]["impulse"][1]
change = history["momentum_y"][-1] - history["momentum_y"][0] + mass * g * time[-1]
free = history["momentum_y"][time < 0.9 * gap / v] / mass
print(f"mass {mass:.4f} kg/m, of the circles {exact:.4f}")
print(f"impulse of the floor {impulse:.6f} N s/m, change of momentum and weight {change:.6f}")
print(f"energy {history['total_energy'][0]:.6f} J/m, constant to {np.ptp(history['total_energy']):.1e}")
print(f"restitution {run.impacts[0]['restitution']:.4f}: the rest vibrates in the ring")

assert abs(mass / exact - 1) < 5e-3, "the mesh is not the ring"
assert np.allclose(free, -v - g * time[:len(free)], rtol=1e-9), "it does not fall freely"
assert abs(impulse / change - 1) < 1e-9, "the floor's impulse is not the change of momentum"
assert np.ptp(history["total_energy"]) < 1e-9 * history["total_energy"][0], "energy is not constant"

figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.4), constrained_layout=True)
run.frame(t=run.maximum("contact_force_y").time).plot("von_mises", axes=left)
left.set_title("at the largest force", fontsize=9)
for name in ("kinetic_energy", "elastic_energy", "total_energy"):
    right.plot(1e3 * time, history[name], label=name.replace("_", " "))
right.set(xlabel="time, ms", ylabel="J/m")
right.legend(fontsize=8)
figure.savefig(out / "picture.png", dpi=70)
