"""One physical reason a file, why a measurement may differ from a model; ``base.py`` holds the few kinds there are."""
