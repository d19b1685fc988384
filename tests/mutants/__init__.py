"""Changed policies, certificates and specifications: every prover tells the right ones from the wrong ones."""
