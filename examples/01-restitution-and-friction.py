"""A puck strikes a wall at an angle, with several coefficients of friction.

Physics: if the puck slips during the whole contact, Coulomb's law also holds for the impulses: the impulse along the wall is F times
the normal impulse. The velocity after the impact is then v_x - F (1 + e) v_n along the wall, a linear function of F, up to the
coefficient at which the puck sticks: for a disc F = v_x / (3 (1 + e) v_n), about 0.5 here.

The example shows: a case file with changed values, columns of the history, impacts, a picture of a frame.
"""

import pathlib
import sys

import matplotlib.pyplot as plt
import numpy as np

import ricochet as rc

out = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "out/01-restitution-and-friction")
case = pathlib.Path(__file__).resolve().parents[1] / "cases/puck/puck.toml"

frictions = [0.0, 0.1, 0.2, 0.3]
figure, (force, law, body) = plt.subplots(1, 3, figsize=(11, 3.2), constrained_layout=True)
ratios = []
for friction in frictions:
    # rc.run would warn that, with another friction, the case's [[expect]] entries do not hold.
    with rc.Session(case, {"contact.0.friction": friction}) as session:
        session.write_to(out / f"friction-{friction}", force=True)
        session.run()
        run = session.finish()
    impact, history = run.impacts[0], run.history
    across = history["momentum_y"][-1] - history["momentum_y"][0]
    along = history["momentum_x"][0] - history["momentum_x"][-1]
    ratios.append(along / across)
    print(f"F = {friction}: restitution {impact['restitution']:.4f}, impulse along/across {along / across:.6f}")
    force.plot(1e3 * run.time, -history["contact_force_x"], label=f"F = {friction}")

assert np.allclose(ratios, frictions, atol=1e-6), "the impulses do not obey Coulomb's law"
assert abs(history["energy_residual"]).max() < 1e-10 * history["total_energy"][0]

force.set(xlabel="time, ms", ylabel="friction, N/m", xlim=(0.3, 1.4))
force.legend(fontsize=8)
law.plot([0, 0.35], [0, 0.35], color="0.7", linewidth=4, label="Coulomb's law")
law.plot(frictions, ratios, "o", label="runs")
law.set(xlabel="friction F", ylabel="impulse along / across")
law.legend(fontsize=8)
run.frame(t=run.maximum("contact_force_y").time).plot("von_mises", axes=body)
figure.savefig(out / "picture.png", dpi=70)
