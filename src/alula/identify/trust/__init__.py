"""What the data can and cannot tell: verdicts, ties, feedback, signs of controls."""
