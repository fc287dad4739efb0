"""The hash that names materials in renders, against published values."""

import pytest

from reflcolor_addon.simulation.cryptomatte import name_as_float


@pytest.mark.parametrize(
    ("name", "bits"), [("hello", 0x248BFA47), ("floor", 0x7819C83C), ("default_surface", 0x78D05529)]
)
def test_a_name_has_its_murmur_hash(name, bits):
    import struct

    assert struct.pack("<f", name_as_float(name)) == struct.pack("<I", bits)


def test_a_hash_that_is_no_number_is_made_one():
    # The hash of nothing is 0, whose exponent bits are all clear.
    assert name_as_float("") == 2.0**-126
