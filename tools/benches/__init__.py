"""What tools/bench measures: one subject a file, and what they share."""
