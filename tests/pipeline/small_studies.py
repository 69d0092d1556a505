"""Shipped studies made small, and runs of them in this process, so that a whole run costs seconds.

``small`` replaces lines of a study file; ``fitted`` puts known polynomials in the place of sweep and optima; ``here``
runs a graph without worker processes.
"""

import re
from dataclasses import replace

import numpy as np

from drivetrain.heat_views import mapped_loss
from optimisation.fits import QUANTITIES, CombinationFits, SectionFits
from optimisation.polynomial_fits import fit_polynomial
from pipeline.graph import Source, Stage, View
from pipeline.results import Results
from pipeline.run import Run
from pipeline.run_command import page_of
from pipeline.stages import graph_of
from processes import ThisProcess
from study.inputs_heat import no_loss_data
from study.read import STUDIES, read_study
from tests.drivetrain.fitted_machines import NINE, TWELVE, MotorcycleFits

# Coarse everywhere: a whole run in some ten seconds; numbers are off by per cents and mean nothing.
COARSE = {
    "sweep.stator_diameters_mm": "[75, 80, 85, 90]",
    "sweep.slots": "[12]",
    "sweep.back_iron_steps": "4",
    "sweep.rotor_radius_steps": "4",
    "saturation.limits_compared_T": "[]",
    "mesh.gap_edges_per_revolution": "60",
    "mesh.gap_layers": "1",
    "mesh.elements_across_tooth": "1.0",
    "flux_map.angles": "1",
    "flux_map.currents": "5",
}
# The motorcycle besides: one short road, two obstacles, a short search of the linkage, gears near their ratio.
MOTORCYCLE = {
    "study__id": '"small-test-study"',
    "saturation__limits_compared_T": "[1.2, 1.5]",
    "ride__road_seeds": "[0]",
    "ride__road_duration_s": "5.0",
    "obstacles__amplitudes_mm": "[-50, 50]",
    "obstacles__speeds_km_per_h": "[50]",
    "linkage_search__seeds": "[1]",
    "linkage_search__population": "24",
    "linkage_search__generations": "20",
    "gearbox__ratio_tolerance": "0.015",
    "winding_selection__dc_bus_voltage_V": "90.0",
}


RADII = np.linspace(35e-3, 57.5e-3, 5)  # m


def fitted_sections() -> SectionFits:
    """Polynomials through the motorcycle's optima, as the stage makes them."""
    found = {one: [MotorcycleFits().at(one, radius) for radius in RADII] for one in (NINE, TWELVE)}
    return SectionFits(tuple(CombinationFits(one, _fits(sections)) for one, sections in found.items()))


def _fits(sections):
    return tuple(fit_polynomial(name, RADII, [getattr(one, name) for one in sections]) for name in QUANTITIES)


def fitted(study, without=(), graph=None):
    """The graph of a study, or another one, with ``fitted_sections`` from the start, and without some stages.

    Without losses the heat of the machine counts none in iron and magnets.
    """
    graph, gone = graph or graph_of(study), {"sweep", "optima", "limits", "fits", *without}
    if "losses" in gone:
        gone.add("current_losses")
    kept = [node for node in graph.nodes if not (isinstance(node, Stage) and node.name in gone)]
    if "losses" in gone:
        kept = [Source(no_loss_data) if node == View(mapped_loss) else node for node in kept]
    return replace(graph, nodes=(*kept, View(fitted_sections)))


def small(name, folder, **changes):
    """A shipped study, coarse and with these changes (``drive__damping_Nms_per_rad="0.0"``), read from a folder."""
    text = (STUDIES / f"{name}.toml").read_text(encoding="utf-8")
    wanted = COARSE | {key.replace("__", "."): value for key, value in changes.items()}
    for key, value in wanted.items():
        text = _stated(text, *key.split("."), value)
    path = folder / f"{name}.toml"
    path.write_text(text, encoding="utf-8")
    return read_study(path)


def _stated(text, section, key, value):
    """The text with one key of a section set, the section added where there is none."""
    if not re.search(rf"^\[{section}\]", text, flags=re.M):
        return f"{text}\n[{section}]\n{key} = {value}\n"
    head, body = re.split(rf"^(?=\[{section}\])", text, maxsplit=1, flags=re.M)
    own, *others = re.split(r"\n(?=\[)", body, maxsplit=1)
    own = re.sub(rf"^{key} = .*\n?", "", own, flags=re.M).rstrip("\n") + f"\n{key} = {value}\n"
    return head + "\n".join([own, *others])


def here(study, folder, graph=None, last=None):
    """Run the graph of a study up to a stage, or all of it, with its report."""
    graph = graph_of(study) if graph is None else graph
    run = Run(graph, study, Results(folder), ThisProcess())
    with run.results.held():
        run.all(graph.usual if last is None else graph.before(graph.stage(last)))
        run.write_report(page_of)
    return run
