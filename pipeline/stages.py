"""The declared graph: what a study is made of, from what is asked to the report.

Each stage is a function of the room that it speaks of; what it reads and writes stands in its signature. Variants of a
study are other nodes: requirements that a vehicle gives or that are stated, a linkage that is searched or stated.
"""

from __future__ import annotations

from drivetrain.errors import LinkageError
from drivetrain.linkage_stage import chosen_linkage, linkage_stage
from drivetrain.matching import match_stage, matched_machine
from drivetrain.outcome import actuator_limits, outcome_stage
from drivetrain.whole_search import optimise_stage
from electrical.drive_stage import drive_stage
from electrical.winding_stage import winding_stage
from gearbox.stage import gearbox_stage
from losses.stage import losses_stage
from magnetostatics.flux_map_stage import flux_map_stage
from magnetostatics.rotation_stage import rotation_stage
from optimisation.fits import fits_stage
from optimisation.limits import limits_stage
from optimisation.optima import optima_stage
from optimisation.sweep import sweep_stage
from pipeline.graph import Graph, Node, Source, Stage, View
from study.schema import Study
from vehicle.demands import required, requirements_stage
from vehicle.ride_again import ride_again_stage


def graph_of(study: Study) -> Graph:
    """The graph of a study."""
    raise NotImplementedError
