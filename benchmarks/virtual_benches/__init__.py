"""Virtual benches: campaigns of devices whose truth follows other laws and methods than the models of the workbench.

Nothing here imports ``effects`` or ``workbench``: the truth knows neither the library nor the likelihood.
"""
