"""The rivals of BIRM3D on common workloads: one file per rival, the definition, the choice of equal error."""
