"""Linear least squares: plain, biased on purpose, choosing its terms; and what residuals tell."""
