"""A sweep on a Dask cluster of two processes, one of which is killed on the way."""

import os
import signal
import time

import numpy as np
import pytest
import xarray

from piezo_sym import sine, sweep

OVER = {"V_in": {f: sine(100, f) for f in (50.0, 100.0)}, "L": np.linspace(1e-3, 5e-3, 320)}
BASE = {"over": OVER, "duration": 0.02, "times": 3}


@pytest.mark.long
def test_a_killed_worker_loses_nothing(tmp_path):
    from distributed import Client, LocalCluster

    killed, after = [], []
    height = 2.0

    def at_a_third(done, total):
        if killed:
            after.append(done)
        elif done >= total / 3:
            killed.append(next(iter(client.run(os.getpid).values())))
            os.kill(killed[0], signal.SIGKILL)

    def slow(runs):
        time.sleep(0.2)
        return runs[["q", "phi"]] * height

    options = {"n_workers": 2, "threads_per_worker": 1, "processes": True}
    quiet = {"dashboard_address": None, "silence_logs": 50, "local_directory": str(tmp_path)}
    with LocalCluster(**options, **quiet) as cluster, Client(cluster) as client:
        found = sweep(
            "piezo_stack",
            **BASE,
            executor=client.get_executor(),
            reduce=slow,
            reduce_by="chunk",
            progress=at_a_third,
        )
        assert len(killed) == 1
        assert len(after) > 1  # boxes that end together are told at once
    expected = sweep("piezo_stack", **BASE)
    assert (found.error == "").all()
    xarray.testing.assert_equal(found[["q", "phi"]], expected[["q", "phi"]] * height)
