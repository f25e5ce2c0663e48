"""Ctrl-C in the midst of work that must be whole."""

import signal
from collections.abc import Iterator
from threading import Thread

import pytest

from bumpstop.interrupts import interrupts_later


@pytest.fixture(autouse=True)
def heard() -> Iterator[None]:
    """Hear interrupts as Python does by itself, also where the tests run in the background."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def test_it_waits_until_the_work_is_whole() -> None:
    done = []

    @interrupts_later()
    def work() -> None:
        signal.raise_signal(signal.SIGINT)
        done.append("work")

    with pytest.raises(KeyboardInterrupt):
        work()
    assert done == ["work"]
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_nothing_is_raised_where_none_came() -> None:
    with interrupts_later():
        pass
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_a_fault_of_the_work_comes_first() -> None:
    @interrupts_later()
    def work() -> None:
        signal.raise_signal(signal.SIGINT)
        raise OSError("disk")

    with pytest.raises(OSError, match="disk"):
        work()
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_the_handler_of_others_stays() -> None:
    came = []
    signal.signal(signal.SIGINT, lambda *_: came.append("theirs"))
    with interrupts_later():
        signal.raise_signal(signal.SIGINT)
        assert came == ["theirs"]


def test_other_threads_hear_no_signals() -> None:
    done = []

    @interrupts_later()
    def work() -> None:
        done.append("work")

    thread = Thread(target=work)
    thread.start()
    thread.join()
    assert done == ["work"]
