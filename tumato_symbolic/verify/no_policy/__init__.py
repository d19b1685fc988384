"""The answer that there is no policy, proved by Z3 (`docs/certificate.md`, "The answer no")."""
