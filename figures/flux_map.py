"""The flux map of a wound machine: flux linkages over the currents, the best currents, and torque over speed."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from electrical.dq import Envelope
from electrical.flux_map_machine import FluxMapMachine
from electrical.performance import Performance
from figures.style import BLACK, BLUE, FIELD_MAP, GREY, ORANGE, VERMILION, letter, new_figure, show_grid, styled
from units import FACTORS, RPM

FLUX_MAP_CAPTION = (
    "Flux linkages over the currents, with MTPA, the envelope and, where it is reached, MTPV. Where cubics between "
    "the solved currents bend MTPA by a fifth of a degree, the torque does not feel it."
)
_SAMPLES = 121
_FIELD_LOOK: dict[str, Any] = {"color": BLUE, "label": "flux map"}
_CONSTANT_LOOK: dict[str, Any] = {"color": ORANGE, "linestyle": "--", "label": "constant parameters"}


@styled
def flux_maps(machine: FluxMapMachine, found: Performance, current_peak: float) -> Figure:
    """psi_d and psi_q over the motoring currents, with the MTPA and MTPV curves and the envelope's path.

    current_peak: limit [A], drawn as a circle
    """
    i_d, i_q = np.linspace(machine.i_d[0], machine.i_d[-1], _SAMPLES), np.linspace(0.0, machine.i_q[-1], _SAMPLES)
    values = machine.flux_linkage(*np.meshgrid(i_d, i_q))
    figure = new_figure(5.0)
    axes = figure.subplots(1, 2, sharex=True, sharey=True)
    for axis, psi, name in zip(axes, values, ("d", "q"), strict=True):
        _map(figure, axis, i_d, i_q, 1e3 * psi, f"{name}-axis flux linkage / mWb")
        _draw_currents(axis, found, current_peak)
        axis.set_title(f"flux linkage $\\psi_{name}$", loc="left")
        axis.set_xlabel("$i_d$ / A")
        axis.set_aspect("equal")
    axes[0].set_ylabel("$i_q$ / A")
    letter(axes)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=4, frameon=False)
    return figure


@styled
def field_envelope(field: Envelope, constant: Envelope, *, title: str) -> Figure:
    """Largest torque, power and its currents over speed, from the flux map and from constant parameters."""
    figure = new_figure(4.6)
    axes = _envelopes(figure, ((field, _FIELD_LOOK), (constant, _CONSTANT_LOOK)))
    figure.suptitle(title)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2, frameon=False)
    return figure


@styled
def envelope_over_speed(envelope: Envelope) -> Figure:
    """Largest torque, power and its current on the d axis over speed."""
    figure = new_figure(4.0)
    _envelopes(figure, ((envelope, {"color": BLUE}),))
    return figure


def _envelopes(figure: Figure, envelopes: Iterable[tuple[Envelope, dict[str, Any]]]) -> np.ndarray:
    axes, drawn = figure.subplots(1, 3), tuple(envelopes)
    unit = power_unit(envelope for envelope, _ in drawn)
    magnetising = all(np.nanmin(envelope.i_d) >= 0 < np.nanmax(envelope.i_d) for envelope, _ in drawn)
    for envelope, look in drawn:
        speed_rpm = envelope.speed / RPM
        axes[0].plot(speed_rpm, envelope.torque, **look)
        axes[1].plot(speed_rpm, envelope.power / FACTORS[unit], **look)
        axes[2].plot(speed_rpm, envelope.i_d if magnetising else -envelope.i_d, **look)
    direct = ("magnetising current", "$i_d$ / A") if magnetising else ("field-weakening current", "$-i_d$ / A")
    titles = (("torque", "torque / Nm"), ("power", f"power / {unit}"), direct)
    for axis, (heading, label) in zip(axes, titles, strict=True):
        axis.set(xlabel="rotor speed / rpm", ylabel=label)
        axis.set_title(heading, loc="left")
        axis.set_xlim(left=0.0)
        axis.set_ylim(bottom=min(0.0, axis.get_ylim()[0]))
    letter(axes)
    show_grid(*axes)
    return axes


def power_unit(envelopes: Iterable[Envelope]) -> str:
    """In which the largest power is a readable number."""
    return "kW" if max(np.nanmax(envelope.power) for envelope in envelopes) >= FACTORS["kW"] else "W"


def _map(figure: Figure, axes: Axes, i_d: np.ndarray, i_q: np.ndarray, values: np.ndarray, label: str) -> None:
    colours = axes.contourf(i_d, i_q, values, levels=14, cmap=FIELD_MAP)
    lines = axes.contour(i_d, i_q, values, levels=np.asarray(colours.levels)[1:-1:2], colors="white", linewidths=0.6)
    axes.clabel(lines, fontsize=8, fmt="%g")
    figure.colorbar(colours, ax=axes, pad=0.02, orientation="horizontal").set_label(label)


def _draw_currents(axes: Axes, found: Performance, current_peak: float) -> None:
    magnetising = found.full.direct > 0
    angle = np.linspace(-np.pi / 2 if magnetising else 0.0, 0.0 if magnetising else np.pi / 2, 91)
    circle = -current_peak * np.sin(angle), current_peak * np.cos(angle)
    axes.plot(*circle, color=GREY, linestyle=":", label="current limit")
    axes.plot(found.mtpa_direct, found.mtpa_quadrature, color=BLACK, label="MTPA")
    if np.isfinite(found.mtpv_direct).any():
        axes.plot(found.mtpv_direct, found.mtpv_quadrature, color=BLACK, linestyle="--", label="MTPV")
    axes.plot(found.envelope.i_d, found.envelope.i_q, color=VERMILION, linewidth=2.2, label="envelope over speed")
