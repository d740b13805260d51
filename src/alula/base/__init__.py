"""What every stage uses and no stage knows: messages, units, provenance, whole files."""
