"""Every scenario as a test, in a real Blender with a window (make test-window).

The name keeps `make test` from collecting it.
"""

import os

import pytest
from window_scenarios import scenario_files

SCENARIOS = [(stem, name) for stem, file in scenario_files().items() for name in file.names]


@pytest.mark.parametrize("scenario", SCENARIOS, ids=lambda item: "-".join(part[len("scenario_") :] for part in item))
def test(scenario, outcome_of, record_property):
    outcome = outcome_of(*scenario)
    record_property("told", outcome.told)
    # CI has everything.
    if (missing := outcome.told.get("missing")) and not os.environ.get("CI"):
        pytest.skip(missing)
    if fault := outcome.fault():
        pytest.fail(fault, pytrace=False)
