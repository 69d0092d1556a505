"""What a quantity of a gear set is: a number for one set, an array with one entry a set for a batch of them."""

from typing import Any

# As it goes in, so it comes out, which annotations cannot say of numpy's functions: a union of both would forbid
# indexing a batch and calling a number a float.
Batch = Any
