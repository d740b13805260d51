"""Linear state equations with named parameters: output error and filter error."""
