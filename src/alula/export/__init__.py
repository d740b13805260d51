"""Models out to other programs, and in: DAVE-ML (AIAA S-119) both ways, JSBSim."""
