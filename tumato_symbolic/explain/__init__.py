"""Why a specification has no policy: failing states, cores, repairs, the largest realizable part."""
