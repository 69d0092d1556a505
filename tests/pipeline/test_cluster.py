"""Sweep, optima, flux map and blind campaigns on a local cluster give the bytes of one process, a worker killed too."""

import os
import signal
import threading
import time

import pytest
from small_studies import fitted, small

from benchmarks import blind_campaigns
from pipeline.pools import DaskCluster
from pipeline.results import Results
from pipeline.run import Run
from pipeline.stages import graph_of
from processes import ThisProcess

TINY = {
    "study__id": '"tiny-test-study"',
    "sweep__stator_diameters_mm": "[80, 90]",
    "sweep__back_iron_steps": "3",
    "sweep__rotor_radius_steps": "3",
    "chain__requirements": '"stated"',
    "chain__linkage": '"stated"',
}
# Two radii are swept; what comes behind starts from known polynomials.
FILES = {
    "optima": ("sweep.json", "sweep.nc", "optima.json"),
    "flux_map": ("match.json", "flux_map.json", "flux_map.nc"),
}


@pytest.fixture(scope="module")
def cluster():
    pool = DaskCluster(2)
    yield pool
    pool.end()


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    return small("motorcycle", tmp_path_factory.mktemp("study"), **TINY)


def run_to_the_flux_map(study, folder, pool):
    return {name: read for graph, last in ((graph_of(study), "optima"), (fitted(study), "flux_map"))
            for name, read in run_to(last, graph, study, folder / last, pool).items()}  # fmt: skip


def run_to(last, graph, study, folder, pool):
    run = Run(graph, study, Results(folder), pool)
    with run.results.held():
        run.all(graph.before(graph.stage(last)))
    assert not run.failures
    return {name: (folder / name).read_bytes() for name in FILES[last]}


def kill_a_worker_after(checkpoint, cluster):
    """End one worker process of the cluster as soon as the first tasks are finished."""
    first = next(iter(cluster.client.run(os.getpid).values()))

    def wait_and_kill():
        end = time.monotonic() + 120
        while time.monotonic() < end and not (checkpoint.is_file() and checkpoint.read_bytes().count(b"\n") > 2):
            time.sleep(0.02)
        os.kill(first, signal.SIGKILL)
        killed.append(first)

    killed = []
    threading.Thread(target=wait_and_kill, daemon=True).start()
    return killed


def test_the_design_chain_is_the_same_to_the_byte(study, cluster, tmp_path):
    alone = run_to_the_flux_map(study, tmp_path / "alone", ThisProcess())
    killed = kill_a_worker_after(tmp_path / "cluster" / "optima" / "checkpoints" / "sweep, sweep.jsonl", cluster)
    together = run_to_the_flux_map(study, tmp_path / "cluster", cluster)
    assert killed, "no worker was killed on the way"
    assert [name for name in alone if alone[name] != together[name]] == []


def test_blind_campaigns_are_the_same(cluster, tmp_path):
    chosen = blind_campaigns.wanted("damper", 2, False, ("null", "single"))
    found = []
    for name, pool in (("here", ThisProcess()), ("cluster", cluster)):
        blind_campaigns.write_campaigns(tmp_path / name, chosen, pool)
        found.append(blind_campaigns.hashes(tmp_path / name))
    assert len(found[0]) == 3 and found[0] == found[1]
