"""Methods in the frequency domain: regression, output error, frequency responses."""
