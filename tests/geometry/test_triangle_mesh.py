"""The fast numbering of edges is that of scikit-fem."""

import numpy as np
from numpy.testing import assert_array_equal
from skfem import MeshTri

from geometry.triangle_mesh import TriangleMesh


def test_edges_are_those_of_scikit_fem():
    plain = MeshTri().refined(4)
    shuffled = np.random.default_rng(1).permutation(plain.p.shape[1])[plain.t]
    fast, slow = (mesh(plain.p, shuffled, sort_t=False, validate=False) for mesh in (TriangleMesh, MeshTri))
    assert_array_equal(fast.facets, slow.facets)
    assert_array_equal(fast.t2f, slow.t2f)
    assert fast.facets.dtype == slow.facets.dtype


def test_a_copy_with_names_keeps_the_numbering():
    mesh = TriangleMesh().refined(2).with_boundaries({"left": lambda x: x[0] == 0})
    assert isinstance(mesh, TriangleMesh)
    assert_array_equal(mesh.p[0, mesh.facets[:, mesh.boundaries["left"]]], 0)
