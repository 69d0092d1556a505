"""Train of stages, axial layout and table row: sums and plain geometry."""

from dataclasses import replace

import pytest

from gearbox.efficiency import stage_efficiency
from gearbox.errors import GearError
from gearbox.layout import Housing, MachineEnvelope, actuator_layout
from units import MILLIMETRE

MM = MILLIMETRE
MACHINE = MachineEnvelope(42.5 * MM, 15.7 * MM, 5 * MM, 36 * MM, 8 * MM)
HOUSING = Housing(wall=12.5 * MM, lever_side=60 * MM, bearing_seat=12 * MM, sensor_cover=20 * MM)


@pytest.fixture
def train(printed, request_of):
    return request_of().train(printed, (12 * MM, 4.5 * MM))


def test_inertia_of_the_train_is_the_kinetic_energy(train):
    """Every body of every stage at its own speed, for 3 rad/s at the lever."""
    speed, energy = 3.0, 0.0
    for stage, bodies in zip(train.stages, train.bodies, strict=True):
        for body in bodies:
            spin, orbit = body.speed * speed, body.orbit * speed
            energy += body.count * (body.inertia * spin**2 + body.mass * orbit**2) / 2
        speed *= stage.gears.ratio
    assert train.inertia_at_slow_shaft * 3.0**2 / 2 == pytest.approx(energy, rel=1e-12)
    assert train.inertia_at_fast_shaft * speed**2 / 2 == pytest.approx(energy, rel=1e-12)
    assert train.ratio == pytest.approx(speed / 3.0, rel=1e-12)


def test_efficiency_of_the_train_is_the_product(train):
    one = stage_efficiency(train.stages[0].gears, train.friction)
    assert train.efficiency == (pytest.approx(one[0] ** 2), pytest.approx(one[1] ** 2))


def test_loads_pass_through_the_train(train, load):
    first, second = train.loads(load)
    assert first is load and second.peak_torque == pytest.approx(load.peak_torque / train.stages[0].gears.ratio)


def test_layout_lengths_add_up(train):
    layout = actuator_layout(train, MACHINE, HOUSING)
    assert layout.length == pytest.approx(60 * MM + train.length + (2 * 12 + 36 + 2 * 8 + 20) * MM)
    assert layout.diameter == pytest.approx(110 * MM)  # thesis Table 3.12
    assert max(part.start + part.length for part in layout.parts) == pytest.approx(layout.length)


def test_parts_of_different_kinds_do_not_share_room(train):
    """Gears, machine and casing; pins stand in planets, suns and shafts in carriers."""
    parts = actuator_layout(train, MACHINE, HOUSING).parts
    solid = [part for part in parts if part.kind not in ("carrier", "sun", "shaft")]
    for k, one in enumerate(solid):
        for other in solid[k + 1 :]:
            along = min(one.start + one.length, other.start + other.length) - max(one.start, other.start)
            across = min(one.outer_radius, other.outer_radius) - max(one.inner_radius, other.inner_radius)
            meshing = {one.kind, other.kind} == {"planet", "ring"}  # teeth stand in each other's spaces
            assert along <= 1e-12 or across <= (2.3 * 0.75 * MM if meshing else 1e-12), (one, other)


def test_a_rotor_larger_than_its_stator_is_refused(train):
    with pytest.raises(GearError, match="rotor radius 50 mm must be below"):
        actuator_layout(train, replace(MACHINE, rotor_outer_radius=50 * MM), HOUSING)
