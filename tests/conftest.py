"""No test is timed, by Hypothesis either: how fast examples are drawn says something of the machine alone."""

from hypothesis import HealthCheck, settings

settings.register_profile("untimed", settings.default, deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("untimed")
