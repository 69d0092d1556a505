"""Search over tooth sets: against a plain loop, against its constraints, sentences when there is no gearbox."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from gearbox.errors import GearError, TooWeakError
from gearbox.planetary_set import equally_spaced, planetary_set
from gearbox.rating import rate_stage
from gearbox.search import PREFERRED_MODULES, ToothLimits, geometry_checks, search, strongest, tooth_numbers
from units import MILLIMETRE

MM = MILLIMETRE
COARSE = ToothLimits(sun_shift=(0.2, 0.6), planet_shift=(-0.2, 0.4), shift_step=0.2)


@pytest.fixture(scope="module")
def found(request_of):
    return search(request_of())


def safe(gears, width, load, request):
    least, wanted = rate_stage(gears, width, load, request.rules).least, request.safety
    return all(least[kind] >= getattr(wanted, kind) for kind in least)


def plain_search(request):
    """Loops over everything, one set at a time, widths from narrow to wide."""
    low, high = request.stage_ratios
    limits, best = request.teeth, (np.inf, None)
    grids = [np.arange(a, b + 1e-9, limits.shift_step) for a, b in (limits.sun_shift, limits.planet_shift)]
    for module, sun, ring in product(request.modules, range(12, 22), range(90, 150)):
        if not low <= 1 + ring / sun <= high or (sun + ring) % 3:
            continue
        for planet, x_sun, x_planet in product(range((ring - sun) // 2 - 4, (ring - sun) // 2 + 2), *grids):
            with np.errstate(invalid="ignore"):
                gears = planetary_set(([sun], [planet], [-ring]), ([x_sun], [x_planet]), np.array([module]), planets=3)
                if not all(check[0] for check in geometry_checks(gears, request).values()):
                    continue
            one, widths, load = gears.at(0), [], request.load
            for _ in range(request.stage_count):
                first, last = (int(n[0]) for n in request.width.range(gears))
                steps = (k for k in range(first, last + 1) if safe(one, k * request.width.step, load, request))
                widths.append(next(steps, None))
                load = load.behind(low)
            if None in widths:
                continue
            train = request.train(one, [k * request.width.step for k in widths])
            scale = request.cost
            cost = (
                scale.weight * train.inertia_at_slow_shaft / scale.linkage_ratio**2 / scale.equivalent_mass
                + (1 - scale.weight) * train.mass / scale.mass
            )
            shared = np.gcd(sun, planet) > 1 or np.gcd(planet, ring) > 1
            cost *= 1.05 if shared else 1.0
            if cost < best[0]:
                best = cost, ((sun, planet, -ring), round(x_sun, 3), round(x_planet, 3), widths)
    return best


def test_a_plain_loop_finds_the_same_gearbox(request_of):
    few = ToothLimits(sun_shift=(0.4, 0.6), planet_shift=(-0.2, 0.2), shift_step=0.2)
    request = request_of(modules=(0.75 * MM,), teeth=few, ratio_tolerance=0.02)
    cost, (teeth, x_sun, x_planet, widths) = plain_search(request)
    result = search(request, keep=1)
    gears = result.best.stages[0].gears
    assert gears.teeth == teeth
    assert (gears.sun.shift, gears.planet.shift) == (pytest.approx(x_sun), pytest.approx(x_planet))
    assert [stage.face_width for stage in result.best.stages] == pytest.approx([0.5 * MM * k for k in widths])
    assert result.costs[0] == pytest.approx(cost, rel=1e-9)


def test_all_tooth_numbers_are_formed(request_of):
    request = request_of()
    formed = {(sun, -ring) for sun, _, ring in tooth_numbers(request, 0.75 * MM)}
    low, high = request.stage_ratios
    expected = {
        (sun, ring)
        for sun, ring in product(range(12, 60), range(20, 114))
        if (sun + ring) % 3 == 0 and low <= 1 + ring / sun <= high
    }
    assert formed == expected and (14, 109) in formed


def test_found_gearboxes_keep_every_constraint(found, request_of):
    request = request_of()
    for train in found.trains:
        gears = train.stages[0].gears
        assert abs(train.ratio / 76 - 1) <= 0.03
        assert equally_spaced(gears.sun.teeth, gears.ring.teeth, 3) and gears.planet_gap >= 0.5 * MM
        assert min(gears.sun_mesh.contact_ratio, gears.ring_mesh.contact_ratio) >= 1.2
        assert gears.sun.module in PREFERRED_MODULES
        assert 2 * (gears.ring.root_radius + 1.5 * gears.sun.module) <= 85 * MM + 1e-9
        for stage, load in zip(train.stages, train.loads(request.load), strict=True):
            assert safe(gears, stage.face_width, load, request)
            diameter = gears.sun.module * gears.sun.teeth
            assert stage.face_width <= 1.6 * diameter and 6 <= stage.face_width / gears.sun.module <= 20


def test_the_first_stage_is_as_narrow_as_it_can_be(found, request_of):
    request, stage = request_of(), found.best.stages[0]
    assert not safe(stage.gears, stage.face_width - request.width.step, request.load, request)


def test_costs_rise_and_common_factors_pay(found):
    assert list(found.costs) == sorted(found.costs)
    for train, shared in zip(found.trains, found.shared, strict=True):
        sun, planet, ring = (int(z) for z in train.stages[0].gears.teeth)
        assert shared == (np.gcd(sun, planet) > 1 or np.gcd(planet, ring) > 1)


def test_the_choice_is_no_worse_than_the_printed_teeth(found, request_of):
    """Table 3.11's tooth numbers and module are among what is searched; at equal safety they cost more."""
    own = search(request_of(modules=(0.75 * MM,)), keep=30)
    printed = [c for t, c in zip(own.trains, own.costs, strict=True) if t.stages[0].gears.teeth == (14, 46, -109)]
    assert printed and found.costs[0] < printed[0]


def test_one_and_three_stages(request_of, load):
    light = replace(load, peak_torque=40.0, spectrum=load.spectrum.scaled(0.1, 1.0))
    single = search(request_of(ratio=6.0, stage_count=1, load=light, modules=(MM,), teeth=COARSE), keep=1).best
    assert len(single.stages) == 1 and single.ratio == pytest.approx(6.0, rel=0.03)
    triple = search(request_of(stage_count=3, modules=(0.8 * MM, MM, 1.25 * MM), teeth=COARSE), keep=1).best
    widths = [stage.face_width for stage in triple.stages]
    assert triple.ratio == pytest.approx(76, rel=0.03) and widths[0] > widths[1] >= widths[2]


# ---- no gearbox -----------------------------------------------------------------------------------------------------


def test_a_ratio_that_no_teeth_give(request_of):
    refused = "no tooth numbers with 3 equally spaced planets.*widen gearbox.ratio_tolerance"
    with pytest.raises(GearError, match=refused):
        search(request_of(ratio_tolerance=1e-6, ratio=76.3, modules=(0.8 * MM,)))


def test_too_many_planets_touch(request_of):
    with pytest.raises(GearError, match="the constraint in the way is the gap between the planets"):
        search(request_of(planets=4, ratio_tolerance=0.05))


def test_a_torque_beyond_the_teeth(request_of, load):
    with pytest.raises(GearError, match="too weak; the strongest, .* reaches a safety factor .*static.* is wanted"):
        search(request_of(load=replace(load, peak_torque=3000.0)))


def test_a_life_beyond_the_teeth(request_of, load):
    heavy = replace(load, spectrum=load.spectrum.scaled(2.0, 1.0))
    with pytest.raises(GearError, match="too weak; .* a safety factor flank of"):
        search(request_of(load=heavy))


def test_the_largest_share_of_the_safety_that_is_in_reach(request_of, load):
    request = request_of(load=replace(load, spectrum=load.spectrum.scaled(1.6, 1.0)), modules=(0.75 * MM,))
    found, weakness = strongest(request)
    reached = min(
        value / getattr(request.safety, kind)
        for rating in found.best.rate(request.load, request.rules)
        for kind, value in rating.least.items()
    )
    assert 0.799 <= reached < 0.9 and "too weak" in weakness and "is wanted" in weakness
    with pytest.raises(TooWeakError):
        search(replace(request, safety=replace(request.safety, flank=0.9 * request.safety.flank)))


def test_what_is_strong_enough_has_no_weakness(request_of, found):
    strong, weakness = strongest(request_of())
    assert weakness is None and strong.costs == found.costs


def test_not_even_half_of_the_safety(request_of, load):
    heavy = replace(load, spectrum=load.spectrum.scaled(6.0, 1.0))
    with pytest.raises(TooWeakError, match="too weak; .* where 1.1 is wanted"):
        strongest(request_of(load=heavy, modules=(0.75 * MM,)))


def test_a_contact_ratio_that_spur_teeth_do_not_have(request_of):
    with pytest.raises(GearError, match="the constraint in the way is the contact ratio"):
        search(request_of(teeth=ToothLimits(contact_ratio=1.9)))


def test_a_ratio_below_two_a_stage(request_of):
    with pytest.raises(GearError, match="have 1.73 each: use fewer stages, match.gearbox_stages = 1"):
        request_of(ratio=3.0)
    with pytest.raises(GearError, match="match.speed_max_rad_per_s.* or drive directly, match.gearbox_stages = 0"):
        request_of(ratio=1.5, stage_count=1)


def test_one_stage_for_a_ratio_of_two_is_sent_to_more_stages(request_of):
    with pytest.raises(GearError, match="where 15.17 is the largest: use more stages, match.gearbox_stages = 2"):
        search(request_of(stage_count=1))
