"""Some thousand files that are changed at random; make fuzz reads a hundred thousand (docs/reliability.md)."""

import pytest
from fuzz.apart import outcomes_apart
from fuzz.trial import SHARES, Trials

PER_SHARE = 20


@pytest.fixture(scope="module")
def trials(tmp_path_factory):
    return Trials(tmp_path_factory.mktemp("fuzz"), seed=2)


@pytest.fixture(scope="module")
def outcomes_of(tmp_path_factory):
    with outcomes_apart(tmp_path_factory.mktemp("fuzz-apart"), seed=2) as found:
        yield found


def test_every_kind_has_its_share(trials):
    assert sum(SHARES.values()) == 100
    assert list(SHARES) == trials.kinds


@pytest.mark.slow
@pytest.mark.parametrize("kind", SHARES)
def test_what_is_changed_is_read_or_refused_in_one_line(outcomes_of, kind):
    outcomes = outcomes_of(kind, PER_SHARE * SHARES[kind])
    assert [outcome for outcome in outcomes if outcome.state not in ("read", "refused")] == []
    # Some must be refused: the changes do reach what is read.
    assert any(outcome.state == "refused" for outcome in outcomes)


@pytest.mark.parametrize("kind", SHARES)
def test_what_is_not_changed_is_read(trials, kind):
    read = set()
    for sample in trials.samples[kind]:
        (trials.folder / sample.name).write_bytes(sample.data)
        try:
            sample.read(trials.folder / sample.name)
        except ValueError:
            continue
        read.add(sample.data)
    # A picture in color is no measurement, and a measurement in EXR no photo: each is read by one of the two.
    assert read == {sample.data for sample in trials.samples[kind]}
