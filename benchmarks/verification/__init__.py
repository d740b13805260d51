"""What must hold, one file per topic, one function per row; run by benchmarks/verify.py."""
