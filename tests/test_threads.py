"""Work that is shared among threads."""

import sys
import time

import pytest

from reflcolor_addon import threads


@pytest.fixture(params=[1, 3])
def allowed(request, monkeypatch):
    monkeypatch.setattr(threads, "_limit", request.param)
    return request.param


def test_results_come_in_the_order_of_what_was_asked(allowed):
    assert list(threads.in_threads(lambda number: number**2, range(50))) == [number**2 for number in range(50)]


def test_an_error_in_a_thread_reaches_the_caller(allowed):
    with pytest.raises(ZeroDivisionError):
        list(threads.in_threads(lambda number: 1 / number, [1, 0, 2]))


def test_nothing_more_is_begun_when_the_caller_ends_early(allowed):
    begun = []

    def work(number):
        begun.append(number)
        if number:
            time.sleep(0.1)

    results = threads.in_threads(work, range(100))
    next(results)
    results.close()
    assert len(begun) < 100


def test_python_is_shared_as_before_once_all_that_let_others_run_have_ended():
    usual = sys.getswitchinterval()
    first, second = threads.letting_others_run(), threads.letting_others_run()
    with first:
        second.__enter__()
        assert sys.getswitchinterval() < usual
    assert sys.getswitchinterval() < usual
    second.__exit__(None, None, None)
    assert sys.getswitchinterval() == pytest.approx(usual)
