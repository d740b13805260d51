"""Air data: conversions, five-hole probe, vanes, static port, and their calibration in flight."""
