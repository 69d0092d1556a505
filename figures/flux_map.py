"""The flux map of a wound machine: flux linkages over the currents, the best currents, and what they give over speed.

The functions take the results of ``electrical`` by their attributes and import nothing of it.
"""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from figures.style import BLACK, BLUE, FIELD_MAP, GREY, ORANGE, VERMILION, letter, new_figure, show_grid, styled

_SAMPLES = 121
_LOOKS = (
    ("field", "flux map", {"color": BLUE}),
    ("constant", "constant parameters", {"color": ORANGE, "linestyle": "--"}),
)


@styled
def flux_maps(machine, mtpa: tuple[np.ndarray, np.ndarray], envelope: pd.DataFrame, current_peak: float) -> Figure:
    """psi_d and psi_q over the motoring currents, with the MTPA and MTPV curves and the envelope's path.

    machine: i_d, i_q (axes of the map) [A] and flux_linkage(i_d, i_q) [Wb] (``FluxMapMachine``)
    mtpa: (i_d, i_q) [A] from no current to the limit
    envelope: columns i_d_field_A, i_q_field_A, i_d_mtpv_A, i_q_mtpv_A
    current_peak: limit [A], drawn as a circle
    """
    i_d, i_q = np.linspace(machine.i_d[0], machine.i_d[-1], _SAMPLES), np.linspace(0.0, machine.i_q[-1], _SAMPLES)
    values = machine.flux_linkage(*np.meshgrid(i_d, i_q))
    figure = new_figure(5.0)
    axes = figure.subplots(1, 2, sharex=True, sharey=True)
    for axis, psi, name in zip(axes, values, ("d", "q"), strict=True):
        _map(figure, axis, i_d, i_q, 1e3 * psi, f"{name}-axis flux linkage / mWb")
        _draw_currents(axis, mtpa, envelope, current_peak)
        axis.set_title(f"flux linkage $\\psi_{name}$", loc="left")
        axis.set_xlabel("$i_d$ / A")
        axis.set_aspect("equal")
    axes[0].set_ylabel("$i_q$ / A")
    letter(axes)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=4, frameon=False)
    return figure


@styled
def field_envelope(table: pd.DataFrame, *, title: str) -> Figure:
    """Largest torque, power and its currents over speed, from the flux map and from constant parameters.

    table: columns speed_rpm and, for ``field`` and ``constant``, torque_<>_Nm, power_<>_W, i_d_<>_A, i_q_<>_A
    """
    figure = new_figure(4.6)
    axes = figure.subplots(1, 3)
    for name, label, look in _LOOKS:
        axes[0].plot(table.speed_rpm, table[f"torque_{name}_Nm"], label=label, **look)
        axes[1].plot(table.speed_rpm, table[f"power_{name}_W"] / 1e3, **look)
        axes[2].plot(table.speed_rpm, -table[f"i_d_{name}_A"], **look)
    titles = (("torque", "torque / Nm"), ("power", "power / kW"), ("field-weakening current", "$-i_d$ / A"))
    for axis, (heading, label) in zip(axes, titles, strict=True):
        axis.set(xlabel="rotor speed / rpm", ylabel=label)
        axis.set_title(heading, loc="left")
        axis.set_xlim(left=0.0)
        axis.set_ylim(bottom=min(0.0, axis.get_ylim()[0]))
    letter(axes)
    show_grid(*axes)
    figure.suptitle(title)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2, frameon=False)
    return figure


def _map(figure, axes, i_d, i_q, values, label: str) -> None:
    colours = axes.contourf(i_d, i_q, values, levels=14, cmap=FIELD_MAP)
    lines = axes.contour(i_d, i_q, values, levels=colours.levels[1:-1:2], colors="white", linewidths=0.6)
    axes.clabel(lines, fontsize=8, fmt="%g")
    figure.colorbar(colours, ax=axes, pad=0.02, orientation="horizontal").set_label(label)


def _draw_currents(axes, mtpa, envelope: pd.DataFrame, current_peak: float) -> None:
    angle = np.linspace(0.0, np.pi / 2, 91)
    circle = -current_peak * np.sin(angle), current_peak * np.cos(angle)
    axes.plot(*circle, color=GREY, linestyle=":", label="current limit")
    axes.plot(*mtpa, color=BLACK, label="MTPA")
    axes.plot(envelope.i_d_mtpv_A, envelope.i_q_mtpv_A, color=BLACK, linestyle="--", label="MTPV")
    axes.plot(envelope.i_d_field_A, envelope.i_q_field_A, color=VERMILION, linewidth=2.2, label="envelope over speed")
