"""Model against measurement: read a campaign, compare, diagnose what is missing, add it, keep the ledger."""
