"""What a test bench recorded, made into numbers: the tools of a campaign, from raw records to tables."""
