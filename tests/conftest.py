"""What holds for all tests: none is timed, and garbage is looked for more rarely than by default.

No test is timed by Hypothesis either: how fast examples are drawn says something of the machine alone.
"""

import gc

from hypothesis import HealthCheck, settings

settings.register_profile("untimed", settings.default, deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("untimed")

gc.set_threshold(100_000, 20, 50)


def pytest_collection_finish() -> None:
    """Modules, and the tests themselves, stay until the end: they are not looked through again and again."""
    gc.collect()
    gc.freeze()
