"""The answer that there is no policy, proved by Z3 and the walk (`docs/certificate.md`, "The answer no")."""
