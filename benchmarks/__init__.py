"""Speed and accuracy against other codes, measured as ratios in one run."""
