"""Members that need very many steps, beside others that do not."""

from pathlib import Path

import numpy as np
import pytest

from piezo_sym import sine, sweep

SPECS = Path(__file__).parents[1] / "networks" / "specs"


@pytest.mark.long
def test_stiff_members_come_through_beside_others_as_alone():
    options = {"inputs": {"w": sine(1e5, 300.0)}, "duration": 2e-2, "rtol": 1e-8, "times": 7}
    stiff = [1.750439111200299e-07, 6.033109374234601e-05, 6.151464810203631e-07, 2.8e-4, 2.2e-4]
    found = sweep(SPECS / "a10_maxwell_slip.toml", over={"b": stiff}, threads=1, **options)
    assert found.error.values.tolist() == [""] * 5
    alone = sweep(SPECS / "a10_maxwell_slip.toml", over={"b": stiff[1:2]}, threads=1, **options)
    assert np.array_equal(found.T_body[1], alone.T_body[0])
