"""A-weighting against the tables of IEC 61672-1, and levels of tones whose level is known."""

import numpy as np
import pytest

from bench.errors import RecordError
from bench.record import Record
from bench.sound import a_weighting, sound_levels

# IEC 61672-1:2013, table 3: nominal frequency [Hz] and A-weighting [dB], which holds at the exact frequency 10^(k/10)
TABULATED = {
    10: -70.4, 16: -56.7, 31.5: -39.4, 63: -26.2, 125: -16.1, 250: -8.6, 500: -3.2, 1000: 0.0, 2000: 1.2, 4000: 1.0,
    8000: -1.1, 16000: -6.6, 20000: -9.3,
}  # fmt: skip


@pytest.mark.parametrize("nominal", TABULATED)
def test_the_weighting_is_that_of_the_standard(nominal):
    exact = 10 ** (round(10 * np.log10(nominal)) / 10)
    assert 20 * np.log10(np.abs(a_weighting(np.array([exact])))) == pytest.approx(TABULATED[nominal], abs=0.05)


def test_the_printed_corner_would_be_three_decibels_off():
    """Thesis eq. 5.2 prints (s + 12.4)^2 for (s + 129.4)^2: -36.5 instead of -39.5 dB at 31.5 Hz."""
    s = 2j * np.pi * 31.5
    printed = 7.4e9 * s**4 / ((s + 12.4) ** 2 * (s + 7.7e4) ** 2 * (s + 4.6e3) * (s + 676.7))
    right = printed * ((s + 12.4) / (s + 129.4)) ** 2
    assert 20 * np.log10(abs(printed)) == pytest.approx(-36.5, abs=0.1)
    assert 20 * np.log10(abs(a_weighting(np.array([31.5])))) == pytest.approx(20 * np.log10(abs(right)), abs=0.1)


def tone(frequency, level, sampling=12800.0, duration=2.0):
    time = np.arange(0, duration, 1 / sampling)
    pressure = np.sqrt(2) * 20e-6 * 10 ** (level / 20) * np.sin(2 * np.pi * frequency * time)
    return Record("tone", 1 / sampling, {"pressure": pressure + 0.3})  # a constant pressure is no sound


@pytest.mark.parametrize("frequency, weight", ((31.5, -39.5), (1000, 0.0), (4000, 0.96), (6309.57, -0.1)))
def test_a_tone_has_its_level_and_its_weight(frequency, weight):
    """Up to half the sampling frequency, where a filter by the bilinear rule would be off."""
    found = sound_levels(tone(frequency, 80.0))
    assert found.unweighted == pytest.approx(80.0, abs=0.01)
    assert found.equivalent == pytest.approx(80.0 + weight, abs=0.06)
    assert found.loudest == pytest.approx(80.0 + weight, abs=0.2)


def test_two_tones_add_their_powers():
    pressure = tone(1000, 60.0).channel("pressure") + tone(1250, 60.0).channel("pressure")
    found = sound_levels(Record("two", 1 / 12800, {"pressure": pressure}))
    assert found.unweighted == pytest.approx(60.0 + 10 * np.log10(2), abs=0.01)


def test_the_fast_level_follows_with_its_time_constant():
    """125 ms after a tone stops its level has fallen by 10 log10 e = 4.34 dB (IEC 61672-1: 34.7 dB/s)."""
    record = tone(1000, 80.0)
    pressure = np.where(record.time < 1.0, record.channel("pressure") - 0.3, 0.0)
    found = sound_levels(Record("stops", record.step, {"pressure": pressure}))
    falls = np.interp([1.1, 1.3], found.time, found.fast)
    assert falls[0] - falls[1] == pytest.approx(0.2 / 0.125 * 10 * np.log10(np.e), rel=0.02)


def test_too_short_a_record_is_refused():
    with pytest.raises(RecordError, match="expected 1 s of sound or more, found 0.5 s"):
        sound_levels(tone(1000, 80.0, duration=0.5))
