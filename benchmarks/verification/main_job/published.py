"""Published results of real flights, with the margins they are judged by; one place for all."""

# Klein and Morelli's examples: value, published (coloured) standard error, relative margin of the
# value. CZ was published from slightly smoothed regressors; 0.5 % covers that.
TWIN_OTTER = {
    "CZ_alpha": (-6.3489, 0.0200, 5e-3),
    "CZ_q": (-18.4061, 0.5524, 5e-3),
    "CZ_de": (-0.6261, 0.0153, 5e-3),
    "Cm_alpha": (-1.4762, 0.0224, 1e-3),
    "Cm_q": (-36.3533, 0.689, 1e-3),
    "Cm_de": (-1.8688, 0.0204, 1e-3),
}

# Jategaonkar, Flight Vehicle System Identification, 2nd ed.: output error over the three maneuvers,
# g = 9.80 m/s2; then the margin, SI: the publication estimates its initial states otherwise.
ATTAS_BIASES = {
    "b_ax": (6.76242e-3, 2e-3),
    "b_ay": (-1.50664e-3, 2e-3),
    "b_az": (8.39892e-2, 1e-2),
    "b_p": (1.02555e-3, 1e-4),
    "b_q": (3.40891e-3, 1e-4),
    "b_r": (9.96192e-4, 1e-4),
}
