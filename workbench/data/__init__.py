"""A campaign as it is read: files, columns, units, formulas, checks."""
