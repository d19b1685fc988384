"""From a specification to a policy, or to the reason why there is none."""
