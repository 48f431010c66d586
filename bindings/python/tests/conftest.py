"""What all tests share."""

import signal

import pytest


@pytest.fixture(autouse=True)
def ctrl_c_interrupts():
    """Python's own handler: a shell starts what it runs in the background with SIGINT ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)
